// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From animals in flight to a picture. A pixel of background B behind an animal of tone A is
//   B + c exp(-z / haze) (A - B),
// c the share of the pixel that the silhouette covers, averaged over the time that the shutter is
// open (centred on the frame's time), z the animal's depth; nearer animals are drawn over farther
// ones, and surfaces hide what is behind them (canvas.h); sensor noise comes last. Animals below
// kSpeckPx are drawn as specks of the same darkness (speck.h). A picture depends on the arguments
// and the seed alone.

#ifndef FLOCKLIFT_SIMULATE_RENDER_RENDERER_H_
#define FLOCKLIFT_SIMULATE_RENDER_RENDERER_H_

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "simulate/camera/camera.h"
#include "simulate/core/image.h"
#include "simulate/core/scene.h"
#include "simulate/render/background.h"
#include "simulate/render/body.h"
#include "simulate/render/marks.h"
#include "simulate/render/sensor_noise.h"
#include "simulate/render/speck.h"
#include "simulate/render/surface.h"

namespace flocklift {

// What stands around the animals in one frame.
struct Setting {
  std::span<const Surface> surfaces;
  std::span<const Stroke> strokes;
  std::span<const TintedBall> balls;
};

class FlockRenderer {
 public:
  // Throws std::invalid_argument when the camera has no size, or `spec` is out of range: noise and
  // haze >= 0, blur in [0, 1], a background that exists, fps > 0.
  FlockRenderer(const Camera& camera, const RenderSpec& spec, double fps, std::uint64_t seed);
  ~FlockRenderer();

  // `frame` (from 1) chooses noise, clouds and a moving camera's pose, `time` [s] the wings' phase.
  // May be called from several threads at once.
  Image Render(int frame, double time, std::span<const FlyingAnimal> animals,
               const Setting& setting = {}) const;

 private:
  // Memory that one frame needs, kept for the next.
  struct Bench;
  std::unique_ptr<Bench> TakeBench() const;
  void Sketch(std::span<const FlyingAnimal> animals, int frame, double time,
              const Rigid3d& cam_from_world, std::vector<Patch>* patches, Bench* bench) const;

  Camera camera_;
  RenderSpec spec_;
  double shutter_;  // time that it is open [s]
  std::uint64_t seed_;
  Background background_;
  SensorNoise noise_;
  SurfacePainter surface_painter_;
  SpeckAreas speck_areas_;
  mutable std::mutex idle_mutex_;
  mutable std::vector<std::unique_ptr<Bench>> idle_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_RENDERER_H_
