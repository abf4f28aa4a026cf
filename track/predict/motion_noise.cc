// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/predict/motion_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flocklift {
namespace {

constexpr double kMostSurprise = 14;    // of one measurement: a wrong link is no lesson
constexpr std::size_t kLeastPaths = 3;  // fewer teach nothing
constexpr std::size_t kBankSamples = 8000;
constexpr int kHorizon = 3;
constexpr double kCorrelations[] = {2, 4, 8, 16};  // [frames]
constexpr int kMostSteps = 8;      // of half an octave, when a factor is sought from near it
constexpr double kLeastGain = 10;  // of the log likelihood, of Singer's model over a simpler one

struct Nearest {
  int index = -1;
  double distance2 = std::numeric_limits<double>::infinity();
  double next_distance2 = std::numeric_limits<double>::infinity();

  bool IsClear() const { return index >= 0 && 4 * distance2 < next_distance2; }
};

// Points sorted by x, for nearest neighbours without a scale.
class SortedPoints {
 public:
  explicit SortedPoints(const std::vector<Vec2d>& points) : points_(points) {
    for (std::size_t k = 0; k < points.size(); ++k) order_.push_back(static_cast<int>(k));
    std::sort(order_.begin(), order_.end(), [&points](int a, int b) {
      return points[a].x != points[b].x ? points[a].x < points[b].x : a < b;
    });
  }

  Nearest Find(const Vec2d& p) const {
    Nearest nearest;
    const auto middle = std::lower_bound(order_.begin(), order_.end(), p.x,
                                         [this](int k, double x) { return points_[k].x < x; });
    auto right = middle;
    auto left = middle;
    while (left != order_.begin() || right != order_.end()) {
      const double to_left = left != order_.begin() ? p.x - points_[*(left - 1)].x
                                                    : std::numeric_limits<double>::infinity();
      const double to_right =
          right != order_.end() ? points_[*right].x - p.x : std::numeric_limits<double>::infinity();
      const double gap = std::min(to_left, to_right);
      if (gap * gap > nearest.next_distance2) break;
      const int k = to_left <= to_right ? *--left : *right++;
      const double dx = points_[k].x - p.x, dy = points_[k].y - p.y;
      const double distance2 = dx * dx + dy * dy;
      if (distance2 < nearest.distance2) {
        nearest.next_distance2 = nearest.distance2;
        nearest.distance2 = distance2;
        nearest.index = k;
      } else {
        nearest.next_distance2 = std::min(nearest.next_distance2, distance2);
      }
    }
    return nearest;
  }

 private:
  const std::vector<Vec2d>& points_;
  std::vector<int> order_;
};

struct Growing {
  std::vector<Vec2d> positions;
  std::vector<double> sizes;

  // Where its own velocity takes it next.
  Vec2d Ahead() const {
    const Vec2d& p = positions.back();
    if (positions.size() < 2) return p;
    const Vec2d& before = positions[positions.size() - 2];
    return {2 * p.x - before.x, 2 * p.y - before.y};
  }
};

// -ln of the density of z [1/px^2].
double Surprise(const MotionState& state, const Vec2d& z, double r) {
  return 0.5 * SquaredInnovation(state, z, r) + std::log(2 * std::numbers::pi * (state.pp + r));
}

// Of the positions one frame and kHorizon frames ahead. The far look tells noise that comes and
// goes (a wingbeat moves the blob's centre to and fro) from motion that stays.
double LogLikelihood(std::span<const Path> paths, const MotionNoise& noise) {
  const MotionStep step = noise.Step(), far_step = noise.Step(kHorizon - 1);
  double sum = 0;
  for (const Path& path : paths) {
    const double q = noise.ProcessVariance(path.size), r = noise.MeasurementVariance(path.size);
    MotionState state = noise.Start(path.positions[0], r, q);
    for (std::size_t k = 1; k < path.positions.size(); ++k) {
      Predict(&state, step, q);
      // Before the third, the velocity is not known.
      if (k >= 3) sum -= std::min(Surprise(state, path.positions[k], r), kMostSurprise);
      if (k >= 3 && k + kHorizon - 1 < path.positions.size()) {
        MotionState ahead = state;
        Predict(&ahead, far_step, q);
        sum -= std::min(Surprise(ahead, path.positions[k + kHorizon - 1], r), kMostSurprise);
      }
      Update(&state, path.positions[k], r);
    }
  }
  return sum;
}

// Enough is enough: the first paths, in their order.
std::span<const Path> Enough(std::span<const Path> paths) {
  std::size_t used = 0, samples = 0;
  while (used < paths.size() && samples < kBankSamples) samples += paths[used++].positions.size();
  return paths.first(used);
}

// The better of `best` and what has one factor changed to 2^(half_octaves / 2).
void TryFactor(std::span<const Path> paths, bool is_acceleration, int half_octaves,
               MotionNoise noise, double* best_likelihood, MotionNoise* best) {
  (is_acceleration ? noise.acceleration : noise.measurement) = std::exp2(0.5 * half_octaves);
  const double likelihood = LogLikelihood(paths, noise);
  if (likelihood > *best_likelihood) {
    *best_likelihood = likelihood;
    *best = noise;
  }
}

// Sets the two factors to the likeliest; returns the log likelihood. One factor after the other,
// over octaves: the likelihood has one hill.
double FitFactors(std::span<const Path> paths, MotionNoise* best) {
  best->acceleration = std::exp2(-4);
  best->measurement = std::exp2(-3.5);
  double best_likelihood = LogLikelihood(paths, *best);
  for (int round = 0; round < 3; ++round) {
    const MotionNoise before = *best;
    for (const bool is_acceleration : {true, false}) {
      const MotionNoise base = *best;
      for (int half_octaves = is_acceleration ? -20 : -12;
           half_octaves <= (is_acceleration ? 2 : -2); half_octaves += round == 0 ? 2 : 1) {
        TryFactor(paths, is_acceleration, half_octaves, base, &best_likelihood, best);
      }
    }
    if (round > 0 && best->acceleration == before.acceleration &&
        best->measurement == before.measurement) {
      break;
    }
  }
  return best_likelihood;
}

// The same from factors that are nearly right, by steps to either side of them.
double RefitFactors(std::span<const Path> paths, MotionNoise* best) {
  double best_likelihood = LogLikelihood(paths, *best);
  for (bool has_moved = true; has_moved;) {
    has_moved = false;
    for (const bool is_acceleration : {true, false}) {
      const double factor = is_acceleration ? best->acceleration : best->measurement;
      const int here = static_cast<int>(std::lround(2 * std::log2(factor)));
      for (const int side : {1, -1}) {
        const MotionNoise base = *best;
        const double before = best_likelihood;
        for (int steps = 1; steps <= kMostSteps; ++steps) {
          const double last = best_likelihood;
          TryFactor(paths, is_acceleration, here + side * steps, base, &best_likelihood, best);
          if (best_likelihood == last) break;
        }
        has_moved = has_moved || best_likelihood > before;
        if (best_likelihood > before) break;
      }
    }
  }
  return best_likelihood;
}

}  // namespace

double ExtentOf(std::span<const Vec2d> points) {
  double low_x = 1e18, high_x = -1e18, low_y = 1e18, high_y = -1e18;
  for (const Vec2d& p : points) {
    low_x = std::min(low_x, p.x);
    high_x = std::max(high_x, p.x);
    low_y = std::min(low_y, p.y);
    high_y = std::max(high_y, p.y);
  }
  return std::hypot(high_x - low_x, high_y - low_y);
}

std::vector<Path> UnmistakablePaths(std::span<const BlobFrame> frames, int least) {
  std::vector<Path> paths;
  std::vector<Growing> growing;
  const auto close = [&paths, least](Growing* g) {
    if (static_cast<int>(g->positions.size()) < least) return;
    std::nth_element(g->sizes.begin(), g->sizes.begin() + g->sizes.size() / 2, g->sizes.end());
    const double size = g->sizes[g->sizes.size() / 2];
    if (ExtentOf(g->positions) < size) return;
    paths.push_back({size, std::move(g->positions)});
  };
  for (const BlobFrame& frame : frames) {
    std::vector<Vec2d> here, ahead;
    for (const Blob& blob : frame.blobs) here.push_back(blob.center);
    for (const Growing& g : growing) ahead.push_back(g.Ahead());
    const SortedPoints blobs(here), expected(ahead);
    std::vector<Growing> next;
    std::vector<bool> taken(here.size(), false);
    for (std::size_t k = 0; k < growing.size(); ++k) {
      const Nearest to = blobs.Find(ahead[k]);
      if (to.IsClear()) {
        const Nearest back = expected.Find(here[to.index]);
        if (back.IsClear() && back.index == static_cast<int>(k)) {
          growing[k].positions.push_back(here[to.index]);
          growing[k].sizes.push_back(SizeOf(frame.blobs[to.index]));
          taken[to.index] = true;
          next.push_back(std::move(growing[k]));
          continue;
        }
      }
      close(&growing[k]);
    }
    for (std::size_t j = 0; j < here.size(); ++j) {
      if (!taken[j]) next.push_back({{here[j]}, {SizeOf(frame.blobs[j])}});
    }
    growing = std::move(next);
  }
  for (Growing& g : growing) close(&g);
  return paths;
}

MotionNoise EstimateMotionNoise(std::span<const Path> paths, const MotionNoise& start) {
  if (paths.size() < kLeastPaths) return start;
  const std::span<const Path> some = Enough(paths);
  MotionNoise best = start;
  double sum = 0, count = 0;
  for (const Path& path : some) {
    for (std::size_t k = 1; k < path.positions.size(); ++k) {
      const double dx = path.positions[k].x - path.positions[k - 1].x;
      const double dy = path.positions[k].y - path.positions[k - 1].y;
      sum += dx * dx + dy * dy;
      count += 2;
    }
  }
  best.speed_sd = std::max(1.5 * std::sqrt(sum / std::max(count, 1.0)), 0.5);

  best.correlation = 0;
  FitFactors(some, &best);
  return best;
}

MotionNoise EstimateMotionModel(std::span<const Path> paths, const MotionNoise& straight) {
  MotionNoise best = straight;
  if (paths.size() < kLeastPaths) return best;
  const std::span<const Path> some = Enough(paths);
  double best_likelihood = LogLikelihood(some, best);
  for (const double correlation : kCorrelations) {
    MotionNoise noise = best;
    noise.correlation = correlation;
    const double likelihood = RefitFactors(some, &noise);
    if (likelihood < best_likelihood + kLeastGain) break;  // of these, too, there is one hill
    best_likelihood = likelihood;
    best = noise;
  }
  return best;
}

}  // namespace flocklift
