// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/interchange/foreign_table.h"

#include <algorithm>
#include <cctype>

#include "simulate/core/check.h"
#include "simulate/core/text.h"

namespace flocklift::internal {
namespace {

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::string_view Unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

// "X#wcentroid (cm)" is x#wcentroid.
std::string PlainName(std::string_view field) {
  std::string_view name = Trim(Unquoted(field));
  if (!name.empty() && name.back() == ')') name = Trim(name.substr(0, name.rfind('(')));
  return Lower(name);
}

// Nothing: the field is no number. A number without a value: it says that one is missing.
std::optional<std::optional<double>> ParseField(std::string_view field) {
  field = Trim(Unquoted(field));
  if (const auto value = ParseReal(field)) return value;
  std::string word = Lower(field);
  if (!word.empty() && (word.front() == '-' || word.front() == '+')) word.erase(0, 1);
  for (const char* missing : {"", "nan", "inf", "infinity", "na", "none", "null"}) {
    if (word == missing) return std::optional<double>();
  }
  return std::nullopt;
}

template <typename Take>
void ForEachField(std::string_view line, char separator, const Take& take) {
  while (true) {
    const std::size_t end = line.find(separator);
    take(line.substr(0, end));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

}  // namespace

ForeignTable::ForeignTable(std::istream& stream, const std::string& name) : reader_(stream, name) {
  std::string_view line;
  if (!NextLine(&line)) Fail(0, "the file is empty", "give detections or tracks");
  std::ptrdiff_t most = 0;
  for (const char separator : {',', ';', '\t'}) {
    const auto count = std::count(line.begin(), line.end(), separator);
    if (count <= most) continue;
    most = count;
    separator_ = separator;
  }
  column_count_ = static_cast<std::size_t>(most) + 1;
  const std::string_view first = Trim(Unquoted(line.substr(0, line.find(separator_))));
  if (ParseReal(first)) {
    first_ = line;
    has_first_ = true;
    return;
  }
  ForEachField(line, separator_,
               [this](std::string_view field) { names_.push_back(PlainName(field)); });
}

std::optional<std::size_t> ForeignTable::Find(std::string_view column) const {
  const auto found = std::find(names_.begin(), names_.end(), column);
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

bool ForeignTable::NextLine(std::string_view* line) {
  while (reader_.Next(line)) {
    const std::string_view text = Trim(*line);
    if (text.empty() || text.front() == '#') continue;
    line_ = reader_.line();
    return true;
  }
  return false;
}

bool ForeignTable::Next(ForeignRow* row) {
  if (has_first_) {
    has_first_ = false;
    Parse(first_, row);
    return true;
  }
  std::string_view line;
  if (!NextLine(&line)) return false;
  Parse(line, row);
  return true;
}

void ForeignTable::Parse(std::string_view line, ForeignRow* row) const {
  row->clear();
  ForEachField(line, separator_, [&](std::string_view field) {
    const auto value = ParseField(field);
    if (!value) {
      const std::string column = row->size() < names_.size()
                                     ? "column " + Quoted(names_[row->size()])
                                     : "field " + std::to_string(row->size() + 1);
      Fail(line_, column + " is " + Quoted(Trim(field)),
           "give a number, or nan where it is missing");
    }
    row->push_back(*value);
  });
  if (row->size() != column_count_) {
    Fail(line_,
         "the row has " + std::to_string(row->size()) + " fields, the first line " +
             std::to_string(column_count_),
         "give every row the same columns");
  }
}

void ForeignTable::Fail(long line, const std::string& fault, const std::string& mend) const {
  throw InputError(reader_.name(), line, fault, mend);
}

}  // namespace flocklift::internal
