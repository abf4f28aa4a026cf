// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/scene_view.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/scene_io.h"
#include "simulate/flock/model.h"
#include "simulate/shapes/spline_path.h"
#include "tools/scene_camera.h"
#include "tools/view/camera_json.h"
#include "tools/view/event_bus.h"
#include "tools/view/folder_path.h"
#include "tools/view/live_scene.h"
#include "tools/view/page_routes.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostTriangles = 20000;  // of an obstacle; larger ones are drawn as boxes
constexpr int kPiecesOfPath = 64;

Json AsJson(const Vec3d& v) { return Json::array({v.x, v.y, v.z}); }

Vec3d PointOf(const Json& json) {
  Check(json.is_array() && json.size() == 3, "a place has three numbers");
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json AsJson(const TriangleMesh& mesh) {
  Json json = {{"vertices", Json::array()}, {"triangles", Json::array()}};
  if (mesh.triangles.size() > kMostTriangles) return json;
  for (const Vec3d& v : mesh.vertices) {
    for (const double x : {v.x, v.y, v.z}) json["vertices"].push_back(x);
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) json["triangles"].push_back(corner);
  }
  return json;
}

Json AsJson(const SpeciesSpec& species) {
  const ModelInfo* model = FindModel(species.model.name);
  Check(model != nullptr, "there is no model " + species.model.name);
  const ModelSpec complete = CompleteModel(species.model);
  Json parameters = Json::array();
  const auto end = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  for (const ParameterInfo& p : model->parameters) {
    double value = p.value;
    if (p.choices.empty()) {
      value = complete.parameters.at(p.name);
    } else {
      const auto word = std::find(p.choices.begin(), p.choices.end(), complete.choices.at(p.name));
      value = static_cast<double>(word - p.choices.begin());
    }
    parameters.push_back({{"name", p.name},
                          {"value", value},
                          {"low", end(p.range.low)},
                          {"high", end(p.range.high)},
                          {"unit", p.unit},
                          {"help", p.help},
                          {"choices", p.choices}});
  }
  return {{"name", species.name},   {"model", species.model.name},  {"help", model->help},
          {"count", species.count}, {"wingspan", species.wingspan}, {"parameters", parameters}};
}

// A line of points along the curve.
Json AsJson(const PathSpec& path) {
  const SplinePath curve(path.points, /*closed=*/false);
  Json line = Json::array();
  for (int k = 0; k <= kPiecesOfPath; ++k) {
    line.push_back(AsJson(curve.Position(curve.length() * k / kPiecesOfPath)));
  }
  return line;
}

}  // namespace

class SceneView::Impl {
 public:
  Impl(const fs::path& path, const fs::path& out, int threads)
      : name_(path.stem().string()), out_(out), scene_(ReadScene(path)), live_(scene_, threads) {}

  void Serve(HttpServer* server) {
    ServePage(server, &bus_, [this] { return Json{{"session", Session()}}; });
    server->Get("/api/session", [this](const HttpRequest&) { return JsonReply(Session()); });
    server->Stream("/api/live", "application/octet-stream", [this](const HttpRequest&) {
      auto seen = std::make_shared<std::uint64_t>(0);
      return [this, seen](const HttpServer::Sink& write) {
        const auto look = live_.Look(seen.get());
        return look == nullptr || write(*look);
      };
    });
    server->Post("/api/steer", [this](const HttpRequest& r) {
      Steer(BodyOf(r));
      return JsonReply(Json::object());
    });
    server->Post("/api/save", [this](const HttpRequest& r) { return Save(BodyOf(r)); });
  }

 private:
  Json Session() {
    const Scene now = live_.Current();
    Json json = {{"kind", "scene"},
                 {"name", name_},
                 {"dt", 1 / (now.fps * now.substeps)},
                 {"fps", now.fps},
                 {"dimensions", now.dimensions},
                 {"bounds", {{"low", AsJson(now.box.low)}, {"high", AsJson(now.box.high)}}},
                 {"wind", AsJson(now.wind.velocity)}};
    json["species"] = Json::array();
    for (const SpeciesSpec& species : now.species) json["species"].push_back(AsJson(species));
    json["goals"] = Json::array();
    for (const GoalSpec& goal : now.goals) {
      json["goals"].push_back({{"species", goal.species}, {"reach", goal.reach}});
    }
    json["paths"] = Json::array();
    for (const PathSpec& path : now.paths) json["paths"].push_back(AsJson(path));
    int predators = 0;
    for (const PredatorSpec& spec : now.predators) predators += spec.count;
    json["predators"] = predators;
    json["obstacles"] = Json::array();
    for (const Obstacle& obstacle : live_.population().world.obstacles) {
      json["obstacles"].push_back(AsJson(obstacle.mesh));
    }
    json["camera"] = CameraAsJson(SceneCamera(now));
    return json;
  }

  void Steer(const Json& body) {
    const std::string what = body.at("do").get<std::string>();
    const auto index = [&] {
      const int k = body.at("index").get<int>();
      Check(k >= 0, "things count from 0");
      return static_cast<std::size_t>(k);
    };
    const double weight = body.value("weight", 1.0);
    if (what == "pause" || what == "resume") return live_.Pause(what == "pause");
    if (what == "step") return live_.StepOnce();
    if (what == "reset") return live_.Reset();
    if (what == "pace") return live_.SetPace(body.at("value").get<double>());
    if (what == "goal") return live_.MoveGoal(index(), PointOf(body.at("position")));
    if (what == "predator") return live_.MovePredator(index(), PointOf(body.at("position")));
    if (what == "wind") return live_.SetWind(PointOf(body.at("velocity")));
    if (what == "attract") return live_.Attract(PointOf(body.at("position")), weight);
    if (what == "release") return live_.Attract({}, weight);
    if (what == "lead" || what == "guide") {
      std::vector<Vec3d> line;
      for (const Json& point : body.at("points")) line.push_back(PointOf(point));
      if (what == "guide") return live_.Guide(line);
      return live_.Lead(line, body.at("seconds").get<double>(), weight);
    }
    Check(what == "parameter", "there is nothing to do called " + what);
    ModelSpec change;
    change.where = "the slider";
    const std::string name = body.at("name").get<std::string>();
    if (body.at("value").is_string()) {
      change.choices[name] = body.at("value").get<std::string>();
    } else {
      change.parameters[name] = body.at("value").get<double>();
    }
    live_.SetParameter(body.at("species").get<std::string>(), change);
  }

  HttpReply Save(const Json& body) {
    const std::string name = body.at("name").get<std::string>();
    Check(IsPlainFileName(name, ".toml"),
          "the name must be letters, digits, - and _, and end in .toml");
    fs::create_directories(out_);
    const auto path = PathInFolder(out_, name);
    Check(path.has_value(), "the scene cannot be saved under this name");
    WriteScene(*path, live_.Current());
    return JsonReply({{"file", path->string()}});
  }

  std::string name_;
  fs::path out_;
  Scene scene_;
  EventBus bus_;
  LiveScene live_;
};

SceneView::SceneView(const fs::path& scene, const fs::path& out, int threads)
    : impl_(std::make_unique<Impl>(scene, out, threads)) {}
SceneView::~SceneView() = default;
void SceneView::Serve(HttpServer* server) { impl_->Serve(server); }

}  // namespace flocklift
