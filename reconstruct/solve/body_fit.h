// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the forms of their images tell of the animals' bodies, and of how far they lean into their
// turns: with paths as they are known, wings that lie level and wings that bank, a long and a short
// body, wide and narrow wingbeats make images that are stretched in other directions. A sighting
// tells its ellipticity, body_image.h what a body's should be. Unknown are the lean, the amplitude
// of the wingbeat and, of boxes, the length of the body, of shapes, the second moment of its trunk.
// Gauss-Newton with Huber's weights; errors are independent after half a second, and their sd is
// that of what is left.
// A camera shows every body along the ray to it. Pictures that are scaled by depth and put in their
// places, and boxes made from such, show it along the optical axis wherever it is (weak
// perspective). Where the camera does not turn, that is fitted too; 1 in 10 beforehand.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_BODY_FIT_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_BODY_FIT_H_

#include <vector>

#include "reconstruct/initialize/segments.h"
#include "reconstruct/solve/batch_problem.h"

namespace flocklift::internal {

// Finds the model's body (but for its share) and the prior of its lean. `lean` is what was known
// before. Returns false, and leaves the model, where there is nothing to be seen of it: no forms,
// or gravity not known.
bool FitBody(const Segments& segments, const Uncertain& lean, const std::vector<Bird>& birds,
             BatchModel* model);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_BODY_FIT_H_
