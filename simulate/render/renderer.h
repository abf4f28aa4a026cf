// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From animals in flight to a picture. A pixel of background B behind an animal of tone A is
//   B + c exp(-z / haze) (A - B),
// c the share of the pixel that the silhouette covers, averaged over the time that the shutter is
// open (centred on the frame's time), z the animal's depth; nearer animals are drawn over farther
// ones; sensor noise comes last. A picture depends on the arguments and the seed alone.

#ifndef FLOCKLIFT_SIMULATE_RENDER_RENDERER_H_
#define FLOCKLIFT_SIMULATE_RENDER_RENDERER_H_

#include <cstdint>
#include <span>

#include "simulate/camera/camera.h"
#include "simulate/core/image.h"
#include "simulate/core/scene.h"
#include "simulate/render/background.h"
#include "simulate/render/body.h"
#include "simulate/render/sensor_noise.h"

namespace flocklift {

class FlockRenderer {
 public:
  // Throws std::invalid_argument when the camera has no size, or `spec` is out of range: noise and
  // haze >= 0, blur in [0, 1], a background that exists, fps > 0.
  FlockRenderer(const Camera& camera, const RenderSpec& spec, double fps, std::uint64_t seed);

  // `frame` (from 1) chooses noise, clouds and a moving camera's pose, `time` [s] the wings' phase.
  // May be called from several threads at once.
  Image Render(int frame, double time, std::span<const FlyingAnimal> animals) const;

 private:
  Camera camera_;
  RenderSpec spec_;
  double shutter_;  // time that it is open [s]
  std::uint64_t seed_;
  Background background_;
  SensorNoise noise_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_RENDERER_H_
