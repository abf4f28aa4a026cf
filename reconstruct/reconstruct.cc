// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "reconstruct/initialize/observability.h"
#include "reconstruct/initialize/reference_axes.h"
#include "reconstruct/initialize/scale_guess.h"
#include "reconstruct/orientation.h"
#include "reconstruct/report_text.h"
#include "simulate/core/check.h"
#include "simulate/core/options.h"

namespace flocklift {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

// The user's knowledge in the reference axes.
Knowledge InReferenceAxes(const ReconstructOptions& options, const Camera& camera,
                          const ReferenceAxes& axes) {
  Knowledge knowledge = options.knowledge;
  knowledge.second_camera = options.second_camera.has_value();
  for (Anchor& anchor : knowledge.anchors) {
    anchor.position = axes.RefFromWorld(anchor.frame) * anchor.position;
    Check(anchor.position.z > 0, "the anchor of id " + std::to_string(anchor.id) + " in frame " +
                                     std::to_string(anchor.frame) + " lies behind the camera");
  }
  if (camera.KnowsGravity()) {
    knowledge.up_in_cam = axes.ref_from_world() * Vec3d{0, 0, 1};
  } else if (options.pitch_deg) {
    const double pitch = *options.pitch_deg * kDegree;
    knowledge.up_in_cam = Vec3d{0, -std::cos(pitch), std::sin(pitch)};
  }
  return knowledge;
}

CobylaOptions CobylaFor(const ReconstructOptions& options, const Knowledge& knowledge,
                        const Segments& segments) {
  CobylaOptions cobyla = options.cobyla;
  const ScaleGuess guess = GuessScale(knowledge, segments);
  if (cobyla.lambda_speed <= 0) cobyla.lambda_speed = std::exp(guess.log_speed);
  constexpr double kNearest = 1e-3, kFarthest = 1e6;  // [m]
  if (cobyla.near <= 0) {
    cobyla.near = std::clamp(std::exp(guess.log_near), kNearest, 0.5 * kFarthest);
  }
  if (cobyla.far <= 0) {
    cobyla.far = std::clamp(std::exp(guess.log_far), 2 * kNearest, kFarthest);
  }
  return cobyla;
}

double MedianRelativeSd(const std::vector<SolvedPath>& paths, double scale_sd) {
  std::vector<double> sds;
  for (const SolvedPath& path : paths) {
    for (const SolvedPoint& p : path) {
      sds.push_back(
          std::sqrt(std::max(0.0, p.sd_log_depth * p.sd_log_depth - scale_sd * scale_sd)));
    }
  }
  if (sds.empty()) return 0;
  const auto middle = sds.begin() + static_cast<std::ptrdiff_t>(sds.size() / 2);
  std::nth_element(sds.begin(), middle, sds.end());
  return *middle;
}

Trajectories Assemble(const ReferenceAxes& axes, const Knowledge& knowledge,
                      const Segments& segments, const std::vector<SolvedPath>& paths, double fps,
                      bool has_sd) {
  const Vec3d up = knowledge.up_in_cam.value_or(Vec3d{0, -1, 0});
  std::map<Id, Trajectory> by_id;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Segment& segment = segments.segments[i];
    Trajectory& trajectory = by_id[segment.id];
    trajectory.id = segment.id;
    for (std::size_t k = 0; k < paths[i].size(); ++k) {
      const SolvedPoint& p = paths[i][k];
      TrajectoryPoint point;
      point.frame = segment.sightings[k].frame;
      const Rigid3d world_from_ref = axes.WorldFromRef(point.frame);
      point.position = world_from_ref * p.position_in_cam;
      point.velocity = world_from_ref.rotation * p.velocity_in_cam;
      const Rotation3d cam_from_body =
          WorldFromFlyingBody(p.velocity_in_cam, p.acceleration_in_cam, up);
      const Vec3d forward = world_from_ref.rotation * (cam_from_body * Vec3d{1, 0, 0});
      const Vec3d left = world_from_ref.rotation * (cam_from_body * Vec3d{0, 1, 0});
      const Vec3d body_up = world_from_ref.rotation * (cam_from_body * Vec3d{0, 0, 1});
      point.world_from_body =
          QuaternionFromRotation(Rotation3d::FromRows(forward, left, body_up).Inverse());
      point.sd_depth = p.sd_log_depth * axes.DepthInCam(point.frame, p.position_in_cam);
      trajectory.points.push_back(point);
    }
  }
  Trajectories result;
  result.fps = fps;
  result.has_velocity = result.has_orientation = true;
  result.has_sd_depth = has_sd;
  for (auto& [id, trajectory] : by_id) result.trajectories.push_back(std::move(trajectory));
  return result;
}

bool IsBatch(const ReconstructOptions& options) {
  return options.method == ReconstructMethod::kBatch ||
         options.method == ReconstructMethod::kDynamics;
}

SegmentOptions SegmentOptionsOf(const ReconstructOptions& options, const Knowledge& knowledge) {
  return {.min_pixel_sd = options.batch.pixel_sd,
          .jump = IsBatch(options) ? options.batch.jump : 0,
          .use_size = knowledge.use_size};
}

std::string OutlookOf(const ReconstructOptions& options, const Segments& segments,
                      const Knowledge& knowledge) {
  Observability observability = LookAhead(segments);
  observability.erratic &= IsBatch(options) && options.batch.erratic_flight;
  return Describe(observability, knowledge);
}

}  // namespace

const char* NameOf(ReconstructMethod method) {
  switch (method) {
    case ReconstructMethod::kBatch:
      return "batch";
    case ReconstructMethod::kDynamics:
      return "dynamics";
    case ReconstructMethod::kCobyla:
      return "cobyla";
    case ReconstructMethod::kLinCeres:
      return "lin-ceres";
  }
  return "";
}

ReconstructMethod MethodOf(const std::string& name) {
  for (const ReconstructMethod method :
       {ReconstructMethod::kBatch, ReconstructMethod::kDynamics, ReconstructMethod::kCobyla,
        ReconstructMethod::kLinCeres}) {
    if (name == NameOf(method)) return method;
  }
  throw std::invalid_argument("there is no method `" + name + "`");
}

std::string LookAhead(const ReconstructOptions& options, const Tracks& tracks, const Camera& camera,
                      double fps) {
  const FrameSpan span = SpanOf(tracks);
  const Knowledge knowledge =
      InReferenceAxes(options, camera, ReferenceAxes(camera, span.first, span.last));
  const Segments segments = MakeSegments(SegmentOptionsOf(options, knowledge), tracks, camera, fps);
  return OutlookOf(options, segments, knowledge);
}

ReconstructResult Reconstruct(const ReconstructOptions& options, const Tracks& tracks,
                              const Camera& camera, double fps, int threads,
                              const Progress& progress) {
  CheckOptions(options.batch);
  const FrameSpan span = SpanOf(tracks);
  const ReferenceAxes axes(camera, span.first, span.last);
  const Knowledge knowledge = InReferenceAxes(options, camera, axes);
  CheckKnowledge(knowledge);
  const bool is_batch = IsBatch(options);
  const SegmentOptions segment_options = SegmentOptionsOf(options, knowledge);
  Segments segments = MakeSegments(segment_options, tracks, camera, fps);
  ReconstructResult result;
  ReconstructReport& report = result.report;
  if (options.second_camera) {
    Check(is_batch, "a second camera needs the method batch or dynamics");
    report.second_camera =
        AttachViews(*options.second_camera, segment_options, axes, span.first, fps, &segments);
    internal::WarnOfSecondCamera(*report.second_camera, &report.warnings);
    Check(report.second_camera->views > 0 || FixesScale(options.knowledge),
          "no track of the second camera shows an animal of the first, and nothing else fixes the "
          "scale; check both poses and the clocks, or give --speed or --wingspan");
  }
  report.method = options.method;
  report.segments = static_cast<int>(segments.segments.size());
  report.cuts = segments.cuts;
  report.pixel_sd = segments.pixel_sd;
  report.scale_from = ScaleSources(knowledge);
  report.outlook = OutlookOf(options, segments, knowledge);
  if (segments.unusable > 0) {
    report.warnings.push_back(std::to_string(segments.unusable) +
                              " rows lie where the lens model sees nothing and were left out");
  }
  if (segments.segments.empty()) {
    report.warnings.push_back("there is no track to reconstruct");
    return result;
  }
  if (!is_batch) {
    const CobylaResult cobyla =
        SolveCobyla(CobylaFor(options, knowledge, segments), options.cobyla_first_depths, segments,
                    fps, progress,
                    options.method == ReconstructMethod::kCobyla ? LinOptimizer::kCobyla
                                                                 : LinOptimizer::kCeres);
    report.final_cost = cobyla.report.final_cost;
    report.iterations = cobyla.report.frames;
    report.converged = cobyla.report.exhausted == 0;
    if (!report.converged) {
      report.warnings.push_back("in " + std::to_string(cobyla.report.exhausted) + " of " +
                                std::to_string(cobyla.report.frames) +
                                " frames the optimiser stopped before it was done");
    }
    report.observability =
        "relative depth rests on constant speed and on the pull of the flock's middle; the method "
        "knows no error of its depths";
    result.trajectories = Assemble(axes, knowledge, segments, cobyla.paths, fps, false);
    return result;
  }
  BatchResult batch;
  if (options.method == ReconstructMethod::kDynamics) {
    batch = SolveDynamics(options.dynamics, options.batch, knowledge, segments, fps, threads,
                          progress, options.checkpoint);
    report.dynamics = batch.report.dynamics;
  } else {
    batch =
        SolveBatch(options.batch, knowledge, segments, fps, threads, progress, options.checkpoint);
  }
  report.initial_cost = batch.report.initial_cost;
  report.final_cost = batch.report.final_cost;
  report.iterations = batch.report.iterations;
  report.converged = batch.report.converged;
  report.erratic = batch.report.erratic;
  report.scale_sd = batch.report.scale_sd;
  report.relative_sd = MedianRelativeSd(batch.paths, report.scale_sd);
  report.terms = batch.report.terms;
  report.spreads = batch.report.spreads;
  if (!report.converged) {
    report.warnings.push_back("the solver stopped before the cost stood still");
  }
  if (knowledge.speed && knowledge.wingspan && knowledge.use_size) {
    report.speed_by_sizes = batch.report.speed_against_size;
    internal::WarnOfDisagreement(*report.speed_by_sizes, &report.warnings);
  }
  report.observability = internal::DescribeSolution(knowledge, segments, batch, report);
  result.trajectories = Assemble(axes, knowledge, segments, batch.paths, fps, true);
  return result;
}

}  // namespace flocklift
