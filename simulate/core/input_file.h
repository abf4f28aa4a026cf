// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Opening a file that somebody names.

#ifndef FLOCKLIFT_SIMULATE_CORE_INPUT_FILE_H_
#define FLOCKLIFT_SIMULATE_CORE_INPUT_FILE_H_

#include <filesystem>
#include <fstream>
#include <string>

namespace flocklift {

// InputError when there is no such file, it is a folder, or it may not be read.
std::ifstream OpenInput(const std::filesystem::path& path);

// The whole of a text file; InputError also when it is larger than any settings file (16 MiB).
std::string ReadTextFile(const std::filesystem::path& path);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_INPUT_FILE_H_
