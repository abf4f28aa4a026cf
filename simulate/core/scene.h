// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A scene, schema version 1: which animals move by which rules in which surroundings, where the
// camera stands, how the film looks. The file (TOML) is described in data_synthetic/README.md.

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

// The name of a model or force term and its settings by name: numbers, and words where there is a
// choice. Which there are, and their defaults, is the model's business (simulate/flock).
struct ModelSpec {
  std::string name;
  std::map<std::string, double> parameters;
  std::string where;  // "FILE:LINE" for messages; empty when not read from a file
  std::map<std::string, std::string> where_of;      // the same for each parameter
  std::map<std::string, std::string> choices = {};  // of the parameters that are words
  // Of a model that was fitted, the force terms that add to its own (model_terms.h).
  std::vector<ModelSpec> terms = {};

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
  std::string start_shape;        // instead: on the surface of the [[shape]] of this name
  std::string shape;              // the [[shape]] that the animals form, for models with one
  std::string path;               // the [[path]] that they follow, for models with one
  ModelSpec model{.name = "boids", .parameters = {}, .where = {}, .where_of = {}};
  std::vector<ModelSpec> forces = {};  // further terms, added to what the model does
};

// A place at a time.
struct Waypoint {
  double time = 0;  // [s]
  Vec3d position;
};

// A region that attracts: a ball of radius `reach` about a point, which may stand still, move on a
// circle in the horizontal plane, or go straight from waypoint to waypoint.
struct GoalSpec {
  std::string species;  // empty: all
  Vec3d position;
  double radius = 0;                     // of the circle [m]
  double period = 0;                     // of one turn [s]; 0: it stands still
  double weight = 1;                     // [1/s^2]
  double reach = 0;                      // animals nearer than this are there [m]
  std::vector<Waypoint> waypoints = {};  // by increasing time; none: position and circle
};

// Predators wander, or chase the animal that is nearest.
struct PredatorSpec {
  bool chases = false;
  int count = 1;
  double speed = 12;         // [m/s]
  double fear_radius = 10;   // animals nearer than this flee [m]
  double fear_weight = 1;    // strength of fleeing [m/s^2]
  double turn_interval = 2;  // a new random direction about every so often [s]
};

// Where a mesh stands: scaled, turned about the vertical, then moved.
struct Placement {
  Vec3d position;
  double yaw_deg = 0;
  double scale = 1;  // metres per unit of the file
};

// Something solid: a mesh file, a box, or a ball.
struct ObstacleSpec {
  std::optional<std::filesystem::path> mesh;
  Placement placement;  // of the mesh
  std::optional<Region> box;
  double radius = 0;  // of the ball, at placement.position [m]
};

// A surface that animals form: one mesh, or key-frames that share a topology (an animated mesh) or
// not (one shape after the other).
struct ShapeSpec {
  std::string name;
  struct KeyFrame {
    std::filesystem::path mesh;
    double time = 0;  // [s]
  };
  std::vector<KeyFrame> key_frames;  // by increasing time
  double period = 0;                 // of the animation, which repeats; 0: it does not [s]
  Placement placement;
  std::string path;  // the [[path]] along which it moves; empty: it stands
};

// A smooth curve (cubic B-spline) that begins and ends at its first and last points.
struct PathSpec {
  std::string name = "path";
  std::vector<Vec3d> points;  // at least two [m]
  double speed = 0;           // along it; 0: over the scene's duration [m/s]
  double width = 0;           // animals farther aside are drawn back [m]; 0: no limit
};

// A steady wind with gusts: Ornstein-Uhlenbeck, one for all animals.
struct WindSpec {
  Vec3d velocity;        // [m/s]
  double gust = 0;       // standard deviation of each component [m/s]
  double gust_time = 1;  // correlation time [s]
};

// Something that changes while the scene runs.
struct EventSpec {
  double time = 0;                  // [s]
  std::string species;              // whose model's settings change; empty: all
  ModelSpec change;                 // settings by name; the name is unused
  std::optional<std::size_t> goal;  // the [[goal]] that jumps, by its place in the file, from 1
  Vec3d position;                   // ... to here
  std::optional<Vec3d> wind;        // the wind from now on [m/s]
};

struct CameraSpec {
  std::optional<std::filesystem::path> file = {};  // instead of all below
  double fov_deg = 50;                             // horizontal
  int width = 1920, height = 1080;                 // [px]
  Vec3d position{0, -45, 1.7};
  Vec3d look_at{0, 0, 12};
  struct Pose {
    double time = 0;  // [s]
    Vec3d position, look_at;
  };
  std::vector<Pose> path = {};  // by increasing time: the camera moves smoothly through them
};

struct RenderSpec {
  std::string background = "clouds";  // plain, sky or clouds
  double noise = 3;                   // sensor noise, sd [grey levels of 255]
  double blur = 0.3;                  // share of the frame time that the shutter is open
  double haze = 300;                  // contrast falls by 1/e over this distance [m]; 0: none
  double cloud_speed_px = 0.5;        // drift of the clouds [px/frame]
  bool obstacles = true;              // draws the obstacles,
  bool goals = false;                 // ... the goals,
  bool paths = false;                 // ... the paths, for people to see
  bool ground = false;                // ... and a grid of metres at z = 0
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
  std::vector<ObstacleSpec> obstacles = {};
  std::vector<ShapeSpec> shapes = {};
  std::vector<PathSpec> paths = {};
  WindSpec wind = {};
  std::vector<EventSpec> events = {};  // by increasing time
  CameraSpec camera;
  RenderSpec render;

  int FrameCount() const { return static_cast<int>(std::lround(duration * fps)); }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_SCENE_H_
