// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bytes that a run cannot hold in memory: appended to a file, read again from any place of it.

#ifndef FLOCKLIFT_TRACK_SCRATCH_FILE_H_
#define FLOCKLIFT_TRACK_SCRATCH_FILE_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>

namespace flocklift::internal {

// Every function throws std::runtime_error, which names the file, when the disk refuses.
class ScratchFile {
 public:
  enum class Name {
    kKept,    // the file is there when the program has ended, however it ended
    kNoName,  // nothing is left, however it ended
  };

  // The file, and its folder where that is missing, appear with the first byte.
  ScratchFile(std::filesystem::path path, Name name) : path_(std::move(path)), name_(name) {}
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  // Takes the first `size` bytes of a file that is there for its own.
  void GoOn(std::uint64_t size);

  std::uint64_t size() const { return size_; }

  // Returns where the bytes begin.
  std::uint64_t Append(std::span<const std::byte> bytes);
  void Read(std::uint64_t at, std::span<std::byte> bytes) const;

 private:
  void Open();
  [[noreturn]] void Fail(const char* what) const;

  std::filesystem::path path_;
  Name name_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_SCRATCH_FILE_H_
