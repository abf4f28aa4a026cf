// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/surroundings_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/core/suggest.h"
#include "simulate/core/text.h"

namespace flocklift::internal {
namespace {

constexpr double kFar = 1e6;  // of any length [m]

// A species of the scene, or nothing.
void ReadSpeciesName(Settings* settings, const Scene& scene, std::string* species) {
  std::vector<std::string> names;
  for (const SpeciesSpec& known : scene.species) names.push_back(known.name);
  settings->Text("species", species, names);
}

// The numbers of a list that must grow.
template <typename Item>
void CheckOrder(const Settings& settings, std::string_view key, const std::vector<Item>& items,
                double time) {
  if (items.empty() || time > items.back().time) return;
  settings.Fail(key, fmt::format("{} are not in the order of time", key),
                "give each a later time than the one before");
}

GoalSpec ReadGoal(const toml::table& table, const std::string& name, const Scene& scene) {
  Settings settings(table, name, "[[goal]]");
  const bool is_flat = scene.dimensions == 2;
  GoalSpec goal;
  ReadSpeciesName(&settings, scene, &goal.species);
  settings.EachTable("waypoints", [&](const toml::table& point) {
    Settings waypoint(point, name, "waypoints of [[goal]]");
    Waypoint read;
    waypoint.Number("time", &read.time, {-kLongest, kLongest});
    if (!waypoint.Vector("position", &read.position, is_flat)) {
      waypoint.FailMissing("position", "say where: position = [x, y, z]");
    }
    waypoint.FailUnknown();
    CheckOrder(settings, "waypoints", goal.waypoints, read.time);
    goal.waypoints.push_back(read);
  });
  if (!goal.waypoints.empty()) goal.position = goal.waypoints.front().position;
  if (!settings.Vector("position", &goal.position, is_flat) && goal.waypoints.empty()) {
    settings.FailMissing("position", "say where the goal is: position = [x, y, z]");
  }
  settings.Number("radius", &goal.radius, {0, kFar});
  settings.Number("period", &goal.period, {0, kLongest});
  settings.Number("weight", &goal.weight, {0, 1e6});
  settings.Number("reach", &goal.reach, {0, kFar});
  settings.FailUnknown();
  return goal;
}

PredatorSpec ReadPredator(const toml::table& table, const std::string& name) {
  Settings settings(table, name, "[[predator]]");
  PredatorSpec predator;
  std::int64_t count = predator.count;
  if (settings.Integer("count", &count, 1, 1000)) predator.count = static_cast<int>(count);
  std::string hunt = "wander";
  settings.Text("hunt", &hunt, {"wander", "chase"});
  predator.chases = hunt == "chase";
  settings.Number("speed", &predator.speed, {0, kFastest});
  settings.Number("fear_radius", &predator.fear_radius, Limits::Positive(kFar));
  settings.Number("fear_weight", &predator.fear_weight, {0, 1e6});
  settings.Number("turn_interval", &predator.turn_interval, Limits::Positive(kLongest));
  settings.FailUnknown();
  return predator;
}

void ReadPlacement(Settings* settings, Placement* placement) {
  settings->Vector("position", &placement->position, false);
  settings->Number("yaw", &placement->yaw_deg, {-360, 360});
  settings->Number("scale", &placement->scale, Limits::Positive(kFar));
}

ObstacleSpec ReadObstacle(const toml::table& table, const std::string& name) {
  Settings settings(table, name, "[[obstacle]]");
  ObstacleSpec obstacle;
  std::filesystem::path mesh;
  if (settings.File("mesh", &mesh)) obstacle.mesh = mesh;
  ReadPlacement(&settings, &obstacle.placement);
  Region box;
  if (settings.Corners("box", &box.low, &box.high, false)) obstacle.box = box;
  settings.Number("radius", &obstacle.radius, Limits::Positive(kFar));
  settings.FailUnknown();
  const int kinds =
      (obstacle.mesh ? 1 : 0) + (obstacle.box ? 1 : 0) + (obstacle.radius > 0 ? 1 : 0);
  if (kinds != 1) {
    FailAt(table, name, "an obstacle is one of three: mesh, box or radius (a ball)",
           "give exactly one of them");
  }
  return obstacle;
}

ShapeSpec ReadShape(const toml::table& table, const std::string& name) {
  Settings settings(table, name, "[[shape]]");
  ShapeSpec shape;
  if (!settings.Text("name", &shape.name)) settings.FailMissing("name", "give the shape a name");
  ReadPlacement(&settings, &shape.placement);
  settings.Text("path", &shape.path);
  std::filesystem::path mesh;
  if (settings.File("mesh", &mesh)) shape.key_frames.push_back({mesh, 0});
  settings.EachTable("key_frames", [&](const toml::table& key_frame) {
    Settings frame(key_frame, name, "key_frames of [[shape]]");
    ShapeSpec::KeyFrame read;
    if (!frame.File("mesh", &read.mesh)) frame.FailMissing("mesh", "name a mesh file");
    frame.Number("time", &read.time, {0, kLongest});
    frame.FailUnknown();
    CheckOrder(settings, "key_frames", shape.key_frames, read.time);
    shape.key_frames.push_back(read);
  });
  settings.Number("period", &shape.period, {0, kLongest});
  settings.FailUnknown();
  if (shape.key_frames.empty()) {
    FailAt(table, name, "the shape has no mesh",
           "give mesh = \"FILE\", or key_frames = [{ mesh = \"FILE\", time = 0 }, ...]");
  }
  if (shape.period > 0 && shape.period <= shape.key_frames.back().time) {
    settings.Fail("period", "the period is over before the last key-frame",
                  "give a period longer than the last key-frame's time");
  }
  return shape;
}

PathSpec ReadPath(const toml::table& table, const std::string& name) {
  Settings settings(table, name, "[path]");
  PathSpec path;
  settings.Text("name", &path.name);
  settings.Points("points", &path.points);
  if (path.points.size() < 2) {
    FailAt(table, name, "a path has fewer than two points",
           "give points = [[x, y, z], [x, y, z], ...]");
  }
  settings.Number("speed", &path.speed, {0, kFastest});
  settings.Number("width", &path.width, {0, kFar});
  settings.FailUnknown();
  return path;
}

WindSpec ReadWind(const toml::table& table, const std::string& name) {
  Settings settings(table, name, "[wind]");
  WindSpec wind;
  settings.Vector("velocity", &wind.velocity, false);
  settings.Number("gust", &wind.gust, {0, kFastest});
  settings.Number("gust_time", &wind.gust_time, Limits::Positive(kLongest));
  settings.FailUnknown();
  return wind;
}

EventSpec ReadEvent(const toml::table& table, const std::string& name, const Scene& scene) {
  Settings settings(table, name, "[[event]]");
  EventSpec event;
  if (!settings.Number("time", &event.time, {-kLongest, kLongest})) {
    settings.FailMissing("time", "say when it happens, in seconds");
  }
  ReadSpeciesName(&settings, scene, &event.species);
  if (const toml::table* parameters = settings.FindTable("parameters")) {
    event.change.where = settings.Where("parameters");
    Settings(*parameters, name, "parameters of [[event]]").AllOthers(&event.change);
  }
  std::int64_t goal = 0;
  if (settings.Integer("goal", &goal, 1, static_cast<std::int64_t>(scene.goals.size()))) {
    event.goal = static_cast<std::size_t>(goal);
    if (!settings.Vector("position", &event.position, scene.dimensions == 2)) {
      settings.FailMissing("position", "say where the goal jumps to: position = [x, y, z]");
    }
  }
  Vec3d wind;
  if (settings.Vector("wind", &wind, false)) event.wind = wind;
  settings.FailUnknown();
  return event;
}

template <typename Spec>
void CheckName(const std::string& file, const std::string& owner, std::string_view kind,
               const std::string& wanted, const std::vector<Spec>& known) {
  if (wanted.empty()) return;
  std::vector<std::string> names;
  for (const Spec& spec : known) names.push_back(spec.name);
  if (std::find(names.begin(), names.end(), wanted) != names.end()) return;
  throw InputError(file, 0,
                   fmt::format("{} has the {} {}, which is not there", owner, kind, Quoted(wanted)),
                   names.empty() ? fmt::format("add a table [[{}]] of that name", kind)
                                 : SuggestName(wanted, names));
}

template <typename Spec>
void CheckUnique(const toml::table& table, const std::string& name, std::string_view kind,
                 const Spec& spec, const std::vector<Spec>& before) {
  if (std::none_of(before.begin(), before.end(),
                   [&](const Spec& other) { return other.name == spec.name; })) {
    return;
  }
  FailAt(table, name, fmt::format("two {} are called {}", kind, Quoted(spec.name)),
         "give each a name of its own");
}

}  // namespace

void ReadSurroundings(Settings* file, Scene* scene) {
  const std::string& name = file->name();
  file->EachTable("goal", [&](const toml::table& table) {
    scene->goals.push_back(ReadGoal(table, name, *scene));
  });
  file->EachTable("predator", [&](const toml::table& table) {
    scene->predators.push_back(ReadPredator(table, name));
  });
  file->EachTable("obstacle", [&](const toml::table& table) {
    scene->obstacles.push_back(ReadObstacle(table, name));
  });
  file->EachTable("shape", [&](const toml::table& table) {
    ShapeSpec shape = ReadShape(table, name);
    CheckUnique(table, name, "shapes", shape, scene->shapes);
    scene->shapes.push_back(std::move(shape));
  });
  const auto add_path = [&](const toml::table& table) {
    PathSpec path = ReadPath(table, name);
    CheckUnique(table, name, "paths", path, scene->paths);
    scene->paths.push_back(std::move(path));
  };
  if (const toml::node* path = file->Find("path"); path != nullptr && path->is_table()) {
    add_path(*path->as_table());
  } else {
    file->EachTable("path", add_path);
  }
  if (const toml::table* wind = file->FindTable("wind")) scene->wind = ReadWind(*wind, name);
  file->EachTable("event", [&](const toml::table& table) {
    const EventSpec event = ReadEvent(table, name, *scene);
    if (!scene->events.empty() && event.time < scene->events.back().time) {
      FailAt(table, name, "the events are not in the order of time",
             "put each after those that happen before it");
    }
    scene->events.push_back(event);
  });
}

void CheckNamesOfSurroundings(const std::string& name, const Scene& scene) {
  for (const SpeciesSpec& species : scene.species) {
    const std::string owner = "species " + Quoted(species.name);
    CheckName(name, owner, "shape", species.shape, scene.shapes);
    CheckName(name, owner, "shape", species.start_shape, scene.shapes);
    CheckName(name, owner, "path", species.path, scene.paths);
  }
  for (const ShapeSpec& shape : scene.shapes) {
    CheckName(name, "shape " + Quoted(shape.name), "path", shape.path, scene.paths);
  }
}

}  // namespace flocklift::internal
