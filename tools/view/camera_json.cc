// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/camera_json.h"

namespace flocklift {

nlohmann::ordered_json CameraAsJson(const Camera& camera) {
  using Json = nlohmann::ordered_json;
  const auto append = [](const Rigid3d& pose, Json* list) {
    const auto& m = pose.rotation.m;
    const Vec3d& t = pose.translation;
    for (const double x : {m[0], m[1], m[2], t.x, m[3], m[4], m[5], t.y, m[6], m[7], m[8], t.z}) {
      list->push_back(x);
    }
  };
  const Intrinsics& k = camera.intrinsics;
  Json json = {{"width", camera.width},
               {"height", camera.height},
               {"fx", k.fx},
               {"fy", k.fy},
               {"cx", k.cx},
               {"cy", k.cy},
               {"gravity", camera.KnowsGravity()}};
  json["pose"] = nullptr;
  if (camera.cam_from_world) {
    json["pose"] = Json::array();
    append(*camera.cam_from_world, &json["pose"]);
  }
  json["poses"] = Json::array();
  for (const Rigid3d& pose : camera.cam_from_world_per_frame) append(pose, &json["poses"]);
  return json;
}

}  // namespace flocklift
