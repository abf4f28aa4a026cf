// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Trajectories of which a few frames are asked for at a time: small ones in memory, large ones left
// in their file. Nothing here changes, so several threads may ask at once.

#ifndef FLOCKLIFT_TOOLS_VIEW_FLOCK_ROWS_H_
#define FLOCKLIFT_TOOLS_VIEW_FLOCK_ROWS_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulate/core/progress.h"
#include "simulate/core/table_by_frame.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

// A file of at least `large_bytes` whose rows stand by frame; none: it must be read as a whole.
std::optional<TableByFrame> OpenLarge(const std::filesystem::path& path, const std::string& table,
                                      std::uint64_t large_bytes);

class FlockRows {
 public:
  // Velocities are filled where fps is known and they are not given.
  FlockRows(Trajectories trajectories, std::optional<double> fps);
  FlockRows(TableByFrame file, std::optional<double> fps);

  FrameSpan span() const { return span_; }
  bool has_sd_depth() const { return has_sd_depth_; }
  const std::optional<TableByFrame>& file() const { return file_; }

  // The rows of frames `first` to `last`. Throws InputError, with file and line, when they are
  // damaged; none when the file is not by frame after all. Velocities that a file does not give are
  // those of the whole, but where an animal is missing for more than 8 frames at the window's edge:
  // there they are of the nearer side only.
  std::optional<Trajectories> Rows(int first, int last) const;

  // About `most_rows` rows: all those of every n-th frame. Frames that are damaged are left out.
  Trajectories Sample(std::size_t most_rows, const Progress& progress = {}) const;

 private:
  std::size_t RowsPerFrame() const;

  std::shared_ptr<const Trajectories> whole_;
  std::optional<TableByFrame> file_;
  std::optional<double> fps_;
  FrameSpan span_;
  bool has_sd_depth_ = false;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_FLOCK_ROWS_H_
