// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <istream>
#include <sstream>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/fps.h"
#include "simulate/core/line_reader.h"
#include "simulate/core/table.h"
#include "simulate/core/text.h"

namespace flocklift::internal {
namespace {

constexpr int kFrameField = -1, kIdField = -2, kIgnoredField = -3;

// What each field of a line is: an index into the layout's columns, or one of the above.
using FieldRoles = std::vector<int>;

std::vector<std::string_view> SplitFields(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(Trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

// Spreadsheets and R put names into quotation marks.
std::string_view Unquoted(std::string_view name) {
  const bool quoted = name.size() >= 2 && name.front() == '"' && name.back() == '"';
  return quoted ? name.substr(1, name.size() - 2) : name;
}

int RoleOf(std::string_view name, const TableLayout& layout) {
  if (name == "frame") return kFrameField;
  if (name == "id") return kIdField;
  for (std::size_t k = 0; k < layout.columns.size(); ++k) {
    if (layout.columns[k].name == name) return static_cast<int>(k);
  }
  return kIgnoredField;
}

bool Holds(const FieldRoles& roles, int role) {
  return std::find(roles.begin(), roles.end(), role) != roles.end();
}

// Which optional groups are there, complete.
std::vector<bool> GroupsPresent(const FieldRoles& roles, const TableLayout& layout,
                                const TablePlace& place, long line) {
  std::vector<bool> has(static_cast<std::size_t>(layout.group_count) + 1, false);
  has[0] = true;
  for (std::size_t k = 0; k < layout.columns.size(); ++k) {
    if (Holds(roles, static_cast<int>(k))) {
      has[static_cast<std::size_t>(layout.columns[k].group)] = true;
    }
  }
  for (std::size_t k = 0; k < layout.columns.size(); ++k) {
    const TableColumn& column = layout.columns[k];
    if (!has[static_cast<std::size_t>(column.group)] || Holds(roles, static_cast<int>(k))) continue;
    place.Fail(line, fmt::format("column {} is missing", column.name),
               column.group == 0
                   ? fmt::format("the first line must name {}", layout.RequiredNames())
                   : "give its companions all together or not at all");
  }
  return has;
}

FieldRoles ReadHeader(std::string_view line, const TableLayout& layout, const TablePlace& place,
                      long number) {
  FieldRoles roles;
  for (std::string_view field : SplitFields(line)) {
    const int role = RoleOf(Unquoted(field), layout);
    if (role != kIgnoredField && Holds(roles, role)) {
      place.Fail(number, fmt::format("column {} occurs twice", Quoted(field)), "take one out");
    }
    roles.push_back(role);
  }
  const std::string mend = fmt::format("the first line must name {}", layout.RequiredNames());
  if (!Holds(roles, kFrameField)) place.Fail(number, "column frame is missing", mend);
  if (!Holds(roles, kIdField)) place.Fail(number, "column id is missing", mend);
  return roles;
}

// frame, id, the layout's columns; what follows them is anybody's.
FieldRoles RolesWithoutHeader(std::string_view line, const TableLayout& layout,
                              const TablePlace& place, long number) {
  const std::size_t field_count = SplitFields(line).size();
  FieldRoles roles{kFrameField, kIdField};
  std::size_t required = roles.size();
  for (std::size_t k = 0; k < layout.columns.size(); ++k) {
    if (layout.columns[k].group == 0) ++required;
    roles.push_back(static_cast<int>(k));
  }
  if (field_count < required) {
    place.Fail(number, fmt::format("the row has {} fields", field_count),
               fmt::format("give at least {}, separated by commas", layout.RequiredNames()));
  }
  roles.resize(std::min(roles.size(), field_count));
  return roles;
}

// A comment may state the frames per second: `# fps=30000/1001`.
void ReadComment(std::string_view line, const TablePlace& place, long number,
                 std::optional<double>* fps) {
  const std::string_view comment = Trim(line.substr(1));
  const std::size_t equals = comment.find('=');
  if (equals == std::string_view::npos || Trim(comment.substr(0, equals)) != "fps") return;
  const std::string_view value = Trim(comment.substr(equals + 1));
  *fps = ParseFps(value);
  if (!*fps) {
    place.Fail(number, fmt::format("fps is {}", Quoted(value)),
               "write a positive decimal or a ratio, such as 30000/1001");
  }
}

// Parses the rows after the roles of their fields are known.
class RowParser {
 public:
  RowParser(const TableLayout& layout, const TablePlace* place)
      : layout_(layout), values_(layout.columns.size()) {
    row_.place = place;
    row_.values = values_.data();
    for (std::size_t k = 0; k < values_.size(); ++k) values_[k] = layout.columns[k].fallback;
  }

  void SetRoles(FieldRoles roles) { roles_ = std::move(roles); }
  bool HasRoles() const { return !roles_.empty(); }

  const TableRow& Parse(std::string_view line, long number) {
    row_.line = number;
    bool more = true;
    for (const int role : roles_) {
      if (!more) FailFieldCount("fewer");
      const std::size_t comma = line.find(',');
      if (role != kIgnoredField) ParseField(role, Trim(line.substr(0, comma)));
      more = comma != std::string_view::npos;
      if (more) line.remove_prefix(comma + 1);
    }
    // Without a header, what follows the known columns is anybody's.
    const bool may_go_on = !layout_.has_header && roles_.size() == values_.size() + 2;
    if (more && !may_go_on) FailFieldCount("more");
    return row_;
  }

 private:
  void ParseField(int role, std::string_view field) {
    if (role == kFrameField) {
      row_.frame = CheckedFrame(row_, Integer(field, "frame"));
    } else if (role == kIdField) {
      row_.id = CheckedId(row_, Integer(field, "id"), layout_.may_lack_id);
    } else {
      const std::size_t column = static_cast<std::size_t>(role);
      const std::optional<double> value = ParseReal(field);
      if (!value) FailNumber(layout_.columns[column].name, field, "finite number");
      CheckMagnitude(row_, layout_.columns[column].name, *value);
      values_[column] = *value;
    }
  }

  std::int64_t Integer(std::string_view field, const char* column) const {
    const std::optional<std::int64_t> value = ParseInteger(field);
    if (!value) FailNumber(column, field, "whole number");
    return *value;
  }

  [[noreturn]] void FailNumber(const std::string& column, std::string_view field,
                               const char* kind) const {
    if (!layout_.has_header && field == column) {
      row_.Fail("the file starts with a header line", "take it out");
    }
    row_.Fail(fmt::format("{} is {}", column, field.empty() ? "empty" : Quoted(field)),
              fmt::format("give a {}, or take the row out", kind));
  }

  [[noreturn]] void FailFieldCount(const char* comparison) const {
    row_.Fail(fmt::format("the row has {} fields than the first line", comparison),
              "give every row the same columns, separated by commas");
  }

  const TableLayout& layout_;
  FieldRoles roles_;
  std::vector<double> values_;
  TableRow row_;
};

}  // namespace

TableContents ReadCsvTable(std::istream& stream, const std::string& name, const TableLayout& layout,
                           const TakeRow& take, const CsvPart& part) {
  TableContents contents;
  contents.place = {.file = name, .is_text = true};
  contents.has.assign(static_cast<std::size_t>(layout.group_count) + 1, false);
  RowParser parser(layout, &contents.place);
  const auto read = [&](LineReader reader) {
    std::string_view line;
    while (reader.Next(&line)) {
      line = Trim(line);
      if (line.empty()) continue;
      if (reader.line() == 1 && line.starts_with("\x89HDF")) {
        contents.place.Fail(0, "this is an HDF5 file", "give it a name that ends in .h5");
      }
      if (line.front() == '#') {
        ReadComment(line, contents.place, reader.line(), &contents.fps);
        continue;
      }
      if (!parser.HasRoles()) {
        FieldRoles roles = layout.has_header
                               ? ReadHeader(line, layout, contents.place, reader.line())
                               : RolesWithoutHeader(line, layout, contents.place, reader.line());
        contents.has = GroupsPresent(roles, layout, contents.place, reader.line());
        parser.SetRoles(std::move(roles));
        if (layout.has_header) continue;
      }
      take(parser.Parse(line, reader.line()));
      ++contents.row_count;
    }
  };
  if (!part.head.empty()) {
    std::istringstream head{std::string(part.head)};
    read(LineReader(head, name));
  }
  read(LineReader(stream, name, part.lines_before));
  if (layout.has_header && !parser.HasRoles()) {
    contents.place.Fail(0, "the file is empty",
                        fmt::format("the first line must name {}", layout.RequiredNames()));
  }
  return contents;
}

}  // namespace flocklift::internal
