// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/text_writer.h"

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace flocklift::internal {
namespace {

[[noreturn]] void FailWriting(const std::filesystem::path& path) {
  throw std::runtime_error(
      fmt::format("cannot write {}: {}", path.string(), std::generic_category().message(errno)));
}

}  // namespace

TextWriter::TextWriter(const std::filesystem::path& path)
    : path_(path), file_(path), stream_(file_.temporary(), std::ios::binary) {
  if (!stream_) FailWriting(path_);
}

void TextWriter::FlushIfFull() {
  constexpr std::size_t kBlock = 1 << 18;
  if (buffer_.size() >= kBlock) Flush();
}

void TextWriter::Flush() {
  stream_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  if (!stream_) FailWriting(path_);
  buffer_.clear();
}

void TextWriter::Commit() {
  Flush();
  stream_.close();
  if (!stream_) FailWriting(path_);
  file_.Commit();
}

}  // namespace flocklift::internal
