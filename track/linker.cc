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
  asks_ = may_ask_ && clutter_.learned() > 0 && camera_.rests();
  if (asks_) return;
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
  tracker_.emplace(options_.associate, model_, width_, height_, file_);
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

void Linker::Save(StateWriter* state) const {
  state->Put(noise_);
  state->Put(model_);
  clutter_.Save(state);
  state->Put(separability_);
  state->Put(steps_);
  camera_.Save(state);
  tracker_->Save(state);
}

void Linker::Load(StateReader* state) {
  state->Take(&noise_);
  state->Take(&model_);
  clutter_.Load(state);
  state->Take(&separability_);
  state->Take(&steps_);
  camera_.Load(state);
  tracker_.emplace(options_.associate, model_, width_, height_, file_);
  tracker_->Load(state);
}

void Linker::Finish(const TakeTracklet& take, TrackerReport* report) {
  Timed(&report->timings.finish_s, [&] {
    may_ask_ = false;  // it is too late
    if (!tracker_ && !has_declined()) Start();
    report->separability = separability_;
    report->camera_moves = !camera_.rests();
    report->correlation = model_.correlation;
    report->clutter += clutter();
    JoinAndFinish(options_, noise_, width_, height_, camera_,
                  tracker_ ? tracker_->Finish() : std::vector<TrackRecord>{}, take, report);
  });
}

void JoinAndFinish(const TrackerOptions& options, const MotionNoise& noise, double width,
                   double height, const CameraPath& camera, std::vector<TrackRecord> records,
                   const TakeTracklet& take, TrackerReport* report) {
  report->noise = noise;
  report->exchanges = Uncross(noise, &records);
  int joins = 0;
  records = Stitch(options.stitch, noise, width, height, std::move(records), &joins);
  report->joins = joins;
  FinishTracks(options, noise, width, height, camera, std::move(records), take, report);
}

TrackerResult Gather(TrackerReport report,
                     const std::function<void(const TakeTracklet&, TrackerReport*)>& finish) {
  TrackerResult result;
  result.report = std::move(report);
  finish([&result](Tracklet t) { result.tracks.tracklets.push_back(std::move(t)); },
         &result.report);
  result.tracks.fps = result.report.fps;
  return result;
}

}  // namespace flocklift::internal
