// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The rows of a text table by the bytes where they stand.

#ifndef FLOCKLIFT_SIMULATE_CORE_TEXT_ROWS_H_
#define FLOCKLIFT_SIMULATE_CORE_TEXT_ROWS_H_

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "simulate/core/table.h"

namespace flocklift::internal {

// What stands before the first row: comments and the header.
struct TextHead {
  std::string text;
  long lines = 0;
  std::uint64_t end = 0;  // where the first row begins
};

class TextRows {
 public:
  explicit TextRows(const std::filesystem::path& path);

  std::uint64_t size() const { return size_; }  // of the file, in bytes

  // None when no row follows, or `frame` is not the first column of it.
  std::optional<TextHead> ReadHead(bool has_header);

  // The first line that begins at a byte or after it and has a frame in its first field; none when
  // the next megabyte holds none.
  std::optional<PlacedRow> From(std::uint64_t at);

  long CountLines(std::uint64_t end);  // that end before a byte

  // The rows of the bytes [begin, end), before which there are so many lines.
  TableContents Read(const TextHead& head, std::uint64_t begin, std::uint64_t end,
                     long lines_before, const TableLayout& layout, const TakeRow& take);

 private:
  std::string_view Bytes(std::uint64_t begin, std::size_t count);

  std::string name_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::string buffer_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_TEXT_ROWS_H_
