// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Projects a point, steps a flock, tracks two moving dots; exit status 0 when all is as it must be.

#include <cmath>
#include <cstdio>
#include <vector>

#include "reconstruct/presets.h"
#include "simulate/camera/calibrate.h"
#include "simulate/camera/projection.h"
#include "simulate/flock/engine.h"
#include "simulate/media/image_codec.h"
#include "track/tracker.h"

namespace {

bool ProjectsAPoint() {
  const flocklift::Camera camera = flocklift::PinholeCamera(90, 1000, 500);
  const auto pixel = flocklift::ProjectVisible(camera, {1, 0, 2});
  return pixel && std::abs(pixel->x - (499.5 + 250)) < 1e-9 && std::abs(pixel->y - 249.5) < 1e-9;
}

bool StepsAFlock() {
  flocklift::Swarm swarm;
  swarm.model = flocklift::ResolveModel({.name = "boids", .parameters = {}, .where = {}});
  swarm.position = {{0, 0, 0}, {3, 0, 0}};
  swarm.velocity = {{8, 0, 0}, {8, 0, 0}};
  flocklift::Engine engine({}, {swarm}, {});
  for (int step = 0; step < 120; ++step) engine.Step();
  const flocklift::FlockState state = engine.State();
  return state.size() == 2 && state.position[0].x > 3;
}

bool TracksTwoDots() {
  std::vector<flocklift::DetectionFrame> frames;
  for (int frame = 1; frame <= 30; ++frame) {
    flocklift::DetectionFrame& there = frames.emplace_back();
    there.frame = frame;
    for (const double v : {100.0, 300.0}) {
      flocklift::Detection& dot = there.detections.emplace_back();
      dot.frame = frame;
      dot.box = flocklift::Box::Around({50 + 6.0 * frame, v}, 10, 6);
    }
  }
  const auto result = flocklift::TrackDetections({}, frames, 640, 480, 30);
  return result.tracks.tracklets.size() == 2;
}

bool KeepsAPicture() {
  const flocklift::Image image(7, 5);
  const auto back = flocklift::DecodeImage(flocklift::EncodePng(image));
  return back && back->bgr == image.bgr;
}

bool KnowsASpecies() { return flocklift::PresetOf("jackdaw").wingspan.mean > 0.3; }

bool RefusesToCalibrateWithoutViews() {
  try {
    flocklift::CalibrateCamera({}, 640, 480, {});
  } catch (const std::invalid_argument&) {
    return true;
  }
  return false;
}

}  // namespace

int main() {
  int failed = 0;
  const auto expect = [&failed](bool good, const char* what) {
    std::printf("%s: %s\n", what, good ? "as expected" : "WRONG");
    failed += good ? 0 : 1;
  };
  expect(ProjectsAPoint(), "project a point");
  expect(StepsAFlock(), "step a flock");
  expect(TracksTwoDots(), "track two dots");
  expect(KeepsAPicture(), "keep a picture");
  expect(KnowsASpecies(), "know a species");
  expect(RefusesToCalibrateWithoutViews(), "refuse to calibrate without views");
  return failed;
}
