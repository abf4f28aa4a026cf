// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From trajectories to a video file, frame by frame: never more than a handful of pictures are in
// memory, however long the film.

#ifndef FLOCKLIFT_SIMULATE_RENDER_FILM_H_
#define FLOCKLIFT_SIMULATE_RENDER_FILM_H_

#include <cstdint>
#include <filesystem>
#include <span>

#include "simulate/camera/camera.h"
#include "simulate/core/animal.h"
#include "simulate/core/image.h"
#include "simulate/core/progress.h"
#include "simulate/core/scene.h"
#include "simulate/core/trajectory.h"
#include "simulate/media/video_writer.h"
#include "simulate/render/scenery.h"

namespace flocklift {

struct FilmOptions {
  double fps = 30;         // [1/s]
  int frames = 0;          // film frames 1 to this; 0: up to the trajectories' last
  std::uint64_t seed = 1;  // of noise, clouds and plumage
  int threads = 0;  // that draw; 0: as many as the machine has. The bytes do not depend on it
  VideoOptions video = {};
  const Scenery* scenery = nullptr;  // what stands around the animals; none
};

// Frame k of the film is frame k of the trajectories, from 1. Bodies as in Flight
// (simulate/render/flight.h). Throws as FlockRenderer and VideoWriter do, and
// std::invalid_argument when there is no frame to film.
void FilmTrajectories(const std::filesystem::path& path, const Trajectories& trajectories,
                      std::span<const Animal> animals, const Camera& camera, const RenderSpec& spec,
                      const FilmOptions& options, const Progress& progress = {});

// One frame of that film.
Image DrawFrame(const Trajectories& trajectories, std::span<const Animal> animals,
                const Camera& camera, const RenderSpec& spec, const FilmOptions& options,
                int frame);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_FILM_H_
