// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the flock tracker that says which animals each blob may show, and where in it.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "track/associate/flock_tracker.h"
#include "track/associate/occupants.h"
#include "track/associate/point_grid.h"
#include "track/associate/share_blob.h"

namespace flocklift {
namespace {

constexpr double kHiddenAmbiguity = 0.3;
constexpr double kReachSds = 1.5;  // a prediction so near to a blob may be inside

double SquaredDistanceToPixels(std::span<const BlobPixel> pixels, const Vec2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const BlobPixel& q : pixels) {
    const double dx = std::max(std::abs(q.x - p.x) - 0.5, 0.0);
    const double dy = std::max(std::abs(q.y - p.y) - 0.5, 0.0);
    nearest = std::min(nearest, dx * dx + dy * dy);
  }
  return nearest;
}

// Of the box around some pixels: never more than that of the nearest of them.
struct Bounds {
  float left = 0, top = 0, right = 0, bottom = 0;

  explicit Bounds(std::span<const BlobPixel> pixels) {
    if (pixels.empty()) return;
    left = right = pixels[0].x;
    top = bottom = pixels[0].y;
    for (const BlobPixel& q : pixels) {
      left = std::min(left, q.x);
      right = std::max(right, q.x);
      top = std::min(top, q.y);
      bottom = std::max(bottom, q.y);
    }
  }
  double SquaredDistance(const Vec2d& p) const {
    const double dx = std::max({left - 0.5 - p.x, p.x - right - 0.5, 0.0});
    const double dy = std::max({top - 0.5 - p.y, p.y - bottom - 0.5, 0.0});
    return dx * dx + dy * dy;
  }
};

std::span<const BlobPixel> PixelsOf(const BlobFrame& frame, const Blob& blob) {
  return std::span(frame.pixels).subspan(blob.first_pixel, blob.pixel_count);
}

}  // namespace

// For each blob the confirmed animals whose prediction lies in it or just beside, each animal in
// the nearest blob only.
std::vector<std::vector<int>> FlockTracker::ExpectedInBlobs(const BlobFrame& blobs) const {
  std::vector<std::vector<int>> expected(blobs.blobs.size());
  std::vector<Vec2d> centers;
  std::vector<Bounds> bounds;
  double longest = 0;
  for (const Blob& blob : blobs.blobs) {
    centers.push_back(blob.center);
    bounds.emplace_back(PixelsOf(blobs, blob));
    longest = std::max({longest, blob.box.width, blob.box.height});
  }
  const PointGrid grid(centers, std::max(longest, 8.0));
  for (std::size_t i = 0; i < animals_.size(); ++i) {
    const Animal& animal = animals_[i];
    if (!animal.confirmed) continue;
    const double reach = 0.7 + kReachSds * std::sqrt(animal.motion.state().pp);
    double nearest = reach * reach;
    int where = -1;
    grid.ForEachWithin(animal.motion.state().position, reach + longest, [&](int j, double) {
      if (bounds[j].SquaredDistance(animal.motion.state().position) > nearest) return;
      const double distance2 =
          SquaredDistanceToPixels(PixelsOf(blobs, blobs.blobs[j]), animal.motion.state().position);
      if (distance2 < nearest || (distance2 == nearest && where < 0)) {
        nearest = distance2;
        where = j;
      }
    });
    if (where >= 0) expected[where].push_back(static_cast<int>(i));
  }
  return expected;
}

// Two tracks share a blob only if their animals were once seen apart, both alone in the same frame
// (or, longer ago than is remembered by frame, in the same stretch of frames): else the second is
// the first one found again, or a piece of it. Whoever was missed longer, or came later, has to
// wait.
void FlockTracker::KeepSeenApart(int frame, std::vector<int>* inside) const {
  std::stable_sort(inside->begin(), inside->end(), [this](int a, int b) {
    const Animal &x = animals_[a], &y = animals_[b];
    return x.missed != y.missed ? x.missed < y.missed : x.hits > y.hits;
  });
  std::vector<int> kept;
  for (const int i : *inside) {
    const Animal& x = animals_[i];
    const bool apart = std::all_of(kept.begin(), kept.end(), [&](int k) {
      const Animal& y = animals_[k];
      const int both_from = std::max(x.first_alone, y.first_alone);
      if (both_from > std::min(x.last_alone, y.last_alone)) return false;
      return (x.alone & y.alone) != 0 || both_from + kRemembered <= frame;
    });
    if (apart) kept.push_back(i);
  }
  *inside = std::move(kept);
}

// Who could not be told from the others for so long that it may as well be gone has to wait until
// it is seen apart: first the one that had no blob of its own for the longest time.
void FlockTracker::WaitIfHidden(std::vector<int>* inside) const {
  while (inside->size() >= 2) {
    const auto first = std::min_element(inside->begin(), inside->end(), [this](int a, int b) {
      const Animal &x = animals_[a], &y = animals_[b];
      return x.last_alone != y.last_alone ? x.last_alone < y.last_alone : x.hits < y.hits;
    });
    if (animals_[*first].hidden <= options_.max_missed_frames) return;
    inside->erase(first);
  }
}

Expectation FlockTracker::ExpectationOf(const Animal& animal) const {
  return {animal.motion.state().position, animal.motion.state().pp,
          noise_.MeasurementVariance(animal.record.size), animal.record.mass, animal.moments};
}

// Takes out who is not in the blob, though predicted there.
void FlockTracker::DropAbsent(const Blob& blob, std::vector<int>* inside) const {
  std::vector<Expectation> expectations;
  for (const int i : *inside) expectations.push_back(ExpectationOf(animals_[i]));
  std::vector<int> present;
  for (const std::size_t k : FindOccupants(blob, expectations)) present.push_back((*inside)[k]);
  *inside = std::move(present);
}

std::vector<FlockTracker::Observation> FlockTracker::Observe(const BlobFrame& blobs) {
  std::vector<std::vector<int>> expected = ExpectedInBlobs(blobs);
  std::vector<Observation> observations;
  for (std::size_t j = 0; j < blobs.blobs.size(); ++j) {
    const Blob& blob = blobs.blobs[j];
    std::vector<int>& inside = expected[j];
    KeepSeenApart(blobs.frame, &inside);
    WaitIfHidden(&inside);
    if (inside.size() >= 2) DropAbsent(blob, &inside);
    if (inside.size() < 2) {
      observations.push_back({.position = blob.center, .blob = static_cast<int>(j)});
      continue;
    }
    std::vector<Expectation> expectations;
    for (const int i : inside) expectations.push_back(ExpectationOf(animals_[i]));
    const std::vector<BlobShare> shares = ShareBlob(PixelsOf(blobs, blob), expectations);
    for (std::size_t k = 0; k < inside.size(); ++k) {
      observations.push_back({.position = shares[k].position,
                              .variance = shares[k].variance,
                              .hidden = shares[k].ambiguity > kHiddenAmbiguity,
                              .blob = static_cast<int>(j),
                              .owner = inside[k]});
    }
  }
  return observations;
}

}  // namespace flocklift
