// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A scene, live: what the page asks for to show and steer it.
//   GET  /api/session   the scene as JSON: species with their parameters, goals, obstacles, camera
//   GET  /api/live      looks without end (scene_look.h)
//   POST /api/steer     {"do": "pause", "resume", "step", "reset", "pace", "parameter", "goal",
//                        "predator", "wind", "attract", "release" or "lead", ..}
//   POST /api/save      {"name": "x.toml"}: the scene as steered, into the folder for scenes

#ifndef FLOCKLIFT_TOOLS_VIEW_SCENE_VIEW_H_
#define FLOCKLIFT_TOOLS_VIEW_SCENE_VIEW_H_

#include <filesystem>
#include <memory>

#include "tools/view/http_server.h"

namespace flocklift {

class SceneView {
 public:
  // Reads and starts the scene; scenes are saved into `out`.
  SceneView(const std::filesystem::path& scene, const std::filesystem::path& out, int threads);
  ~SceneView();

  // Adds the routes; the view must outlive the server's Run.
  void Serve(HttpServer* server);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_SCENE_VIEW_H_
