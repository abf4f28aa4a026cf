// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tables as other programs write them: comma, semicolon or tab between the fields, names in the
// first line or none, and nan, inf, NA or nothing where a value is missing.

#ifndef FLOCKLIFT_TRACK_INTERCHANGE_FOREIGN_TABLE_H_
#define FLOCKLIFT_TRACK_INTERCHANGE_FOREIGN_TABLE_H_

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulate/core/line_reader.h"

namespace flocklift::internal {

// One line of numbers, as many as the first line has fields.
using ForeignRow = std::vector<std::optional<double>>;

class ForeignTable {
 public:
  // Reads the first line. `name` is the file's, for messages. The stream must outlive the table.
  // InputError for a file without any line.
  ForeignTable(std::istream& stream, const std::string& name);

  // Names in lower case, without quotation marks and without a unit in brackets at the end; empty
  // when the first line already holds numbers.
  const std::vector<std::string>& names() const { return names_; }
  std::size_t column_count() const { return column_count_; }
  // The column of that name.
  std::optional<std::size_t> Find(std::string_view column) const;

  // The next row; false at the end. InputError for a field that is no number, or too many or too
  // few of them.
  bool Next(ForeignRow* row);
  long line() const { return line_; }  // of that row

  [[noreturn]] void Fail(long line, const std::string& fault, const std::string& mend) const;

 private:
  bool NextLine(std::string_view* line);
  void Parse(std::string_view line, ForeignRow* row) const;

  LineReader reader_;
  long line_ = 0;
  char separator_ = ',';
  std::vector<std::string> names_;
  std::size_t column_count_ = 0;
  std::string first_;  // the first line, where it holds numbers and was not yet handed out
  bool has_first_ = false;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_INTERCHANGE_FOREIGN_TABLE_H_
