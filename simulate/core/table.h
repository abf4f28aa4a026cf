// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of rows (frame, id, numbers), as text (CSV) or HDF5: what tracks, shapes, trajectories and
// anchors have in common. The readers check what holds for all of them: columns that are there and
// complete, finite numbers of sane size, frames from 1, ids that are positive.

#ifndef FLOCKLIFT_SIMULATE_CORE_TABLE_H_
#define FLOCKLIFT_SIMULATE_CORE_TABLE_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulate/core/observations.h"

namespace flocklift::internal {

inline constexpr int kMaxFrame = 100'000'000;  // 38 days at 30 frames/s
inline constexpr double kMaxMagnitude = 1e9;   // of any number: metres or pixels

// A column besides frame and id. Columns of optional group k > 0 are there all together or not at
// all, and read as `fallback` when they are not; group 0 is required.
struct TableColumn {
  std::string name;
  int group = 0;
  double fallback = 0;
};

struct TableLayout {
  std::string name;  // the HDF5 group, and the word for messages
  std::vector<TableColumn> columns;
  bool has_header = true;    // of the text form; without one, columns stand in this order
  bool may_lack_id = false;  // id -1 is legal
  int group_count = 0;

  // "frame,id,x,y,z": what a file must have.
  std::string RequiredNames() const;
};

// Where a row stands, for messages: a line of a text file, or a row of an HDF5 table.
struct TablePlace {
  std::string file;
  bool is_text = true;

  [[noreturn]] void Fail(long row, const std::string& fault, const std::string& mend) const;
};

struct TableRow {
  const TablePlace* place = nullptr;
  long line = 0;  // or row of an HDF5 table, from 1
  int frame = 0;
  Id id = 0;
  const double* values = nullptr;  // one per column of the layout

  [[noreturn]] void Fail(const std::string& fault, const std::string& mend) const {
    place->Fail(line, fault, mend);
  }
};
using TakeRow = std::function<void(const TableRow&)>;

// Where a row stands that has the frame: a byte of a text, or a row of an HDF5 table from 0.
struct PlacedRow {
  std::uint64_t place = 0;
  int frame = 0;
};

struct TableContents {
  TablePlace place;
  std::optional<double> fps;
  std::vector<bool> has;  // per optional group; has[0] is true
  long row_count = 0;
};

// What stands before the rows of a stream that holds only a part of its file.
struct CsvPart {
  std::string_view head = {};  // comments and the header
  long lines_before = 0;       // the head's among them
};

// Calls `take` for each row in the file's order; memory does not grow with the file.
TableContents ReadCsvTable(std::istream& stream, const std::string& name, const TableLayout& layout,
                           const TakeRow& take, const CsvPart& part = {});
// By the file's name: .h5 or text.
TableContents ReadTable(const std::filesystem::path& path, const TableLayout& layout,
                        const TakeRow& take);

// The checks of numbers that both forms share; `row.line` must be set.
int CheckedFrame(const TableRow& row, std::int64_t frame);
Id CheckedId(const TableRow& row, std::int64_t id, bool may_lack_id);
void CheckMagnitude(const TableRow& row, const std::string& column, double value);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_TABLE_H_
