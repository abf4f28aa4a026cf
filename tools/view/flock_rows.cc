// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/flock_rows.h"

#include <algorithm>
#include <map>
#include <utility>

#include "simulate/core/check.h"
#include "tools/view/cut.h"

namespace flocklift {
namespace {

constexpr int kMargin = 8;  // frames beside a window, to fill velocities
constexpr int kLooks = 8;   // frames of which the rows are counted

}  // namespace

std::optional<TableByFrame> OpenLarge(const std::filesystem::path& path, const std::string& table,
                                      std::uint64_t large_bytes) {
  std::error_code ignored;
  const auto bytes = std::filesystem::file_size(path, ignored);
  if (ignored || bytes < large_bytes) return std::nullopt;
  return TableByFrame::Open(path, table);
}

FlockRows::FlockRows(Trajectories trajectories, std::optional<double> fps)
    : fps_(fps), span_(SpanOf(trajectories)), has_sd_depth_(trajectories.has_sd_depth) {
  if (fps && !trajectories.has_velocity) ComputeVelocities(*fps, &trajectories);
  whole_ = std::make_shared<Trajectories>(std::move(trajectories));
}

FlockRows::FlockRows(TableByFrame file, std::optional<double> fps)
    : file_(std::move(file)), fps_(fps), span_{file_->first_frame(), file_->last_frame()} {
  const auto head = ReadTrajectories(*file_, 0, 0);
  has_sd_depth_ = head && head->has_sd_depth;
}

std::optional<Trajectories> FlockRows::Rows(int first, int last) const {
  if (whole_) return Cut(*whole_, first, last);
  first = std::max(first, span_.first);
  last = std::min(last, span_.last);
  auto rows = ReadTrajectories(*file_, first, last);
  if (!rows || rows->has_velocity || !fps_) return rows;
  rows = ReadTrajectories(*file_, first - kMargin, last + kMargin);
  if (!rows) return rows;
  ComputeVelocities(*fps_, &*rows);
  return Cut(*rows, first, last);
}

std::size_t FlockRows::RowsPerFrame() const {
  std::size_t count = 0;
  if (whole_) {
    for (const Trajectory& t : whole_->trajectories) count += t.points.size();
    return 1 + count / (static_cast<std::size_t>(span_.last - span_.first) + 1);
  }
  for (int k = 0; k < kLooks; ++k) {
    const int frame =
        span_.first + static_cast<int>((std::int64_t{span_.last} - span_.first) * k / kLooks);
    try {
      const auto rows = ReadTrajectories(*file_, frame, frame);
      if (rows) count = std::max(count, rows->trajectories.size());
    } catch (const InputError&) {
      continue;
    }
  }
  return count + 1;
}

Trajectories FlockRows::Sample(std::size_t most_rows, const Progress& progress) const {
  Trajectories sample;
  if (span_.last < span_.first) return sample;
  const auto frames = static_cast<std::size_t>(span_.last - span_.first) + 1;
  const std::size_t wanted = std::max<std::size_t>(most_rows / RowsPerFrame(), 1);
  const auto step = static_cast<int>((frames + wanted - 1) / wanted);
  if (whole_ && step == 1) return *whole_;
  std::map<Id, Trajectory> animals;
  for (int frame = span_.first; frame <= span_.last; frame += step) {
    if (progress) progress(frame - span_.first, span_.last - span_.first + 1);
    std::optional<Trajectories> rows;
    try {
      rows = Rows(frame, frame);
    } catch (const InputError&) {
      continue;
    }
    if (!rows) continue;
    sample.fps = rows->fps;
    sample.has_velocity = rows->has_velocity;
    sample.has_orientation = rows->has_orientation;
    sample.has_sd_depth = rows->has_sd_depth;
    for (const Trajectory& t : rows->trajectories) {
      Trajectory& mine = animals.try_emplace(t.id, Trajectory{t.id, {}}).first->second;
      mine.points.insert(mine.points.end(), t.points.begin(), t.points.end());
    }
  }
  for (auto& [id, t] : animals) sample.trajectories.push_back(std::move(t));
  return sample;
}

}  // namespace flocklift
