// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tables in HDF5 files: one dataset per column, all of one length, chunked and compressed, in a
// group with the attributes fps and flocklift_version. Not thread-safe, as the packaged library.

#ifndef FLOCKLIFT_SIMULATE_CORE_HDF5_TABLE_H_
#define FLOCKLIFT_SIMULATE_CORE_HDF5_TABLE_H_

#include <cstdint>
#include <filesystem>
#include <string>

#include "simulate/core/table.h"

namespace flocklift::internal {

// Does the name end in .h5?
bool IsHdf5Name(const std::filesystem::path& path);

TableContents ReadHdf5Table(const std::filesystem::path& path, const TableLayout& layout,
                            const TakeRow& take);

// The same of an open file (a hid_t), named `name` in messages.
TableContents ReadHdf5Table(std::int64_t open_file, const std::string& name,
                            const TableLayout& layout, const TakeRow& take);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_HDF5_TABLE_H_
