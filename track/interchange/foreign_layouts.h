// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The layouts of foreign_tracks.h, each as a reader of rows.

#ifndef FLOCKLIFT_TRACK_INTERCHANGE_FOREIGN_LAYOUTS_H_
#define FLOCKLIFT_TRACK_INTERCHANGE_FOREIGN_LAYOUTS_H_

#include <functional>
#include <optional>
#include <string>

#include "track/interchange/foreign_table.h"
#include "track/interchange/foreign_tracks.h"

namespace flocklift::internal {

// One animal in one frame.
struct ForeignPoint {
  double frame = 1;  // from 1; not yet checked
  double id = kNoId;
  double x = 0, y = 0;           // box centre, in the file's units, first pixel at (0, 0)
  double width = 0, height = 0;  // 0: not known
  double confidence = 1;
  std::optional<double> time;  // [s]
};
using TakeForeignPoint = std::function<void(const ForeignPoint& point, long line)>;

// Calls `take` for every animal of every row. Returns the layout's name. `file_id` is the animal
// of a file that holds a single one.
std::string ReadForeignPoints(ForeignTable* table, const ForeignOptions& options, Id file_id,
                              const TakeForeignPoint& take);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_INTERCHANGE_FOREIGN_LAYOUTS_H_
