// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the detector that looks at pixels without making blobs of them, and what it keeps
// between frames.

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "track/detect/detector.h"
#include "track/detect/gray_view.h"

namespace flocklift {

std::vector<float> Detector::ContrastOf(const GrayImage& image) {
  std::vector<float> contrast(image.pixels.size(), 0);
  Scratch& scratch = scratch_.front();
  for (const bool dark : {true, false}) {
    if (!(dark ? dark_ : bright_)) continue;
    const LocalBackground background = MarkCandidates(image, dark, &scratch);
    const LevelTable level(background, image.width, image.height);
    for (int v = 0; v < image.height; ++v) {
      const std::uint8_t *row = image.Row(v), *mark = scratch.mask.Row(v);
      float* out = contrast.data() + static_cast<std::size_t>(v) * image.width;
      for (int u = 0; u < image.width; ++u) {
        if (mark[u] > 0) out[u] = std::abs(level.At(u, v) - static_cast<float>(row[u]));
      }
    }
  }
  return contrast;
}

void Detector::LookForStill(const GrayImage& image, StillLooks* looks) {
  Scratch& scratch = scratch_.front();
  const LocalBackground background = MarkCandidates(image, dark_, &scratch);
  looks->Add(dark_, scratch.smooth, background, scratch.mask);
}

void Detector::TakeOut(StillPicture still) {
  still_ = std::move(still);
  recent_.clear();
  usual_length_ = usual_contrast_ = 0;
  frames_since_summary_ = 0;
}

// Whether what stands still is still there.
void Detector::FollowStill(const GrayImage& image) {
  if (still_.empty()) return;
  Scratch& scratch = scratch_.front();
  still_.TakeOut(dark_, image, &scratch.cleaned);
  const LocalBackground background = MarkCandidates(scratch.cleaned, dark_, &scratch);
  cv::Mat smooth = View(scratch.smooth);
  cv::GaussianBlur(View(image), smooth, cv::Size(3, 3), 0);
  still_.Follow(dark_, scratch.smooth, background, kSummaryInterval);
}

void Detector::Save(StateWriter* state) const {
  state->Put(dark_);
  state->Put(bright_);
  state->Put(usual_length_);
  state->Put(usual_contrast_);
  state->Put(frames_since_summary_);
  state->Put(static_cast<std::uint64_t>(recent_.size()));
  for (const Trace& trace : recent_) state->Put(trace);
  still_.Save(state);
}

void Detector::Load(StateReader* state) {
  state->Take(&dark_);
  state->Take(&bright_);
  state->Take(&usual_length_);
  state->Take(&usual_contrast_);
  state->Take(&frames_since_summary_);
  std::uint64_t count = 0;
  state->Take(&count);
  recent_.resize(count);
  for (Trace& trace : recent_) state->Take(&trace);
  still_.Load(state);
}

}  // namespace flocklift
