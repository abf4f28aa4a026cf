// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a page is told of a running scene, as bytes. Little-endian:
//   u32  magic "FLKS", animals N, goals G, number of the look
//   f32  time [s], looks a second, steps a second, unit of velocity U [m/s]
//   f32  goal[3G] [m],  f32 position[3N] [m],  i16 velocity[3N] in units of U
// Animals by id, predators last; padded to a multiple of 4 bytes.

#ifndef FLOCKLIFT_TOOLS_VIEW_SCENE_LOOK_H_
#define FLOCKLIFT_TOOLS_VIEW_SCENE_LOOK_H_

#include <cstdint>
#include <span>
#include <string>

#include "simulate/core/trajectory.h"
#include "simulate/core/vec3.h"

namespace flocklift {

struct LookHead {
  std::uint32_t number = 0;
  double time = 0;  // [s]
  double looks_per_second = 0, steps_per_second = 0;
};

std::string PackLook(const FlockState& state, std::span<const Vec3d> goals, const LookHead& head);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_SCENE_LOOK_H_
