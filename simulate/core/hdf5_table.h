// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tables in HDF5 files: one dataset per column, all of one length, chunked and compressed, in a
// group with the attributes fps and flocklift_version. As thread-safe as the library is.

#ifndef FLOCKLIFT_SIMULATE_CORE_HDF5_TABLE_H_
#define FLOCKLIFT_SIMULATE_CORE_HDF5_TABLE_H_

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "simulate/core/table.h"

namespace flocklift::internal {

// Does the name end in .h5?
bool IsHdf5Name(const std::filesystem::path& path);

// May several threads read at a time? Debian's library was built so that they may.
bool Hdf5BearsThreads();

// Rows of a table, from 0.
struct RowSpan {
  std::uint64_t first = 0, count = std::numeric_limits<std::uint64_t>::max();
};

TableContents ReadHdf5Table(const std::filesystem::path& path, const TableLayout& layout,
                            const TakeRow& take, const RowSpan& rows = {});

// The same of an open file (a hid_t), named `name` in messages.
TableContents ReadHdf5Table(std::int64_t open_file, const std::string& name,
                            const TableLayout& layout, const TakeRow& take,
                            const RowSpan& rows = {});

// The column frame of a table, row by row in any order.
class Hdf5Frames {
 public:
  Hdf5Frames(const std::filesystem::path& path, const std::string& table);
  ~Hdf5Frames();

  std::uint64_t size() const;
  // The row, or the first of the next few whose frame is one; none when there is no such row.
  std::optional<PlacedRow> From(std::uint64_t row);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_HDF5_TABLE_H_
