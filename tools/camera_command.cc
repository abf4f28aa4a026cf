// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/camera_command.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "simulate/camera/camera.h"
#include "simulate/camera/camera_io.h"
#include "simulate/camera/depth_sensitivity.h"
#include "simulate/core/check.h"
#include "tools/size_text.h"
#include "tools/stage.h"

namespace flocklift {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Rigid3d PoseOf(const CameraCommand& command) {
  if (command.position.empty()) {
    Check(std::isfinite(command.pitch_deg) && std::isfinite(command.height),
          "--pitch and --height must be finite numbers");
    const double pitch = command.pitch_deg * kDegree;
    const Vec3d position{0, 0, command.height};
    return LookAt(position, position + Vec3d{0, std::cos(pitch), std::sin(pitch)});
  }
  const Vec3d position = ParsePoint(command.position, "--position");
  const Vec3d target = ParsePoint(command.look_at, "--look-at");
  Check(Norm(target - position) > 1e-9, "--position and --look-at are the same point");
  return LookAt(position, target);
}

}  // namespace

void RunCamera(const CameraCommand& command, const CommonOptions& common) {
  Stage stage("camera", common);
  stage.options() = {{"fov", command.fov_deg},       {"size", command.size},
                     {"pitch", command.pitch_deg},   {"height", command.height},
                     {"position", command.position}, {"look-at", command.look_at}};
  if (common.fps) stage.options()["fps"] = *common.fps;
  stage.AddOutput("camera.yaml");
  if (stage.IsUpToDate()) return;

  stage.BeginPhase("write", "files");
  const auto [width, height] = ParseSize(command.size, "--size");
  Camera camera = PinholeCamera(command.fov_deg, width, height);
  camera.fps = common.fps;
  camera.cam_from_world = PoseOf(command);
  WriteCamera(common.out / "camera.yaml", camera);

  const double focal = camera.intrinsics.fx;
  stage.figures() = {
      {"focal_px", focal},
      {"vertical_fov_deg", 2 * std::atan(0.5 * height / focal) / kDegree},
      // A known wingspan gives depth in proportion to the focal length (depth_sensitivity.h).
      {"depth_error_percent_per_degree_of_fov",
       100 * std::abs(FocalErrorFromFov(command.fov_deg, 1))}};
  stage.Finish();
}

void AddCameraCommand(CLI::App& app) {
  std::shared_ptr<CameraCommand> command;
  CLI::App* sub = AddSubcommand<CameraCommand>(
      app, "camera", "Write a camera file for footage whose lens is roughly known",
      "Examples:\n"
      "  flocklift camera --fov 50 --size 1280x720 --out run\n"
      "  flocklift camera --fov 65 --size 1920x1080 --pitch 20 --height 1.5 --fps 30000/1001\n"
      "  flocklift camera --fov 40 --size 3840x2160 --position 0,-45,1.7 --look-at 0,0,12",
      {.fps = true}, &RunCamera, &command);
  sub->add_option("--fov", command->fov_deg, "horizontal field of view, over the full width [deg]")
      ->required()
      ->check(CLI::Range(0.1, 175.0));
  sub->add_option("--size", command->size, "image size WxH [px]")->required();
  const std::string group = "Pose (level, at 1.7 m, looking along +y, when not given)";
  auto* pitch = sub->add_option("--pitch", command->pitch_deg,
                                "optical axis above the horizon, without roll [deg]")
                    ->check(CLI::Range(-90.0, 90.0))
                    ->capture_default_str()
                    ->group(group);
  auto* height = sub->add_option("--height", command->height, "of the camera above z = 0 [m]")
                     ->check(CLI::Range(-1e6, 1e6))
                     ->capture_default_str()
                     ->group(group);
  auto* position = sub->add_option("--position", command->position, "X,Y,Z of the camera, z up [m]")
                       ->excludes(pitch)
                       ->excludes(height)
                       ->group(group);
  auto* look_at = sub->add_option("--look-at", command->look_at,
                                  "X,Y,Z of a point in the middle of the image [m]")
                      ->needs(position)
                      ->group(group);
  position->needs(look_at);
}

}  // namespace flocklift
