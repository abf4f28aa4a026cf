// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files that appear whole or not at all: written aside, renamed by Commit.

#ifndef FLOCKLIFT_SIMULATE_CORE_ATOMIC_FILE_H_
#define FLOCKLIFT_SIMULATE_CORE_ATOMIC_FILE_H_

#include <filesystem>
#include <string_view>

namespace flocklift {

// Owns the temporary name beside `path` (same extension, so that writers which choose their format
// by it work) until Commit renames it; without Commit the destructor removes what was written.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);  // makes the folder when it is missing
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  void Commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

// The whole of a text file at once.
void WriteTextFile(const std::filesystem::path& path, std::string_view text);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_ATOMIC_FILE_H_
