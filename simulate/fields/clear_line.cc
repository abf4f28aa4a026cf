// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/clear_line.h"

#include <algorithm>

namespace flocklift {

bool IsClearLine(const ScalarField& distance, const Vec3d& from, const Vec3d& to,
                 double clearance) {
  const double length = Norm(to - from), least = 0.5 * distance.grid.spacing;
  const Vec3d direction = length > 0 ? (to - from) / length : Vec3d{};
  double done = 0;
  while (true) {
    const double free = distance.Sample(from + done * direction) - clearance;
    if (free < 0) return false;
    if (done + free >= length) return true;
    done = std::min(length, done + std::max(free, least));
  }
}

}  // namespace flocklift
