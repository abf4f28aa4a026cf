// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A scene, schema version 1: which animals move by which rules, where the camera stands, how the
// film looks. The file (TOML) is described in data_synthetic/README.md.

#ifndef FLOCKLIFT_SIMULATE_CORE_SCENE_H_
#define FLOCKLIFT_SIMULATE_CORE_SCENE_H_

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

// An axis-aligned box [m].
struct Region {
  Vec3d low, high;

  Vec3d Center() const { return (low + high) * 0.5; }
};

// The name of a model or force term and its numbers by name; which names there are, and their
// defaults, is the model's business (simulate/flock).
struct ModelSpec {
  std::string name;
  std::map<std::string, double> parameters;
  std::string where;  // "FILE:LINE" for messages; empty when not read from a file
  std::map<std::string, std::string> where_of;  // the same for each parameter

  // What a message about a parameter starts with.
  const std::string& WhereOf(const std::string& parameter) const {
    const auto found = where_of.find(parameter);
    return found == where_of.end() ? where : found->second;
  }
};

struct SpeciesSpec {
  std::string name = "bird";
  int count = 30;
  double wingspan = 0.7;          // tip to tip, mean of the individuals [m]
  double wingspan_spread = 0.05;  // sd of log wingspan between individuals
  double body_length = 0.35;      // [m]
  double wingbeat_hz = 5;         // [1/s]
  double speed = 10;              // mean cruising speed [m/s]
  double speed_spread = 0.08;     // relative sd of the individuals' cruising speed
  std::optional<Region> start;    // default: the middle half of the box
  ModelSpec model{.name = "boids", .parameters = {}, .where = {}, .where_of = {}};
};

// A point that attracts; it may move on a circle about `position` in the horizontal plane.
struct GoalSpec {
  std::string species;  // empty: all
  Vec3d position;
  double radius = 0;  // of the circle [m]
  double period = 0;  // of one turn [s]; 0: it stands still
  double weight = 1;  // [1/s^2]
};

struct PredatorSpec {
  int count = 1;
  double speed = 12;         // [m/s]
  double fear_radius = 10;   // animals nearer than this flee [m]
  double fear_weight = 1;    // strength of fleeing [m/s^2]
  double turn_interval = 2;  // a new random direction about every so often [s]
};

struct CameraSpec {
  std::optional<std::filesystem::path> file;  // instead of all below
  double fov_deg = 50;                        // horizontal
  int width = 1920, height = 1080;            // [px]
  Vec3d position{0, -45, 1.7};
  Vec3d look_at{0, 0, 12};
};

struct RenderSpec {
  std::string background = "clouds";  // plain, sky or clouds
  double noise = 3;                   // sensor noise, sd [grey levels of 255]
  double blur = 0.3;                  // share of the frame time that the shutter is open
  double haze = 300;                  // contrast falls by 1/e over this distance [m]; 0: none
  double cloud_speed_px = 0.5;        // drift of the clouds [px/frame]
};

struct Scene {
  int version = 1;
  std::uint64_t seed = 1;
  double duration = 10;                     // [s]
  double fps = 30;                          // [1/s]
  int substeps = 4;                         // integration steps a frame
  int dimensions = 3;                       // 2: z stays 0
  double warmup = 0;                        // simulated before the first frame kept [s]
  Region box{{-20, -20, 2}, {20, 20, 22}};  // soft walls [m]
  std::vector<SpeciesSpec> species;
  std::vector<GoalSpec> goals;
  std::vector<PredatorSpec> predators;
  CameraSpec camera;
  RenderSpec render;

  int FrameCount() const { return static_cast<int>(std::lround(duration * fps)); }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_SCENE_H_
