// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/finder.h"

#include <utility>

#include "track/stopwatch.h"
#include "track/video_source.h"

namespace flocklift::internal {
namespace {

constexpr std::size_t kLearnStride = 2;  // of the images to learn from, every second one
constexpr std::size_t kLookStride = 3;   // frames between two looks at what stands still
constexpr int kSaveStride = 50;          // frames at least from one that can be gone on from to
                                         // the next

}  // namespace

void Finder::Learn(const std::vector<GrayImage>& images) {
  std::vector<GrayImage> some;
  for (std::size_t k = 0; k < images.size(); k += kLearnStride) some.push_back(images[k]);
  Timed(&timings_->detect_s, [&] { detector.Learn(some, &pool_); });
}

std::vector<Found> Finder::Find(std::span<const GrayImage> images) {
  std::vector<BlobFrame> blobs =
      Timed(&timings_->detect_s, [&] { return detector.DetectAll(frame_ + 1, images, &pool_); });
  std::vector<Found> all;
  for (std::size_t k = 0; k < images.size(); ++k) {
    ++frame_;
    blobs[k].world_from_image =
        Timed(&timings_->camera_s, [&] { return camera_.Next(images[k], blobs[k]); });
    all.push_back({std::move(blobs[k]), {}});
  }
  if (is_saved_ && frame_ - saved_frame_ >= kSaveStride) all.back().state = Save();
  return all;
}

// As a new finder would that was given the beginning of the footage: how far this one is decides
// nothing.
void Finder::Restart(const std::filesystem::path& footage) {
  detector = Detector(options_.detect);
  camera_ = CameraMotion(options_.camera);
  frame_ = saved_frame_ = 0;
  VideoSource start(footage);
  std::vector<GrayImage> first;
  for (GrayImage image; first.size() < kLearnImages && start.Read(&image);) first.push_back(image);
  Learn(first);
  StillLooks looks;
  GrayImage image;
  for (std::size_t k = 0; k < StillLooks::kCount * kLookStride; ++k) {
    if (k >= first.size() && !start.Read(&image)) break;
    if (k % kLookStride != 0) continue;
    Timed(&timings_->detect_s,
          [&] { detector.LookForStill(k < first.size() ? first[k] : image, &looks); });
  }
  detector.TakeOut(looks.Learn());
}

void Finder::Load(StateReader* state) {
  state->Take(&frame_);
  saved_frame_ = frame_;
  detector.Load(state);
  camera_.Load(state);
}

std::string Finder::Save() {
  saved_frame_ = frame_;
  StateWriter state;
  state.Put(frame_);
  detector.Save(&state);
  camera_.Save(&state);
  return state.bytes();
}

}  // namespace flocklift::internal
