// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/static_clutter.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "track/associate/point_grid.h"

namespace flocklift::internal {
namespace {

constexpr double kReach = 2;              // [px]
constexpr double kMostDrift = 0.6;        // of the mean of a third [px]
constexpr std::size_t kLeastFrames = 45;  // an animal at rest for less is no clutter
constexpr double kLeastShare = 0.3;       // of the frames
constexpr double kMostMassRatio = 2;      // of a blob, to the place's usual one, or below
constexpr int kForget = 90;               // frames

bool IsAlike(double mass, double usual) {
  return mass < kMostMassRatio * usual && usual < kMostMassRatio * mass;
}

}  // namespace

// Whether it was there often enough in each third, and about the same point.
bool StaticClutter::Place::Rests(double least) const {
  for (int t = 0; t < kThirds; ++t) {
    if (counts[t] < std::max(least, 1.0)) return false;
    const double dx = sums[t].x / counts[t] - position.x, dy = sums[t].y / counts[t] - position.y;
    if (dx * dx + dy * dy > kMostDrift * kMostDrift) return false;
  }
  return true;
}

std::vector<int> StaticClutter::PlacesOf(const BlobFrame& frame) const {
  std::vector<Vec2d> positions;
  for (const Place& place : places_) positions.push_back(place.position);
  const PointGrid grid(positions, 8);
  std::vector<int> place_of(frame.blobs.size(), -1), blob_of(places_.size(), -1);
  std::vector<double> nearest(places_.size(), kReach * kReach);
  for (std::size_t k = 0; k < frame.blobs.size(); ++k) {
    const Blob& blob = frame.blobs[k];
    grid.ForEachWithin(blob.center, kReach, [&](int p, double distance2) {
      if (!IsAlike(blob.mass, places_[p].mass) || distance2 >= nearest[p]) return;
      nearest[p] = distance2;
      blob_of[p] = static_cast<int>(k);
    });
  }
  for (std::size_t p = 0; p < places_.size(); ++p) {
    if (blob_of[p] >= 0) place_of[blob_of[p]] = static_cast<int>(p);
  }
  return place_of;
}

void StaticClutter::Learn(std::span<const BlobFrame> frames) {
  places_.clear();
  learned_ = 0;
  if (frames.size() < kLeastFrames) return;
  const int least = static_cast<int>(kLeastShare * static_cast<double>(frames.size()));
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const BlobFrame& frame = frames[f];
    const std::vector<int> place_of = PlacesOf(frame);
    const int left = static_cast<int>(frames.size() - f);
    const std::size_t third = f * kThirds / frames.size();
    const auto add = [third](const Vec2d& p, Place* place) {
      place->sums[third] = {place->sums[third].x + p.x, place->sums[third].y + p.y};
      ++place->counts[third];
    };
    for (std::size_t k = 0; k < frame.blobs.size(); ++k) {
      const Blob& blob = frame.blobs[k];
      if (place_of[k] < 0) {
        if (left < least) continue;
        places_.push_back({blob.center, blob.mass, 1, frame.frame});
        add(blob.center, &places_.back());
        continue;
      }
      Place& place = places_[place_of[k]];
      const double w = 1.0 / ++place.count;
      place.position.x += w * (blob.center.x - place.position.x);
      place.position.y += w * (blob.center.y - place.position.y);
      place.mass += w * (blob.mass - place.mass);
      place.last_frame = frame.frame;
      add(blob.center, &place);
    }
    std::erase_if(places_, [&](const Place& p) { return p.count + left - 1 < least; });
  }
  const double of_a_third = 0.5 * least / kThirds;
  std::erase_if(places_, [&](const Place& p) { return !p.Rests(of_a_third); });
  learned_ = places_.size();
}

void StaticClutter::Drop(BlobFrame* frame) {
  if (places_.empty()) return;
  const std::vector<int> place_of = PlacesOf(*frame);
  std::vector<Blob> kept;
  for (std::size_t k = 0; k < place_of.size(); ++k) {
    if (place_of[k] < 0) {
      kept.push_back(frame->blobs[k]);
    } else {
      Place& place = places_[place_of[k]];
      place.last_frame = std::max(place.last_frame, frame->frame);
    }
  }
  frame->blobs = std::move(kept);
  std::erase_if(places_, [&](const Place& p) { return frame->frame - p.last_frame > kForget; });
}

void StaticClutter::Save(StateWriter* state) const {
  state->Put(static_cast<std::uint64_t>(learned_));
  state->Put(places_);
}

void StaticClutter::Load(StateReader* state) {
  std::uint64_t learned = 0, count = 0;
  state->Take(&learned);
  learned_ = learned;
  state->Take(&count);
  places_.resize(count);
  for (Place& place : places_) state->Take(&place);
}

}  // namespace flocklift::internal
