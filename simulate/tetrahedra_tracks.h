// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a perfect tracker would see of a flock of tetrahedra, whose film shows them as such and not
// as birds.

#ifndef FLOCKLIFT_SIMULATE_TETRAHEDRA_TRACKS_H_
#define FLOCKLIFT_SIMULATE_TETRAHEDRA_TRACKS_H_

#include <functional>
#include <span>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/observations.h"
#include "simulate/core/trajectory.h"
#include "simulate/core/vec3.h"
#include "simulate/render/scenery.h"

namespace flocklift {

// The corners of all in a frame, four each one after the other (world, m). Called from several
// threads at once.
using TetrahedraAt = std::function<std::vector<Vec3d>(int frame)>;

// As SynthesizeTracks (simulate/synthetic.h): tetrahedron k has the id ids[k] and is where the mean
// of its corners is; its box is centred on that place in the image. One that reaches behind the
// camera is not seen.
Tracks SynthesizeTetrahedraTracks(std::span<const Id> ids, const TetrahedraAt& corners_at,
                                  const FrameSpan& span, const Camera& camera, double fps,
                                  int threads = 1, const Scenery* scenery = nullptr);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_TETRAHEDRA_TRACKS_H_
