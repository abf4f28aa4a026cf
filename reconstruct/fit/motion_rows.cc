// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/motion_rows.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"

namespace flocklift {
namespace {

constexpr int kChunk = 32;   // middle frames that share their evaluations
constexpr int kSamples = 4;  // a frame, in continuous time
constexpr double kSteady = 0.75;
constexpr double kLeastGrowth = 4;

// A flock's state in one frame and the model's terms there.
struct FrameTerms {
  ObservedFlock::State state;
  std::vector<Vec3d> terms;           // n x columns
  std::vector<std::uint8_t> clamped;  // n

  std::span<const Vec3d> Of(int index, std::size_t columns) const {
    return std::span(terms).subspan(static_cast<std::size_t>(index) * columns, columns);
  }
};

FrameTerms Evaluate(const FlockTerms& model, ObservedFlock::State state) {
  const std::size_t n = state.animal.size(), columns = model.columns();
  FrameTerms frame;
  frame.state = std::move(state);
  frame.terms.resize(n * columns);
  frame.clamped.assign(n, 0);
  if (n > 0) model.evaluate(frame.state.position, frame.state.velocity, frame.terms);
  return frame;
}

// Takes off the terms what the speed clamp takes off accelerations, where it acts.
void ApplyClamp(const MotionOptions& options, const FlockTerms& model, FrameTerms* frame) {
  const std::size_t n = frame->state.animal.size(), columns = model.columns();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d& v = frame->state.velocity[i];
    const double speed = Norm(v);
    const bool acts = speed <= model.min_speed * (1 + options.clamp_margin) ||
                      speed >= model.max_speed * (1 - options.clamp_margin);
    if (!acts || speed == 0) continue;
    frame->clamped[i] = 1;
    const Vec3d along = v / speed;
    for (std::size_t c = 0; c < columns; ++c) {
      Vec3d& term = frame->terms[i * columns + c];
      term -= Dot(term, along) * along;
    }
  }
}

bool AllMeasured(const ObservedFlock& flock, int animal, int first, int last) {
  for (int f = first; f <= last; ++f) {
    if (!flock.Measured(animal, f)) return false;
  }
  return true;
}

class RowBuilder {
 public:
  RowBuilder(const MotionOptions& options, const FlockTerms& model, const ObservedFlock& flock)
      : options_(options),
        model_(model),
        flock_(flock),
        parts_(options.substeps > 0 ? options.substeps : kSamples),
        engine_step_(options.substeps > 0 ? 1.0 / options.substeps : 0.0) {}

  // Middles must come in increasing order.
  void Add(int middle, MotionRows* out) {
    const int m = options_.window, reach = m * parts_;
    const FrameTerms near = Foresee(middle, m + 2), far = Foresee(middle, 2 * m + 2);
    const int first = middle * parts_ - reach + 1, last = middle * parts_ + reach - 1;
    between_.erase(between_.begin(), between_.lower_bound(first));
    for (int n = first; n <= last; ++n) {
      if (!between_.contains(n)) between_.emplace(n, Between(n));
    }
    for (const int animal : between_.at(middle * parts_).state.animal) {
      if (!AllMeasured(flock_, animal, middle - m - 2, middle + m + 1)) continue;
      const int near_index = near.state.Find(animal), far_index = far.state.Find(animal);
      if (near_index < 0 || far_index < 0) continue;
      std::vector<Vec3d> sum(model_.columns());
      int acting = 0;
      for (int n = first; n <= last; ++n) {
        const FrameTerms& terms = between_.at(n);
        const int index = terms.state.Find(animal);
        acting += terms.clamped[static_cast<std::size_t>(index)];
        const double weight =
            (reach - std::abs(n - middle * parts_)) / (static_cast<double>(reach) * reach);
        const std::span<const Vec3d> columns = terms.Of(index, model_.columns());
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += weight * columns[c];
      }
      if (acting != 0 && acting != last - first + 1) {
        ++out->mixed;
      } else {
        Append(animal, middle, sum, near.Of(near_index, model_.columns()),
               far.Of(far_index, model_.columns()), acting != 0, out);
      }
    }
  }

 private:
  // The terms at step n, counted from frame 0.
  FrameTerms Between(int n) const {
    const int frame = n >= 0 ? n / parts_ : -((parts_ - 1 - n) / parts_);
    FrameTerms terms =
        Evaluate(model_, flock_.Between(frame, n - frame * parts_, parts_, engine_step_));
    ApplyClamp(options_, model_, &terms);
    return terms;
  }
  FrameTerms Foresee(int frame, int ahead) const {
    return Evaluate(model_, flock_.Foreseen(frame - ahead, 3 * options_.window, ahead));
  }
  void Append(int animal, int middle, std::span<const Vec3d> features, std::span<const Vec3d> near,
              std::span<const Vec3d> far, bool clamped, MotionRows* out) const {
    const int m = options_.window;
    const std::size_t p = model_.free.size();
    const double width = m * flock_.dt();
    const Vec3d& x = flock_.Position(animal, middle);
    const Vec3d difference =
        flock_.Position(animal, middle + m) - 2.0 * x + flock_.Position(animal, middle - m);
    out->frame.push_back(middle);
    out->animal.push_back(animal);
    out->position.push_back(x);
    out->response.push_back(difference / (width * width));
    out->known.push_back(features[p]);
    out->near_known.push_back(near[p]);
    for (std::size_t c = 0; c < p + 2; ++c) {
      if (c == p) continue;  // known
      out->features.push_back(features[c]);
      out->near.push_back(near[c]);
      out->far.push_back(far[c]);
    }
    out->depth_sd.push_back(flock_.SdDepth(animal, middle));
    out->clamped.push_back(clamped);
  }

  const MotionOptions& options_;
  const FlockTerms& model_;
  const ObservedFlock& flock_;
  int parts_;
  double engine_step_;
  std::map<int, FrameTerms> between_;
};

template <typename T>
void Move(std::vector<T>* from, std::vector<T>* to) {
  to->insert(to->end(), from->begin(), from->end());
  std::vector<T>().swap(*from);
}

}  // namespace

std::int64_t MotionRows::Find(int wanted_frame, int wanted_animal) const {
  auto first = std::lower_bound(frame.begin(), frame.end(), wanted_frame) - frame.begin();
  const auto last =
      std::upper_bound(frame.begin() + first, frame.end(), wanted_frame) - frame.begin();
  const auto found =
      std::lower_bound(animal.begin() + first, animal.begin() + last, wanted_animal) -
      animal.begin();
  return found < last && animal[static_cast<std::size_t>(found)] == wanted_animal ? found : -1;
}

template <typename Keep>
MotionRows MotionRows::Subset(const Keep& keep) const {
  MotionRows some;
  some.terms = terms;
  some.window = window;
  const std::size_t width = terms + 1;
  for (std::size_t k = 0; k < size(); ++k) {
    if (!keep(frame[k])) continue;
    some.frame.push_back(frame[k]);
    some.animal.push_back(animal[k]);
    some.position.push_back(position[k]);
    some.response.push_back(response[k]);
    some.known.push_back(known[k]);
    some.near_known.push_back(near_known[k]);
    for (std::size_t c = k * width; c < (k + 1) * width; ++c) {
      some.features.push_back(features[c]);
      some.near.push_back(near[c]);
      some.far.push_back(far[c]);
    }
    some.depth_sd.push_back(depth_sd[k]);
    some.clamped.push_back(clamped[k]);
  }
  return some;
}

MotionRows MotionRows::Before(int split) const {
  return Subset([&](int f) { return f + window + 1 < split; });
}

MotionRows MotionRows::From(int split) const {
  return Subset([&](int f) { return f - window - 1 >= split; });
}

MotionRows MotionRows::WithoutTerms(const std::vector<bool>& drop) const {
  MotionRows some = *this;
  some.terms = static_cast<std::size_t>(std::count(drop.begin(), drop.end(), false));
  for (std::vector<Vec3d>* columns : {&some.features, &some.near, &some.far}) {
    std::vector<Vec3d> kept;
    for (std::size_t k = 0; k < columns->size(); ++k) {
      const std::size_t c = k % (terms + 1);
      if (c == terms || !drop[c]) kept.push_back((*columns)[k]);
    }
    *columns = std::move(kept);
  }
  return some;
}

MotionRows BuildMotionRows(const MotionOptions& options, const FlockTerms& terms,
                           const ObservedFlock& flock, std::span<const int> middles,
                           const Progress& progress) {
  Check(options.window >= 1, "the window of a fit is at least one frame");
  MotionRows all;
  all.terms = terms.free.size();
  all.window = options.window;
  const auto count = static_cast<std::int64_t>(middles.size());
  std::vector<MotionRows> parts(static_cast<std::size_t>((count + kChunk - 1) / kChunk));
  std::atomic<std::int64_t> done{0};
  ParallelFor(options.threads, 0, count, kChunk, [&](std::int64_t begin, std::int64_t end) {
    RowBuilder builder(options, terms, flock);
    for (std::int64_t k = begin; k < end; ++k) {
      builder.Add(middles[static_cast<std::size_t>(k)],
                  &parts[static_cast<std::size_t>(begin / kChunk)]);
    }
    done += end - begin;
  });
  Report(progress, done, count);
  for (MotionRows& part : parts) {
    Move(&part.frame, &all.frame);
    Move(&part.animal, &all.animal);
    Move(&part.position, &all.position);
    Move(&part.response, &all.response);
    Move(&part.known, &all.known);
    Move(&part.near_known, &all.near_known);
    Move(&part.features, &all.features);
    Move(&part.near, &all.near);
    Move(&part.far, &all.far);
    Move(&part.depth_sd, &all.depth_sd);
    Move(&part.clamped, &all.clamped);
    all.mixed += part.mixed;
  }
  return all;
}

double SecondDifferenceMeanSquare(const ObservedFlock& flock, int window) {
  double sum = 0;
  std::int64_t count = 0;
  for (int animal = 0; animal < flock.animals(); ++animal) {
    const FrameSpan life = flock.Life(animal);
    for (int f = life.first + window; f + window <= life.last; ++f) {
      if (!flock.Measured(animal, f) || !flock.Measured(animal, f - window) ||
          !flock.Measured(animal, f + window)) {
        continue;
      }
      sum += SquaredNorm(flock.Position(animal, f + window) - 2.0 * flock.Position(animal, f) +
                         flock.Position(animal, f - window));
      count += 3;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : std::nan("");
}

int ChooseWindow(const ObservedFlock& flock, double longest) {
  int window = 1;
  double here = SecondDifferenceMeanSquare(flock, 1);
  double twice = SecondDifferenceMeanSquare(flock, 2);
  while (2 * window * flock.dt() <= longest) {
    const double four = SecondDifferenceMeanSquare(flock, 4 * window);
    // Growth from here to twice, and from there to four times the window.
    const bool steady = twice * twice >= kSteady * four * here;
    if (!(four > 0) || (steady && twice > kLeastGrowth * here)) break;
    window *= 2;
    here = twice;
    twice = four;
  }
  return window;
}

}  // namespace flocklift
