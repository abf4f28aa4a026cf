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

  std::string Take() { return std::move(text_); }

 private:
  std::string text_;
};

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
  out->Text("model", species.model.name);
  if (species.model.parameters.empty()) return;
  out->Heading("[species.parameters]");
  for (const auto& [key, value] : species.model.parameters) {
    out->Number(internal::TomlKey(key), value);
  }
}

void Append(const GoalSpec& goal, SceneText* out) {
  out->Heading("[[goal]]");
  if (!goal.species.empty()) out->Text("species", goal.species);
  out->Raw("position", FormatVector(goal.position));
  out->Number("radius", goal.radius);
  out->Number("period", goal.period);
  out->Number("weight", goal.weight);
}

void Append(const PredatorSpec& predator, SceneText* out) {
  out->Heading("[[predator]]");
  out->Integer("count", static_cast<std::uint64_t>(predator.count));
  out->Number("speed", predator.speed);
  out->Number("fear_radius", predator.fear_radius);
  out->Number("fear_weight", predator.fear_weight);
  out->Number("turn_interval", predator.turn_interval);
}

void Append(const CameraSpec& camera, SceneText* out) {
  out->Heading("[camera]");
  if (camera.file) {
    out->Text("file", std::filesystem::absolute(*camera.file).string());
    return;
  }
  out->Number("fov", camera.fov_deg);
  out->Raw("size", fmt::format("[{}, {}]", camera.width, camera.height));
  out->Raw("position", FormatVector(camera.position));
  out->Raw("look_at", FormatVector(camera.look_at));
}

void Append(const RenderSpec& render, SceneText* out) {
  out->Heading("[render]");
  out->Text("background", render.background);
  out->Number("noise", render.noise);
  out->Number("blur", render.blur);
  out->Number("haze", render.haze);
  out->Number("cloud_speed", render.cloud_speed_px);
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
  Append(scene.camera, &out);
  Append(scene.render, &out);
  return out.Take();
}

void WriteScene(const std::filesystem::path& path, const Scene& scene) {
  WriteTextFile(path, FormatScene(scene));
}

}  // namespace flocklift
