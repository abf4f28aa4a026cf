// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/terms.h"

#include <cmath>

namespace flocklift::internal {

const char* NameOf(Term term) {
  switch (term) {
    case Term::kReprojection:
      return "reprojection";
    case Term::kAcceleration:
      return "acceleration";
    case Term::kSpeed:
      return "speed";
    case Term::kSize:
      return "size";
    case Term::kClimb:
      return "level flight";
    case Term::kDepth:
      return "shared depth";
    case Term::kSpeedSpread:
      return "speed between animals";
    case Term::kSizeSpread:
      return "size between animals";
    case Term::kAnchor:
      return "anchors";
    case Term::kBounds:
      return "near and far";
    case Term::kAnyVelocity:
      return "any velocity";
    case Term::kTurn:
      return "common acceleration";
    case Term::kView:
      return "second camera";
    case Term::kAlong:
      return "speed along the line of sight";
  }
  return "";
}

double HuberLimit(Term term) {
  switch (term) {
    case Term::kReprojection:
    case Term::kAcceleration:
    case Term::kSpeed:
    case Term::kClimb:
    case Term::kAnchor:
    case Term::kView:
    case Term::kAlong:
      return 3;
    case Term::kSize:
      return 2;
    default:
      return 0;
  }
}

double RobustCost(Term term, double residual) {
  const double limit = HuberLimit(term);
  const double a = std::abs(residual);
  return limit == 0 || a <= limit ? 0.5 * a * a : limit * (a - 0.5 * limit);
}

double RobustWeight(Term term, double residual) {
  const double limit = HuberLimit(term);
  const double a = std::abs(residual);
  return limit == 0 || a <= limit ? 1 : limit / a;
}

}  // namespace flocklift::internal
