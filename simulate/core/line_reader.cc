// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/line_reader.h"

#include <cstring>
#include <istream>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr std::size_t kBlock = 1 << 16;  // also the longest line
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

LineReader::LineReader(std::istream& stream, std::string name, long lines_before)
    : stream_(stream), name_(std::move(name)), buffer_(kBlock), line_(lines_before) {}

bool LineReader::Refill() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (!stream_.good()) return false;
  stream_.read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
  if (stream_.bad()) throw InputError(name_, 0, "cannot be read to its end", "check the disk");
  end_ += static_cast<std::size_t>(stream_.gcount());
  return stream_.gcount() > 0;
}

bool LineReader::Next(std::string_view* line) {
  std::size_t searched = 0;
  const char* newline = nullptr;
  while (true) {
    const char* const unread = buffer_.data() + begin_;
    newline =
        static_cast<const char*>(std::memchr(unread + searched, '\n', end_ - begin_ - searched));
    if (newline != nullptr) break;
    searched = end_ - begin_;
    if (searched == buffer_.size()) {
      throw InputError(name_, line_ + 1, "the line is longer than 65536 characters",
                       "give a text file with one row a line");
    }
    if (!Refill()) break;
  }
  if (newline == nullptr && begin_ == end_) return false;
  const char* const first = buffer_.data() + begin_;
  const char* const last = newline != nullptr ? newline : buffer_.data() + end_;
  begin_ = static_cast<std::size_t>(last - buffer_.data()) + (newline != nullptr ? 1 : 0);
  ++line_;
  *line = std::string_view(first, static_cast<std::size_t>(last - first));
  if (line->ends_with('\r')) line->remove_suffix(1);
  if (line_ == 1 && line->starts_with(kByteOrderMark)) line->remove_prefix(kByteOrderMark.size());
  return true;
}

}  // namespace flocklift
