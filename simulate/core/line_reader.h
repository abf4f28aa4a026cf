// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lines of a text stream, fast and with bounded memory. Windows line ends and a UTF-8 byte order
// mark are taken off.

#ifndef FLOCKLIFT_SIMULATE_CORE_LINE_READER_H_
#define FLOCKLIFT_SIMULATE_CORE_LINE_READER_H_

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace flocklift {

class LineReader {
 public:
  // `name` is the file's, for messages; `lines_before` of it stand before what the stream holds.
  // The stream must outlive the reader.
  LineReader(std::istream& stream, std::string name, long lines_before = 0);

  // The next line, valid until the next call; false at the end. InputError when a line is longer
  // than any text file of ours, or the stream fails.
  bool Next(std::string_view* line);

  long line() const { return line_; }  // of the line last read, from 1
  const std::string& name() const { return name_; }

 private:
  bool Refill();

  std::istream& stream_;
  std::string name_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // what of the buffer has not been handed out
  long line_ = 0;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_LINE_READER_H_
