// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/crowd_start.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

namespace flocklift {

ArrivalVelocity VelocityOfArrival(const std::vector<TrajectoryPoint>& path, std::size_t k,
                                  double fps, int substeps) {
  const auto difference = [&](std::size_t from) {
    const TrajectoryPoint &a = path[from], &b = path[from + 1];
    return (b.position - a.position) * (fps / (b.frame - a.frame));
  };
  if (path.size() < 2) return {};
  if (k == 0) return {.mean = difference(0), .doubt = {}};
  const Vec3d before = difference(k - 1);
  if (k + 1 == path.size()) return {.mean = before, .doubt = {}};
  const Vec3d change = difference(k) - before;  // from half a frame before to half a frame after
  return {.mean = before + 0.5 * (1 - 1.0 / substeps) * change, .doubt = 0.5 * change};
}

std::size_t CrowdStartFrame(const std::vector<FramePositions>& frames, const ModelSpec& crowd,
                            std::int64_t first_step, int substeps, double dt) {
  const double interval = std::get<CrowdParameters>(ResolveModel(crowd)).interval;
  const auto steps = static_cast<std::int64_t>(std::max(1.0, std::round(interval / dt)));
  std::optional<std::size_t> fullest;
  for (std::size_t f = 1; f + 2 < frames.size(); ++f) {  // that many frames have statistics
    if ((first_step + static_cast<std::int64_t>(f) * substeps) % steps != 0) continue;
    if (!fullest || frames[f].id.size() > frames[*fullest].id.size()) fullest = f;
  }
  return fullest ? *fullest : FullestFrame(frames);
}

}  // namespace flocklift
