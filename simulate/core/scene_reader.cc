// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/scene_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "simulate/core/check.h"
#include "simulate/core/input_file.h"
#include "simulate/core/settings.h"
#include "simulate/core/surroundings_reader.h"
#include "simulate/core/table.h"
#include "simulate/core/text.h"

namespace flocklift {
namespace {

using internal::Limits;
using internal::Settings;

using internal::kFastest;
using internal::kLongest;
constexpr double kLargestBody = 100;     // [m]
constexpr int kMostAnimals = 1'000'000;  // of a species
constexpr int kWidestImage = 16384;      // [px]

template <typename T>
void ReadInteger(Settings* settings, std::string_view key, T* value, std::int64_t low,
                 std::int64_t high) {
  std::int64_t number = 0;
  if (settings->Integer(key, &number, low, high)) *value = static_cast<T>(number);
}

void ReadSceneTable(const toml::table& table, const std::string& name, Scene* scene) {
  Settings settings(table, name, "[scene]");
  ReadInteger(&settings, "version", &scene->version, 1, std::numeric_limits<int>::max());
  if (scene->version != 1) {
    settings.Fail("version", fmt::format("the scene has schema version {}", scene->version),
                  "this program reads version 1");
  }
  ReadInteger(&settings, "seed", &scene->seed, 0, std::numeric_limits<std::int64_t>::max());
  settings.Number("duration", &scene->duration, Limits::Positive(kLongest));
  settings.Fps("fps", &scene->fps);
  ReadInteger(&settings, "substeps", &scene->substeps, 1, 1000);
  ReadInteger(&settings, "dimensions", &scene->dimensions, 2, 3);
  settings.Number("warmup", &scene->warmup, {0, kLongest});
  const bool is_flat = scene->dimensions == 2;
  settings.Corners("box", &scene->box.low, &scene->box.high, is_flat);
  if (is_flat) scene->box.low.z = scene->box.high.z = 0;
  settings.FailUnknown();
  const double frames = scene->duration * scene->fps;
  if (!(frames >= 0.5 && frames <= internal::kMaxFrame)) {
    settings.Fail("duration", fmt::format("duration times fps makes {:.3g} frames", frames),
                  fmt::format("give 1 to {} frames", internal::kMaxFrame));
  }
}

ModelSpec ReadModel(Settings* species) {
  ModelSpec model = SpeciesSpec().model;
  species->Text("model", &model.name);
  model.where = species->Where("model");
  if (const toml::table* parameters = species->FindTable("parameters")) {
    Settings(*parameters, species->name(), "[species.parameters]").AllOthers(&model);
  }
  return model;
}

// `start` is a box, or the name of a shape.
void ReadStart(Settings* settings, bool is_flat, SpeciesSpec* species) {
  if (const toml::node* node = settings->Find("start"); node != nullptr && node->is_string()) {
    settings->Text("start", &species->start_shape);
    return;
  }
  Region start;
  if (settings->Corners("start", &start.low, &start.high, is_flat)) species->start = start;
}

SpeciesSpec ReadSpecies(const toml::table& table, const std::string& name, bool is_flat) {
  Settings settings(table, name, "[[species]]");
  SpeciesSpec species;
  settings.Text("name", &species.name);
  ReadInteger(&settings, "count", &species.count, 1, kMostAnimals);
  settings.Number("wingspan", &species.wingspan, Limits::Positive(kLargestBody));
  settings.Number("wingspan_spread", &species.wingspan_spread, {0, 1});
  settings.Number("body_length", &species.body_length, Limits::Positive(kLargestBody));
  settings.Number("wingbeat_hz", &species.wingbeat_hz, {0, 1000});
  settings.Number("speed", &species.speed, Limits::Positive(kFastest));
  settings.Number("speed_spread", &species.speed_spread, {0, 1});
  ReadStart(&settings, is_flat, &species);
  settings.Text("shape", &species.shape);
  settings.Text("path", &species.path);
  species.model = ReadModel(&settings);
  settings.EachTable("force", [&](const toml::table& force) {
    species.forces.push_back(internal::ReadForce(force, name, "[[species.force]]"));
  });
  settings.FailUnknown();
  return species;
}

void ReadImageSize(Settings* settings, CameraSpec* camera) {
  const toml::array* const size = settings->FindArray("size");
  if (size == nullptr) return;
  const auto pixels = [&](std::size_t k) {
    const toml::node* const node = size->size() == 2 ? size->get(k) : nullptr;
    const std::int64_t value =
        node != nullptr && node->is_integer() ? node->as_integer()->get() : 0;
    if (value < 16 || value > kWidestImage) {
      settings->Fail("size", "size in [camera] is no image size",
                     fmt::format("give [width, height], each from 16 to {} pixels", kWidestImage));
    }
    return static_cast<int>(value);
  };
  camera->width = pixels(0);
  camera->height = pixels(1);
}

CameraSpec::Pose ReadPose(const toml::table& table, const std::string& name,
                          const CameraSpec& camera) {
  Settings settings(table, name, "path in [camera]");
  CameraSpec::Pose pose{.time = 0, .position = camera.position, .look_at = camera.look_at};
  settings.Number("time", &pose.time, {-kLongest, kLongest});
  settings.Vector("position", &pose.position, false);
  settings.Vector("look_at", &pose.look_at, false);
  settings.FailUnknown();
  if (!camera.path.empty() && !(pose.time > camera.path.back().time)) {
    settings.Fail("time", "the poses of the camera are not in the order of time",
                  "give each a later time than the one before");
  }
  if (Norm(pose.look_at - pose.position) < 1e-6) {
    settings.Fail("look_at", "the camera looks at its own position", "give another look_at");
  }
  return pose;
}

CameraSpec ReadCameraSpec(const toml::table& table, const std::string& name) {
  Settings settings(table, name, "[camera]");
  CameraSpec camera;
  std::filesystem::path file;
  if (settings.File("file", &file)) {
    if (table.size() > 1) {
      settings.Fail("file", "[camera] has a file and other keys", "give one or the other");
    }
    camera.file = file;
  }
  settings.Number("fov", &camera.fov_deg, {1, 170});
  ReadImageSize(&settings, &camera);
  settings.Vector("position", &camera.position, false);
  settings.Vector("look_at", &camera.look_at, false);
  settings.EachTable("path", [&](const toml::table& pose) {
    camera.path.push_back(ReadPose(pose, name, camera));
  });
  settings.FailUnknown();
  if (Norm(camera.look_at - camera.position) < 1e-6) {
    settings.Fail("look_at", "the camera looks at its own position", "give another look_at");
  }
  return camera;
}

RenderSpec ReadRender(const toml::table& table, const std::string& name) {
  Settings settings(table, name, "[render]");
  RenderSpec render;
  settings.Text("background", &render.background, {"plain", "sky", "clouds"});
  settings.Number("noise", &render.noise, {0, 255});
  settings.Number("blur", &render.blur, {0, 1});
  settings.Number("haze", &render.haze, {0, 1e6});
  settings.Number("cloud_speed", &render.cloud_speed_px, {-1000, 1000});
  settings.Flag("obstacles", &render.obstacles);
  settings.Flag("goals", &render.goals);
  settings.Flag("paths", &render.paths);
  settings.Flag("ground", &render.ground);
  settings.FailUnknown();
  return render;
}

}  // namespace

Scene ParseScene(std::string_view text, const std::string& name) {
  const toml::table file = internal::ParseToml(text, name);
  Settings settings(file, name, "the scene");
  Scene scene;
  if (const toml::table* table = settings.FindTable("scene")) {
    ReadSceneTable(*table, name, &scene);
  }
  const bool is_flat = scene.dimensions == 2;
  settings.EachTable("species", [&](const toml::table& table) {
    SpeciesSpec species = ReadSpecies(table, name, is_flat);
    const bool repeats = std::any_of(scene.species.begin(), scene.species.end(),
                                     [&](const SpeciesSpec& s) { return s.name == species.name; });
    if (repeats) {
      internal::FailAt(table, name, fmt::format("two species are called {}", Quoted(species.name)),
                       "give each [[species]] a name of its own");
    }
    scene.species.push_back(std::move(species));
  });
  internal::ReadSurroundings(&settings, &scene);
  if (const toml::table* table = settings.FindTable("camera")) {
    scene.camera = ReadCameraSpec(*table, name);
  }
  if (const toml::table* table = settings.FindTable("render"))
    scene.render = ReadRender(*table, name);
  settings.FailUnknown();
  if (scene.species.empty()) {
    throw InputError(name, 0, "the scene has no animals", "add a table [[species]]");
  }
  internal::CheckNamesOfSurroundings(name, scene);
  return scene;
}

Scene ReadScene(const std::filesystem::path& path) {
  return ParseScene(ReadTextFile(path), path.string());
}

}  // namespace flocklift
