// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The form of the boxes of a flock, apart from their size: with width w and height h in pixels
//   form = log (w / h)
// in every measured box that lies whole in the picture. A bird that beats its wings or turns
// changes it; a ball, or a detector with boxes of one form, does not.

#ifndef FLOCKLIFT_RECONSTRUCT_INITIALIZE_BOX_FORM_H_
#define FLOCKLIFT_RECONSTRUCT_INITIALIZE_BOX_FORM_H_

#include "simulate/camera/camera.h"
#include "simulate/core/observations.h"

namespace flocklift {

struct BoxForm {
  double log_diagonal = 0;  // log of (diagonal over the longer side), mean
  double sd = 1;            // of the form about its track's mean; 1 where that is not known
};

BoxForm FormOfBoxes(const Tracks& tracks, const Camera& camera);

// A box that the edge of the picture cuts off shows neither the size nor the middle of the animal.
bool IsCutOff(const Box& box, const Camera& camera);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_INITIALIZE_BOX_FORM_H_
