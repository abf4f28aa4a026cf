// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "simulate/core/atomic_file.h"
#include "simulate/core/scene_io.h"
#include "simulate/core/settings.h"

namespace flocklift {
namespace {

std::string FormatVector(const Vec3d& v) {
  return fmt::format("[{}, {}, {}]", internal::TomlNumber(v.x), internal::TomlNumber(v.y),
                     internal::TomlNumber(v.z));
}

std::string FormatRegion(const Region& region) {
  return fmt::format("[{}, {}]", FormatVector(region.low), FormatVector(region.high));
}

// Appends headings and `key = value` lines.
class SceneText {
 public:
  void Heading(std::string_view heading) {
    fmt::format_to(std::back_inserter(text_), "{}{}\n", text_.empty() ? "" : "\n", heading);
  }
  void Raw(std::string_view key, std::string_view value) {
    fmt::format_to(std::back_inserter(text_), "{} = {}\n", key, value);
  }
  void Number(std::string_view key, double value) { Raw(key, internal::TomlNumber(value)); }
  void Integer(std::string_view key, std::uint64_t value) { Raw(key, std::to_string(value)); }
  void Text(std::string_view key, std::string_view value) { Raw(key, internal::TomlText(value)); }
  void Flag(std::string_view key, bool value) { Raw(key, value ? "true" : "false"); }
  void File(std::string_view key, const std::filesystem::path& value) {
    Text(key, std::filesystem::absolute(value).string());
  }
  template <typename Item, typename Format>
  void List(std::string_view key, const std::vector<Item>& items, const Format& format) {
    std::string text;
    for (const Item& item : items) text += (text.empty() ? "" : ", ") + format(item);
    Raw(key, "[" + text + "]");
  }

  std::string Take() { return std::move(text_); }

 private:
  std::string text_;
};

void AppendSettings(const ModelSpec& model, SceneText* out) {
  for (const auto& [key, value] : model.parameters) out->Number(internal::TomlKey(key), value);
  for (const auto& [key, word] : model.choices) out->Text(internal::TomlKey(key), word);
}

void Append(const SpeciesSpec& species, SceneText* out) {
  out->Heading("[[species]]");
  out->Text("name", species.name);
  out->Integer("count", static_cast<std::uint64_t>(species.count));
  out->Number("wingspan", species.wingspan);
  out->Number("wingspan_spread", species.wingspan_spread);
  out->Number("body_length", species.body_length);
  out->Number("wingbeat_hz", species.wingbeat_hz);
  out->Number("speed", species.speed);
  out->Number("speed_spread", species.speed_spread);
  if (species.start) out->Raw("start", FormatRegion(*species.start));
  if (!species.start_shape.empty()) out->Text("start", species.start_shape);
  if (!species.shape.empty()) out->Text("shape", species.shape);
  if (!species.path.empty()) out->Text("path", species.path);
  out->Text("model", species.model.name);
  if (!species.model.parameters.empty() || !species.model.choices.empty()) {
    out->Heading("[species.parameters]");
    AppendSettings(species.model, out);
  }
  for (const ModelSpec& force : species.forces) {
    out->Heading("[[species.force]]");
    out->Text("type", force.name);
    AppendSettings(force, out);
  }
}

void Append(const GoalSpec& goal, SceneText* out) {
  out->Heading("[[goal]]");
  if (!goal.species.empty()) out->Text("species", goal.species);
  out->Raw("position", FormatVector(goal.position));
  out->Number("radius", goal.radius);
  out->Number("period", goal.period);
  out->Number("weight", goal.weight);
  out->Number("reach", goal.reach);
  if (goal.waypoints.empty()) return;
  out->List("waypoints", goal.waypoints, [](const Waypoint& point) {
    return fmt::format("{{ time = {}, position = {} }}", internal::TomlNumber(point.time),
                       FormatVector(point.position));
  });
}

void Append(const PredatorSpec& predator, SceneText* out) {
  out->Heading("[[predator]]");
  out->Integer("count", static_cast<std::uint64_t>(predator.count));
  out->Text("hunt", predator.chases ? "chase" : "wander");
  out->Number("speed", predator.speed);
  out->Number("fear_radius", predator.fear_radius);
  out->Number("fear_weight", predator.fear_weight);
  out->Number("turn_interval", predator.turn_interval);
}

void Append(const Placement& placement, SceneText* out) {
  out->Raw("position", FormatVector(placement.position));
  out->Number("yaw", placement.yaw_deg);
  out->Number("scale", placement.scale);
}

void Append(const ObstacleSpec& obstacle, SceneText* out) {
  out->Heading("[[obstacle]]");
  if (obstacle.mesh) out->File("mesh", *obstacle.mesh);
  if (obstacle.box) out->Raw("box", FormatRegion(*obstacle.box));
  if (obstacle.radius > 0) out->Number("radius", obstacle.radius);
  Append(obstacle.placement, out);
}

void Append(const ShapeSpec& shape, SceneText* out) {
  out->Heading("[[shape]]");
  out->Text("name", shape.name);
  if (!shape.path.empty()) out->Text("path", shape.path);
  out->List("key_frames", shape.key_frames, [](const ShapeSpec::KeyFrame& frame) {
    return fmt::format("{{ mesh = {}, time = {} }}",
                       internal::TomlText(std::filesystem::absolute(frame.mesh).string()),
                       internal::TomlNumber(frame.time));
  });
  out->Number("period", shape.period);
  Append(shape.placement, out);
}

void Append(const PathSpec& path, SceneText* out) {
  out->Heading("[[path]]");
  out->Text("name", path.name);
  out->List("points", path.points, FormatVector);
  out->Number("speed", path.speed);
  out->Number("width", path.width);
}

void Append(const WindSpec& wind, SceneText* out) {
  out->Heading("[wind]");
  out->Raw("velocity", FormatVector(wind.velocity));
  out->Number("gust", wind.gust);
  out->Number("gust_time", wind.gust_time);
}

void Append(const EventSpec& event, SceneText* out) {
  out->Heading("[[event]]");
  out->Number("time", event.time);
  if (!event.species.empty()) out->Text("species", event.species);
  if (event.goal) {
    out->Integer("goal", *event.goal);
    out->Raw("position", FormatVector(event.position));
  }
  if (event.wind) out->Raw("wind", FormatVector(*event.wind));
  if (event.change.parameters.empty() && event.change.choices.empty()) return;
  out->Heading("[event.parameters]");
  AppendSettings(event.change, out);
}

void Append(const CameraSpec& camera, SceneText* out) {
  out->Heading("[camera]");
  if (camera.file) {
    out->File("file", *camera.file);
    return;
  }
  out->Number("fov", camera.fov_deg);
  out->Raw("size", fmt::format("[{}, {}]", camera.width, camera.height));
  out->Raw("position", FormatVector(camera.position));
  out->Raw("look_at", FormatVector(camera.look_at));
  if (camera.path.empty()) return;
  out->List("path", camera.path, [](const CameraSpec::Pose& pose) {
    return fmt::format("{{ time = {}, position = {}, look_at = {} }}",
                       internal::TomlNumber(pose.time), FormatVector(pose.position),
                       FormatVector(pose.look_at));
  });
}

void Append(const RenderSpec& render, SceneText* out) {
  out->Heading("[render]");
  out->Text("background", render.background);
  out->Number("noise", render.noise);
  out->Number("blur", render.blur);
  out->Number("haze", render.haze);
  out->Number("cloud_speed", render.cloud_speed_px);
  out->Flag("obstacles", render.obstacles);
  out->Flag("goals", render.goals);
  out->Flag("paths", render.paths);
  out->Flag("ground", render.ground);
}

}  // namespace

std::string FormatScene(const Scene& scene) {
  SceneText out;
  out.Heading("[scene]");
  out.Integer("version", static_cast<std::uint64_t>(scene.version));
  out.Integer("seed", scene.seed);
  out.Number("duration", scene.duration);
  out.Number("fps", scene.fps);
  out.Integer("substeps", static_cast<std::uint64_t>(scene.substeps));
  out.Integer("dimensions", static_cast<std::uint64_t>(scene.dimensions));
  out.Number("warmup", scene.warmup);
  out.Raw("box", FormatRegion(scene.box));
  for (const SpeciesSpec& species : scene.species) Append(species, &out);
  for (const GoalSpec& goal : scene.goals) Append(goal, &out);
  for (const PredatorSpec& predator : scene.predators) Append(predator, &out);
  for (const ObstacleSpec& obstacle : scene.obstacles) Append(obstacle, &out);
  for (const ShapeSpec& shape : scene.shapes) Append(shape, &out);
  for (const PathSpec& path : scene.paths) Append(path, &out);
  Append(scene.wind, &out);
  for (const EventSpec& event : scene.events) Append(event, &out);
  Append(scene.camera, &out);
  Append(scene.render, &out);
  return out.Take();
}

void WriteScene(const std::filesystem::path& path, const Scene& scene) {
  WriteTextFile(path, FormatScene(scene));
}

}  // namespace flocklift
