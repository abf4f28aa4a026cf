// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/batch_start.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/cost_functions/erratic_flight.h"
#include "reconstruct/cost_functions/path.h"
#include "reconstruct/cost_functions/size.h"
#include "reconstruct/initialize/depth_search.h"
#include "reconstruct/initialize/persistence.h"
#include "reconstruct/initialize/triangulation.h"

namespace flocklift::internal {
namespace {

// A prior that says next to nothing, of a logarithm.
constexpr double kVague = 3;
// Second moments of a silhouette weigh body and wings by area and vary more than boxes.
constexpr Uncertain kTrunkOfBoxes{kUsualLogTrunk, 0.4}, kUpOfBoxes{kUsualLogUp, 0.7};
constexpr Uncertain kTrunkOfShapes{-1.2, 0.6}, kUpOfShapes{-1.6, 0.7};
// Log of (root mean square of a box's diagonal over all views, over the wingspan), until headings
// are known well enough for box_of_body.h: 0 to -0.1 gliding (the extents above add up to 5/6 of
// the span), -0.2 and less beating; blur adds a little.
constexpr Uncertain kRatio{-0.2, 0.15};
// How far they lean into their turns: 1 where lift alone carries weight and curve, 0 not at all.
constexpr Uncertain kLeanIntoTurns{0.7, 0.5};

// Velocities and accelerations last as long as the image says; where wings and trunk point is not
// to be told from them, and images count as those of balls.
void MakeErratic(double persistence, BatchModel* model) {
  constexpr double kLeast = 0.05;
  constexpr Uncertain kBall{0, 0.1};  // of logs of proportions
  const double time = -kPersistenceLag / std::log(std::max(persistence, kLeast));
  Spreads& s = model->spreads;
  model->erratic = true;
  model->up_in_cam.reset();
  model->use_climb = false;
  model->log_trunk = model->log_up = kBall;
  s.speed = {kLogAcrossSd, std::min(s.speed.time, time)};
  s.along = {kAlongSd, s.speed.time};
  s.acceleration.time = std::min(s.acceleration.time, time);
}

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
  for (const Sighting& s : segment.sightings) bird.places.push_back(PlaceAt(model, bird, s.time));
  BinSizes(model, &bird);
  bird.curve = solved.curve;
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

BatchModel MakeModel(const BatchOptions& options, const Knowledge& knowledge,
                     const Segments& segments, const ScaleGuess& guess,
                     const std::optional<Belief>& belief, double fps) {
  BatchModel model;
  model.knot_interval = std::max(options.knot_interval, 1 / fps);
  model.camera = CameraPath(segments.camera_places, fps, model.knot_interval);
  Spreads& s = model.spreads;
  s.acceleration = {options.acceleration_sd, options.acceleration_time};
  if (options.estimate && guess.image_acceleration > 0) {
    s.acceleration.sd = std::max(0.3 * options.acceleration_sd,
                                 guess.image_acceleration * std::exp(guess.log_depth));
  }
  s.turn = {0.7 * s.acceleration.sd, kTurnKnotTime};
  s.speed = {options.speed_sd, options.speed_time};
  s.size = {options.size_sd, options.size_time};
  s.climb = {options.climb_sd, options.climb_time};
  s.depth = {std::max(guess.lateral_spread, 0.02), options.depth_time};
  s.speed_between = options.speed_spread;
  s.size_between =
      knowledge.wingspan ? std::max(0.01, knowledge.wingspan->sd / knowledge.wingspan->mean) : 0.07;
  model.log_wingspan = knowledge.wingspan ? std::log(knowledge.wingspan->mean) : 0;
  model.up_in_cam = knowledge.up_in_cam;
  model.use_climb = options.level_flight && knowledge.up_in_cam.has_value();
  model.use_depth = options.shared_depth;
  model.use_size = knowledge.use_size;
  if (knowledge.near) model.log_near = std::log(*knowledge.near);
  if (knowledge.far) model.log_far = std::log(*knowledge.far);
  model.flock_log_speed = {guess.log_speed,
                           knowledge.speed ? knowledge.speed->sd / knowledge.speed->mean : kVague};
  model.size_ratio =
      knowledge.wingspan
          ? Uncertain{kRatio.mean, std::hypot(options.size_ratio_sd, kRatio.sd, s.size_between)}
          : Uncertain{guess.log_width, kVague};
  model.log_trunk = segments.has_shapes ? kTrunkOfShapes : kTrunkOfBoxes;
  model.log_up = segments.has_shapes ? kUpOfShapes : kUpOfBoxes;
  model.lean = kLeanIntoTurns;
  if (options.erratic_flight && IsErratic(segments.persistence)) {
    MakeErratic(segments.persistence, &model);
  }
  model.log_depth = {guess.log_depth, kVague};
  if (knowledge.near && knowledge.far) {
    // Anywhere between them: the sd of a uniform distribution.
    model.log_depth.sd = std::log(*knowledge.far / *knowledge.near) / std::sqrt(12.0);
    model.use_depth = true;
  }
  if (belief) {
    // The scale is another part's; here it is only shared.
    model.belief = belief;
    model.body = belief->body;
    model.flock_log_speed.mean = belief->mean[kFlockLogSpeed];
    model.size_ratio.mean = belief->mean[kSizeRatio];
    model.log_trunk.mean = belief->mean[kLogTrunk];
    model.log_up.mean = belief->mean[kLogUp];
    model.lean.mean = belief->mean[kLean];
    model.log_depth.sd = kVague;
  }
  double last_time = 0;
  for (const Segment& segment : segments.segments) {
    last_time = std::max(last_time, segment.sightings.back().time);
  }
  model.depth = FlockCurve::Until(last_time, kFlockScalars, 1, kDepthKnotTime);
  model.turn = {.first = model.depth.end()};
  if (options.flock_turn) {
    model.turn = FlockCurve::Until(last_time, model.depth.end(), 3, kTurnKnotTime);
  }
  return model;
}

ScaleGuess WithBelief(const ScaleGuess& guess, const Knowledge& knowledge,
                      const std::optional<Belief>& belief) {
  if (!belief) return guess;
  ScaleGuess shifted = guess;
  const double shift = belief->mean[kFlockLogSpeed] - guess.log_speed;
  shifted.log_speed += shift;
  shifted.log_depth += shift;
  shifted.log_width += shift;
  if (!knowledge.near) shifted.log_near += shift;
  if (!knowledge.far) shifted.log_far += shift;
  if (shifted.log_far < shifted.log_near + 0.05) return guess;
  shifted.log_depth = std::clamp(shifted.log_depth, shifted.log_near, shifted.log_far);
  return shifted;
}

Eigen::VectorXd StartOfShared(const BatchModel& model) {
  Eigen::VectorXd shared(model.shared());
  shared[kFlockLogSpeed] = model.flock_log_speed.mean;
  shared[kSizeRatio] = model.size_ratio.mean;
  shared[kLogTrunk] = model.log_trunk.mean;
  shared[kLogUp] = model.log_up.mean;
  shared[kLean] = model.lean.mean;
  shared.tail(model.shared() - kFlockScalars).setZero();
  shared.segment(model.depth.first, model.depth.size()).setConstant(model.log_depth.mean);
  return shared;
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
  for (const View& view : segment.views)
    bird.view_places.push_back(PlaceAt(model, bird, view.time));
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
