// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a fit calls determined, by default, is known for its sign (fitter_summary.cc) and may be 20
// % off. Who needs it to be right to a share of itself, asks for that: of what then is called
// determined, one in 370 is farther off where the sd are right.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_KNOWN_WITHIN_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_KNOWN_WITHIN_H_

#include "reconstruct/fit/fit.h"

namespace flocklift::internal {

// Flags as not determined, too, what 3 sd are more than `share` of, and says so. 0: nothing.
void FlagLooselyKnown(double share, FitResult* result);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_KNOWN_WITHIN_H_
