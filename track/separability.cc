// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/separability.h"

#include <fmt/format.h>

#include <vector>

#include "track/predict/motion_noise.h"

namespace flocklift {
namespace {

constexpr int kPathFrames = 8;
constexpr std::size_t kLeastFrames = 24;
constexpr double kLeastCrowd = 150;  // animals a frame: fewer are never declined
constexpr double kMostSpecksOverBlobs = 2;

}  // namespace

Separability MeasureSeparability(std::span<const BlobFrame> frames) {
  Separability s;
  if (frames.empty()) return s;
  double blobs = 0, specks = 0, on_paths = 0;
  for (const BlobFrame& frame : frames) {
    blobs += static_cast<double>(frame.blobs.size());
    specks += frame.specks;
  }
  for (const Path& path : UnmistakablePaths(frames, kPathFrames)) {
    on_paths += static_cast<double>(path.positions.size());
  }
  const double count = static_cast<double>(frames.size());
  s.blobs_per_frame = blobs / count;
  s.specks_per_frame = specks / count;
  s.share = blobs > 0 ? on_paths / blobs : 1;
  const bool is_judged =
      frames.size() >= kLeastFrames && s.blobs_per_frame + s.specks_per_frame >= kLeastCrowd;
  const bool are_specks = s.specks_per_frame > kMostSpecksOverBlobs * s.blobs_per_frame;
  s.is_enough = !is_judged || (!are_specks && s.share >= kLeastSeparable);
  return s;
}

std::string WhyDeclined(const Separability& s) {
  if (s.specks_per_frame > kMostSpecksOverBlobs * s.blobs_per_frame) {
    return fmt::format(
        "the animals are too small to be told apart: {:.0f} of {:.0f} sightings a frame are a "
        "pixel or two; density and flow are given instead of identities",
        s.specks_per_frame, s.specks_per_frame + s.blobs_per_frame);
  }
  return fmt::format(
      "the animals cannot be told apart: only {:.1f} % of {:.0f} sightings a frame have one "
      "possible successor; density and flow are given instead of identities",
      100 * s.share, s.blobs_per_frame);
}

}  // namespace flocklift
