// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The kinds of residuals of the batch method, and their losses: Huber's beyond so many sds where
// what is seen may be wrong, none where a prior speaks.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_TERMS_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_TERMS_H_

#include <functional>

#include "reconstruct/solve/arrow_system.h"

namespace flocklift::internal {

enum class Term {
  kReprojection,
  kAcceleration,
  kSpeed,
  kSize,
  kClimb,
  kDepth,
  kSpeedSpread,
  kSizeSpread,
  kAnchor,
  kBounds,
  kAnyVelocity,
  kTurn,
  kView,
  kAlong,
};
inline constexpr int kTermCount = 14;
const char* NameOf(Term term);

// Residuals beyond this many sds count linearly (Huber's loss); 0: never.
double HuberLimit(Term term);

// Robust cost of one residual, and its weight in the normal equations.
double RobustCost(Term term, double residual);
double RobustWeight(Term term, double residual);

using RowSink = std::function<void(Term, const ResidualRow&)>;

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_TERMS_H_
