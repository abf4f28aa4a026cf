// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a user knows about the birds besides the film. One static camera does not see absolute
// scale (scaling the whole scene changes nothing in the image), so at least one of speed, wingspan,
// near and far, anchors, or a second camera must be given.

#ifndef FLOCKLIFT_RECONSTRUCT_KNOWLEDGE_H_
#define FLOCKLIFT_RECONSTRUCT_KNOWLEDGE_H_

#include <optional>
#include <string>
#include <vector>

#include "simulate/core/io.h"
#include "simulate/core/vec3.h"

namespace flocklift {

// A number and its standard deviation.
struct Uncertain {
  double mean = 0;
  double sd = 0;
};

struct Knowledge {
  std::optional<Uncertain> speed;     // mean over the flock, and how sure that mean is [m/s]
  std::optional<Uncertain> wingspan;  // tip to tip; sd between animals, and of their mean [m]
  std::optional<double> near, far;    // bounds of depth [m]; one alone bounds, only both fix scale
  std::vector<Anchor> anchors;        // positions that somebody knows
  bool second_camera = false;         // whose tracks show the same animals
  bool use_size = true;               // let boxes and shapes tell relative depth
  std::optional<Vec3d> up_in_cam;     // unit vector against gravity, where it is known
};

// Is there anything that tells how large the scene is?
bool FixesScale(const Knowledge& knowledge);

// Throws std::invalid_argument: nothing that fixes the scale, or numbers out of range.
void CheckKnowledge(const Knowledge& knowledge);

// "speed, wingspan": the names of what fixes the scale, in words of the command line.
std::string ScaleSources(const Knowledge& knowledge);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_KNOWLEDGE_H_
