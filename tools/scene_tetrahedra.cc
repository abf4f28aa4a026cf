// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/scene_tetrahedra.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <utility>

#include "simulate/render/surface.h"
#include "simulate/shapes/animated_mesh_frames.h"
#include "simulate/tetrahedra_tracks.h"

namespace flocklift {
namespace {

constexpr std::array<Color, 3> kTones{{{70, 140, 225}, {190, 130, 60}, {90, 170, 110}}};

bool IsMorph(const SpeciesSpec& species) { return species.model.name == "morph"; }

// Calls use(k, is_tetrahedron) for every animal of a result, in order.
template <typename Use>
void ForEachAnimal(const Scene& scene, const SceneResult& result, const Use& use) {
  std::size_t next = 0;
  for (const SpeciesSpec& species : scene.species) {
    for (int k = 0; k < species.count; ++k) use(next++, IsMorph(species));
  }
  while (next < result.animals.size()) use(next++, false);  // the predators
}

}  // namespace

bool HasTetrahedra(const Scene& scene) {
  return std::any_of(scene.species.begin(), scene.species.end(), IsMorph);
}

void AddTetrahedra(const Scene& scene, const std::filesystem::path& path, Scenery* scenery) {
  const auto frames = std::make_shared<const AnimatedMeshFrames>(path);
  MovingSurface surface;
  surface.triangles = TetrahedraFaces(frames->vertex_count() / 4);
  std::size_t which = 0;
  for (const SpeciesSpec& species : scene.species) {
    if (!IsMorph(species)) continue;
    surface.tones.insert(surface.tones.end(), 4 * static_cast<std::size_t>(species.count),
                         kTones[which++ % kTones.size()]);
  }
  surface.is_closed = true;
  surface.at = [frames](int frame, std::vector<Vec3d>* vertices, std::vector<Vec3d>*) {
    *vertices = frames->Frame(static_cast<std::size_t>(frame - 1));
  };
  scenery->AddSurface(std::move(surface));
}

void AddTetrahedraTracks(const Scene& scene, const SceneResult& result,
                         const std::filesystem::path& path, const Camera& camera, int threads,
                         const Scenery* scenery, Tracks* tracks) {
  std::vector<Id> ids;
  ForEachAnimal(scene, result, [&](std::size_t k, bool is_tetrahedron) {
    if (is_tetrahedron) ids.push_back(result.animals[k].id);
  });
  const AnimatedMeshFrames frames(path);
  Tracks more = SynthesizeTetrahedraTracks(
      ids, [&](int frame) { return frames.Frame(static_cast<std::size_t>(frame - 1)); },
      {1, scene.FrameCount()}, camera, scene.fps, threads, scenery);
  std::move(more.tracklets.begin(), more.tracklets.end(), std::back_inserter(tracks->tracklets));
  std::sort(tracks->tracklets.begin(), tracks->tracklets.end(),
            [](const Tracklet& a, const Tracklet& b) { return a.id < b.id; });
}

DrawnAnimals WithoutTetrahedra(const Scene& scene, const SceneResult& result) {
  DrawnAnimals drawn;
  drawn.trajectories.fps = result.truth.fps;
  drawn.trajectories.has_velocity = result.truth.has_velocity;
  drawn.trajectories.has_orientation = result.truth.has_orientation;
  ForEachAnimal(scene, result, [&](std::size_t k, bool is_tetrahedron) {
    if (is_tetrahedron) return;
    drawn.trajectories.trajectories.push_back(result.truth.trajectories[k]);
    drawn.animals.push_back(result.animals[k]);
  });
  return drawn;
}

}  // namespace flocklift
