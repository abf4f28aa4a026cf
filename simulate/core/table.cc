// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/table.h"

#include <fmt/format.h>

#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/hdf5_table.h"
#include "simulate/core/input_file.h"

namespace flocklift::internal {

std::string TableLayout::RequiredNames() const {
  std::string names = "frame,id";
  for (const TableColumn& column : columns) {
    if (column.group == 0) names += "," + column.name;
  }
  return names;
}

void TablePlace::Fail(long row, const std::string& fault, const std::string& mend) const {
  if (is_text || row == 0) throw InputError(file, is_text ? row : 0, fault, mend);
  throw InputError(file, 0, fmt::format("row {}: {}", row, fault), mend);
}

int CheckedFrame(const TableRow& row, std::int64_t frame) {
  if (frame < 1) row.Fail(fmt::format("frame {} is below 1", frame), "count frames from 1");
  if (frame > kMaxFrame) {
    row.Fail(fmt::format("frame {} is above {}", frame, kMaxFrame), "count frames from 1");
  }
  return static_cast<int>(frame);
}

Id CheckedId(const TableRow& row, std::int64_t id, bool may_lack_id) {
  if (id >= 1 || (id == kNoId && may_lack_id)) return id;
  if (id == kNoId) {
    row.Fail("id -1 marks a detection that belongs to no animal",
             "give each animal a positive id (the command track makes tracks)");
  }
  row.Fail(fmt::format("id {} is not positive", id),
           may_lack_id ? "use ids from 1, or -1 for none" : "use ids from 1");
}

void CheckMagnitude(const TableRow& row, const std::string& column, double value) {
  if (std::isfinite(value) && std::abs(value) <= kMaxMagnitude) return;
  row.Fail(fmt::format("{} is {}", column, value),
           fmt::format("give a finite number of at most {:g}, or take the row out", kMaxMagnitude));
}

TableContents ReadTable(const std::filesystem::path& path, const TableLayout& layout,
                        const TakeRow& take) {
  if (IsHdf5Name(path)) return ReadHdf5Table(path, layout, take);
  std::ifstream stream = OpenInput(path);
  return ReadCsvTable(stream, path.string(), layout, take);
}

}  // namespace flocklift::internal
