// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/second_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "reconstruct/initialize/triangulation.h"
#include "simulate/core/check.h"
#include "simulate/core/trajectory.h"

namespace flocklift {
namespace {

constexpr double kLimit = 4;          // median distance from the epipolar line of a match [px]
constexpr double kShortest = 0.25;    // time in common [s]
constexpr double kAmbiguous = 1.5;    // another animal within so many times the distance,
constexpr double kAmbiguousPx = 0.5;  // or so much more [px]

// One track of the second camera and one animal.
struct Pair {
  std::size_t animal = 0, track = 0;
  double error = 0;           // median distance from the epipolar line [px]
  double begin = 0, end = 0;  // time in common [s]
};

// a b
Rotation3d Product(const Rotation3d& a, const Rotation3d& b) {
  const auto column = [&](const Vec3d& axis) { return a * (b * axis); };
  return Rotation3d::FromRows(column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})).Inverse();
}

bool Overlap(const Pair& a, const Pair& b) { return a.begin < b.end && b.begin < a.end; }

class Matcher {
 public:
  Matcher(const SecondCamera& second, const SegmentOptions& options, const ReferenceAxes& axes,
          int first_frame, double fps, const Segments& segments)
      : second_(second),
        axes_(axes),
        first_frame_(first_frame),
        fps_(fps),
        segments_(segments),
        span_(SpanOf(second.tracks)),
        second_axes_(second.camera, span_.first, span_.last) {
    SegmentOptions tracks_options = options;
    tracks_options.use_size = false;
    tracks_ = MakeSegments(tracks_options, second.tracks, second.camera, second.fps);
    focal_px_ = second.camera.intrinsics.fx;
  }

  const std::vector<Segment>& tracks() const { return tracks_.segments; }

  // What the second camera saw, as a view of whichever animal, its clock `offset` behind.
  View ViewOf(const Sighting& s, double offset) const {
    View view;
    view.time = s.time + (span_.first - 1) / second_.fps + offset - (first_frame_ - 1) / fps_;
    const Rigid3d view_from_world = second_axes_.RefFromWorld(s.frame);
    const Rigid3d world_from_ref = axes_.WorldFromRef(first_frame_ + view.time * fps_);
    view.view_from_ref = {Product(view_from_world.rotation, world_from_ref.rotation),
                          view_from_world * world_from_ref.translation};
    view.ray = s.ray;
    view.ray_sd = s.ray_sd;
    return view;
  }

  // At most `samples` sightings are looked at.
  std::optional<Pair> Compare(std::size_t animal, std::size_t track, double offset,
                              std::size_t samples) const {
    const Segment& a = segments_.segments[animal];
    const auto& seen = tracks()[track].sightings;
    // Times of both, in the first camera's clock.
    const double shift = ViewOf(seen.front(), offset).time - seen.front().time;
    Pair pair{animal, track, 0, std::max(a.sightings.front().time, seen.front().time + shift),
              std::min(a.sightings.back().time, seen.back().time + shift)};
    if (pair.end - pair.begin < kShortest) return std::nullopt;
    const auto first = std::partition_point(
        seen.begin(), seen.end(), [&](const Sighting& s) { return s.time + shift < pair.begin; });
    const auto last = std::partition_point(
        first, seen.end(), [&](const Sighting& s) { return s.time + shift <= pair.end; });
    const auto count = static_cast<std::size_t>(last - first);
    const std::size_t stride = std::max<std::size_t>(1, count / samples);
    std::vector<double> errors;
    for (std::size_t k = stride / 2; k < count; k += stride) {
      const View view = ViewOf(*(first + static_cast<std::ptrdiff_t>(k)), offset);
      const auto ray = RayAt(a, view.time);
      if (!ray) continue;
      const auto distance = EpipolarDistance(*ray, view);
      if (!distance) continue;
      // Rays that meet behind a camera show two animals.
      errors.push_back(TriangulatedDepth(*ray, view) ? focal_px_ * std::abs(*distance)
                                                     : std::numeric_limits<double>::infinity());
    }
    if (errors.size() < 3) return std::nullopt;
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    pair.error = *middle;
    return pair;
  }

  // How badly the tracks fit with this offset: the mean of their least distances, cut off.
  double Misfit(double offset, std::size_t most_tracks, std::size_t samples) const {
    constexpr double kCutOff = 20;  // [px]
    double sum = 0;
    const std::size_t step = std::max<std::size_t>(1, tracks().size() / most_tracks);
    double count = 0;
    for (std::size_t track = 0; track < tracks().size(); track += step) {
      double least = kCutOff;
      for (std::size_t animal = 0; animal < segments_.segments.size(); ++animal) {
        if (const auto pair = Compare(animal, track, offset, samples)) {
          least = std::min(least, pair->error);
        }
      }
      sum += least;
      ++count;
    }
    return sum / std::max(count, 1.0);
  }

  // On a grid of half frames, then by thirds around the best.
  double FindOffset(double search) const {
    constexpr std::size_t kTracks = 40, kSamples = 9, kFineSamples = 31;
    const double step = 0.5 / std::max(fps_, second_.fps);
    const int steps = static_cast<int>(std::ceil(search / step));
    double best = 0, least = Misfit(0, kTracks, kSamples);
    for (int k = 1; k <= steps; ++k) {
      for (const double offset : {k * step, -k * step}) {
        const double misfit = Misfit(offset, kTracks, kSamples);
        if (misfit < least) {
          least = misfit;
          best = offset;
        }
      }
    }
    double low = best - 2 * step, high = best + 2 * step;
    while (high - low > 0.02 * step) {
      const double left = low + (high - low) / 3, right = high - (high - low) / 3;
      const bool is_left =
          Misfit(left, kTracks, kFineSamples) < Misfit(right, kTracks, kFineSamples);
      (is_left ? high : low) = is_left ? right : left;
    }
    return 0.5 * (low + high);
  }

  // The best pairs first; an animal has one view at a time, and a track one animal. A track that
  // fits two animals alike has none.
  std::vector<Pair> Match(double offset, int* ambiguous) const {
    constexpr std::size_t kSamples = 101;
    std::vector<Pair> pairs;
    for (std::size_t track = 0; track < tracks().size(); ++track) {
      for (std::size_t animal = 0; animal < segments_.segments.size(); ++animal) {
        const auto pair = Compare(animal, track, offset, kSamples);
        if (pair && pair->error < kAmbiguous * kLimit + kAmbiguousPx) pairs.push_back(*pair);
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.error < b.error; });
    std::vector<Pair> matched;
    *ambiguous = 0;
    for (const Pair& pair : pairs) {
      if (pair.error > kLimit) break;
      const bool taken = std::any_of(matched.begin(), matched.end(), [&](const Pair& m) {
        return (m.track == pair.track || m.animal == pair.animal) && Overlap(m, pair);
      });
      if (taken) continue;
      const bool doubtful = std::any_of(pairs.begin(), pairs.end(), [&](const Pair& other) {
        return other.track == pair.track && other.animal != pair.animal && Overlap(other, pair) &&
               other.error < kAmbiguous * pair.error + kAmbiguousPx;
      });
      if (doubtful) {
        ++*ambiguous;
      } else {
        matched.push_back(pair);
      }
    }
    return matched;
  }

 private:
  const SecondCamera& second_;
  const ReferenceAxes& axes_;
  int first_frame_;
  double fps_;
  const Segments& segments_;
  FrameSpan span_;
  ReferenceAxes second_axes_;
  Segments tracks_;
  double focal_px_ = 1;
};

}  // namespace

SecondCameraReport AttachViews(const SecondCamera& second, const SegmentOptions& options,
                               const ReferenceAxes& axes, int first_frame, double fps,
                               Segments* segments) {
  Check(second.fps > 0, "the second camera needs a positive number of frames per second");
  Check(second.search >= 0, "the search for the clocks' offset must not be negative");
  const Matcher matcher(second, options, axes, first_frame, fps, *segments);
  SecondCameraReport report;
  report.tracks = static_cast<int>(matcher.tracks().size());
  if (report.tracks == 0 || segments->segments.empty()) return report;
  report.offset = second.offset ? *second.offset : matcher.FindOffset(second.search);
  std::vector<double> errors;
  std::vector<bool> is_matched(matcher.tracks().size(), false);
  for (const Pair& pair : matcher.Match(report.offset, &report.ambiguous)) {
    Segment& animal = segments->segments[pair.animal];
    for (const Sighting& s : matcher.tracks()[pair.track].sightings) {
      const View view = matcher.ViewOf(s, report.offset);
      if (view.time < pair.begin || view.time > pair.end) continue;
      animal.views.push_back(view);
      ++report.views;
    }
    errors.push_back(pair.error);
    is_matched[pair.track] = true;
  }
  for (Segment& segment : segments->segments) {
    std::stable_sort(segment.views.begin(), segment.views.end(),
                     [](const View& a, const View& b) { return a.time < b.time; });
  }
  report.matched = static_cast<int>(std::count(is_matched.begin(), is_matched.end(), true));
  if (!errors.empty()) {
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    report.error = *middle;
  }
  return report;
}

}  // namespace flocklift
