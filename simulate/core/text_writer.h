// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Formatted text to a file that appears whole or not at all, in bounded memory.

#ifndef FLOCKLIFT_SIMULATE_CORE_TEXT_WRITER_H_
#define FLOCKLIFT_SIMULATE_CORE_TEXT_WRITER_H_

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "simulate/core/atomic_file.h"

namespace flocklift::internal {

class TextWriter {
 public:
  explicit TextWriter(const std::filesystem::path& path);

  // Append to this, then call FlushIfFull now and then.
  fmt::memory_buffer& buffer() { return buffer_; }
  void FlushIfFull();
  void Commit();

 private:
  void Flush();

  std::filesystem::path path_;
  AtomicFile file_;
  std::ofstream stream_;
  fmt::memory_buffer buffer_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_TEXT_WRITER_H_
