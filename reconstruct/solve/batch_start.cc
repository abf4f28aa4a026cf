// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/batch_start.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/cost_functions/path.h"
#include "reconstruct/initialize/depth_search.h"
#include "reconstruct/initialize/triangulation.h"

namespace flocklift::internal {
namespace {

// X and Y of the control points: reprojection and white accelerations, linear.
void SmoothImagePath(const BatchModel& model, Bird* bird) {
  ArrowSystem system(bird->unknowns(), 0, 0);
  const auto take = [&system](Term, const ResidualRow& row) { system.Add(row); };
  const double rate2 = 1 / (model.knot_interval * model.knot_interval);
  for (std::size_t k = 0; k < bird->places.size(); ++k) {
    const Sighting& sighting = bird->segment->sightings[k];
    for (int axis = 0; axis < 2; ++axis) {
      ResidualRow row;
      row.first = 3 * bird->places[k].interval;
      row.residual = -(axis == 0 ? sighting.ray.x : sighting.ray.y) / sighting.ray_sd;
      for (int a = 0; a < 4; ++a) {
        row.path[3 * a + axis] = bird->places[k].weights[a] / sighting.ray_sd;
      }
      take(Term::kReprojection, row);
    }
  }
  const double sd = 2 * model.spreads.acceleration.sd / bird->reference_depth;
  for (int knot = 0; knot < bird->knots; ++knot) {
    for (int axis = 0; axis < 2; ++axis) {
      ResidualRow row;
      row.first = 3 * knot;
      row.path[axis] = row.path[axis + 6] = rate2 / sd;
      row.path[axis + 3] = -2 * rate2 / sd;
      take(Term::kAcceleration, row);
    }
  }
  for (int axis = 0; axis < 2; ++axis) {  // a slope that a single sighting leaves open
    ResidualRow row;
    row.path[axis] = -1e-2 * rate2 / sd;
    row.path[axis + 6] = 1e-2 * rate2 / sd;
    take(Term::kAnyVelocity, row);
  }
  for (int control = 0; control < bird->knots + 2; ++control) {  // L is not solved for here
    ResidualRow row;
    row.first = 3 * control;
    row.path[2] = 1;
    take(Term::kDepth, row);
  }
  Eigen::MatrixXd none(0, 0);
  Eigen::VectorXd nothing(0);
  if (!system.Reduce(0, &none, &nothing)) return;
  const Eigen::VectorXd path = system.BackSubstitute(nothing);
  for (int i = 0; i < bird->unknowns(); ++i) {
    if (i % 3 != 2) bird->path[static_cast<std::size_t>(i)] = path[i];
  }
}

void BinSizes(const BatchModel& model, Bird* bird) {
  std::vector<double> sums(static_cast<std::size_t>(bird->knots));
  std::vector<Vec2d> forms(sums.size());
  std::vector<int> counts(sums.size()), form_counts(sums.size());
  for (const Sighting& s : bird->segment->sightings) {
    if (!s.log_size) continue;
    const int knot =
        std::clamp(static_cast<int>(std::lround(s.time / model.knot_interval)) - bird->first_knot,
                   0, bird->knots - 1);
    sums[knot] += *s.log_size;
    ++counts[knot];
    if (!s.ellipticity) continue;
    forms[knot] = {forms[knot].x + s.ellipticity->x, forms[knot].y + s.ellipticity->y};
    ++form_counts[knot];
  }
  bird->size.assign(sums.size(), std::nullopt);
  bird->form.assign(sums.size(), std::nullopt);
  bird->curve.assign(sums.size(), Vec3d{});
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (counts[k] > 0) bird->size[k] = sums[k] / counts[k];
    const double n = form_counts[k];
    if (n > 0) bird->form[k] = Vec2d{forms[k].x / n, forms[k].y / n};
  }
}

// Of an animal of which nothing is known but what is seen.
DepthSearchPriors FirstPriors(const BatchModel& model, const ScaleGuess& guess) {
  const Spreads& s = model.spreads;
  constexpr double kAnySpeed = 1e3;
  return {.log_speed = guess.log_speed,
          .speed_sd = model.erratic ? kAnySpeed
                                    : std::hypot(s.speed_between, s.speed.sd,
                                                 std::min(model.flock_log_speed.sd, 0.3)),
          .speed_time = s.speed.time,
          .acceleration_sd = s.acceleration.sd,
          .acceleration_time = s.acceleration.time,
          .log_width = guess.log_width,
          .size_sd = std::hypot(s.size.sd, s.size_between, 0.1),
          .size_time = s.size.time,
          .log_depth = guess.log_depth,
          .depth_sd = model.use_depth ? std::max(1.5 * s.depth.sd, 0.1) : 1,
          .depth_time = s.depth.time,
          .climb_sd = s.climb.sd,
          .climb_time = s.climb.time,
          .up_in_cam = model.use_climb ? model.up_in_cam : std::nullopt,
          .log_near = guess.log_near,
          .log_far = guess.log_far};
}

void GridDepth(const BatchModel& model, const DepthSearchPriors& priors, Bird* bird) {
  constexpr double kSearchInterval = 0.25;  // [s]
  const int stride =
      std::max(1, static_cast<int>(std::lround(kSearchInterval / model.knot_interval)));
  const int steps = (bird->knots - 1) / stride + 1;
  std::vector<DepthSearchStep> search(static_cast<std::size_t>(steps));
  for (int k = 0; k < steps; ++k) {
    const double* c = &bird->path[3 * static_cast<std::size_t>(k * stride)];
    search[k].ray = {(c[0] + 4 * c[3] + c[6]) / 6, (c[1] + 4 * c[4] + c[7]) / 6};
    search[k].camera = model.camera.At((bird->first_knot + k * stride) * model.knot_interval).place;
    double sum = 0;
    int count = 0;
    for (int knot = std::max(0, k * stride - stride / 2);
         knot <= std::min(bird->knots - 1, k * stride + stride / 2); ++knot) {
      if (!bird->size[knot]) continue;
      sum += *bird->size[knot];
      ++count;
    }
    if (count > 0) search[k].log_size = sum / count;
  }
  std::vector<int> met(search.size());
  for (const View& view : bird->segment->views) {
    const auto ray = RayAt(*bird->segment, view.time);
    const auto depth = ray ? TriangulatedDepth(*ray, view) : std::nullopt;
    if (!depth) continue;
    const double knot = view.time / model.knot_interval - bird->first_knot;
    const int k = std::clamp(static_cast<int>(std::lround(knot / stride)), 0, steps - 1);
    search[k].log_depth = search[k].log_depth.value_or(0) + std::log(*depth);
    ++met[k];
  }
  for (std::size_t k = 0; k < search.size(); ++k) {
    if (search[k].log_depth) *search[k].log_depth /= met[k];
  }
  const std::vector<double> depth = SearchDepth(priors, stride * model.knot_interval, search);
  for (int control = 0; control < bird->knots + 2; ++control) {
    const double place = std::clamp((control - 1.0) / stride, 0.0, static_cast<double>(steps - 1));
    const int left = std::min(static_cast<int>(place), std::max(0, steps - 2));
    const int right = std::min(left + 1, steps - 1);
    bird->path[3 * static_cast<std::size_t>(control) + 2] =
        depth[left] + (place - left) * (depth[right] - depth[left]);
  }
}

}  // namespace

Bird WithSightings(const BatchModel& model, const Segment& segment, const Bird& solved) {
  Bird bird = solved;
  bird.segment = &segment;
  bird.places.clear();
  bird.view_places.clear();
  for (const Sighting& s : segment.sightings) bird.places.push_back(PlaceAt(model, bird, s.time));
  for (const View& v : segment.views) bird.view_places.push_back(PlaceAt(model, bird, v.time));
  BinSizes(model, &bird);
  SmoothImagePath(model, &bird);
  return bird;
}

Bird::Place PlaceAt(const BatchModel& model, const Bird& bird, double time) {
  const double position = time / model.knot_interval - bird.first_knot;
  Bird::Place place;
  place.interval = std::clamp(static_cast<int>(std::floor(position)), 0, bird.knots - 2);
  const double s = position - place.interval;
  place.weights = SplineWeights(s);
  place.slopes = SplineSlopes(s);
  for (double& slope : place.slopes) slope /= model.knot_interval;
  return place;
}

void SearchDepthAgain(const BatchModel& model, const ScaleGuess& guess,
                      const Eigen::VectorXd& shared, Bird* bird) {
  constexpr double kWorth = 0.5;
  const Spreads& s = model.spreads;
  DepthSearchPriors priors = FirstPriors(model, guess);
  priors.log_speed = bird->own[kOwnLogSpeed];
  priors.speed_sd = kWorth * std::hypot(s.speed.sd, 0.02);
  priors.log_width = model.log_wingspan + bird->own[kOwnSizeBias] + shared[kSizeRatio];
  priors.size_sd = kWorth * std::hypot(s.size.sd, 0.05);
  priors.log_depth = shared.segment(model.depth.first, model.depth.size()).mean();
  GridDepth(model, priors, bird);
}

Bird StartBird(const BatchModel& model, const Knowledge& knowledge, const ScaleGuess& guess,
               const Segment& segment, double fps, int first_frame) {
  const auto& sightings = segment.sightings;
  constexpr double kSlack = 1e-6;  // a sighting at a knot needs no interval after it
  Bird bird;
  bird.segment = &segment;
  bird.first_knot =
      static_cast<int>(std::floor(sightings.front().time / model.knot_interval + kSlack));
  const int last_knot =
      static_cast<int>(std::ceil(sightings.back().time / model.knot_interval - kSlack));
  bird.knots = std::max(last_knot, bird.first_knot + 1) - bird.first_knot + 1;
  bird.path.assign(3 * static_cast<std::size_t>(bird.knots + 2), 0.0);
  bird.own = {guess.log_speed, 0};
  bird.reference_depth = std::exp(guess.log_depth);
  bird.softening = 0.05 * std::exp(guess.log_speed - guess.log_depth);
  for (const Sighting& s : sightings) bird.places.push_back(PlaceAt(model, bird, s.time));
  for (const View& v : segment.views) bird.view_places.push_back(PlaceAt(model, bird, v.time));
  for (const Anchor& anchor : knowledge.anchors) {
    if (anchor.id != segment.id || anchor.frame < sightings.front().frame ||
        anchor.frame > sightings.back().frame) {
      continue;
    }
    bird.anchors.push_back(
        {PlaceAt(model, bird, (anchor.frame - first_frame) / fps), anchor.position, anchor.sd});
  }
  BinSizes(model, &bird);
  SmoothImagePath(model, &bird);
  GridDepth(model, FirstPriors(model, guess), &bird);
  return bird;
}

}  // namespace flocklift::internal
