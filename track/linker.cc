// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/linker.h"

#include <utility>

#include "track/associate/uncross.h"
#include "track/finish.h"
#include "track/stopwatch.h"

namespace flocklift::internal {
namespace {

constexpr std::size_t kLearnBlobFrames = 90;  // for the motion noise
constexpr int kLeastPath = 8;                 // frames of a path that teaches motion
constexpr int kRelearnInterval = 100;         // frames

}  // namespace

void Linker::Add(BlobFrame frame) {
  if (has_declined()) return;
  camera_.Add(frame.frame, frame.world_from_image);
  Stabilise(&frame);
  if (tracker_) {
    clutter_.Drop(&frame);
    Step(frame);
    return;
  }
  first_.push_back(std::move(frame));
  if (first_.size() == kLearnBlobFrames) Start();
}

void Linker::Start() {
  if (options_.min_travel > 0) clutter_.Learn(first_);
  for (BlobFrame& frame : first_) clutter_.Drop(&frame);
  separability_ = MeasureSeparability(first_);
  separability_.is_enough = separability_.is_enough || !options_.decline;
  if (has_declined()) {
    first_.clear();
    return;
  }
  const std::vector<Path> paths = UnmistakablePaths(first_, kLeastPath);
  noise_ = EstimateMotionNoise(paths, MotionNoise{});
  model_ = EstimateMotionModel(paths, noise_);
  tracker_.emplace(options_.associate, model_, width_, height_);
  for (const BlobFrame& frame : first_) Step(frame);
  first_.clear();
}

void Linker::Step(const BlobFrame& frame) {
  tracker_->Step(frame);
  if (++steps_ % kRelearnInterval != 0) return;
  const std::vector<Path> paths = tracker_->RecentPaths(kLeastPath);
  noise_ = EstimateMotionNoise(paths, noise_);
  model_ = EstimateMotionModel(paths, noise_);
  tracker_->SetNoise(model_);
}

void Linker::Save(StateWriter* state, StateWriter* log) {
  state->Put(noise_);
  state->Put(model_);
  clutter_.Save(state);
  state->Put(separability_);
  state->Put(steps_);
  camera_.Save(state);
  tracker_->Save(state, log);
}

void Linker::Load(StateReader* state, std::string_view log) {
  state->Take(&noise_);
  state->Take(&model_);
  clutter_.Load(state);
  state->Take(&separability_);
  state->Take(&steps_);
  camera_.Load(state);
  tracker_.emplace(options_.associate, model_, width_, height_);
  tracker_->Load(state, log);
}

TrackerResult Linker::Finish(std::optional<double> fps, TrackerReport report) {
  double seconds = 0;
  TrackerResult result = Timed(&seconds, [&] {
    if (!tracker_ && !has_declined()) Start();
    report.separability = separability_;
    report.camera_moves = !camera_.rests();
    report.correlation = model_.correlation;
    report.clutter = static_cast<std::int64_t>(clutter_.learned());
    return JoinAndFinish(options_, noise_, fps, width_, height_, camera_,
                         tracker_ ? tracker_->Finish() : std::vector<TrackRecord>{},
                         std::move(report));
  });
  result.report.timings.finish_s = seconds;
  return result;
}

TrackerResult JoinAndFinish(const TrackerOptions& options, const MotionNoise& noise,
                            std::optional<double> fps, double width, double height,
                            const CameraPath& camera, std::vector<TrackRecord> records,
                            TrackerReport report) {
  TrackerResult result;
  result.report = std::move(report);
  result.report.noise = noise;
  result.report.exchanges = Uncross(noise, &records);
  int joins = 0;
  records = Stitch(options.stitch, noise, width, height, std::move(records), &joins);
  result.report.joins = joins;
  result.tracks =
      FinishTracks(options, noise, fps, width, height, camera, std::move(records), &result.report);
  return result;
}

}  // namespace flocklift::internal
