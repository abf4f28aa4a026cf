// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The batch method's model: unknowns and residuals of a whole sequence. Every animal (segment) has
// its path (cost_functions/path.h) and two scalars of its own; a few unknowns belong to the flock.
// Given those, the animals are independent: an arrow (arrow_system.h).

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_PROBLEM_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_PROBLEM_H_

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "reconstruct/cost_functions/body_image.h"
#include "reconstruct/cost_functions/markov.h"
#include "reconstruct/initialize/segments.h"
#include "reconstruct/knowledge.h"
#include "reconstruct/solve/arrow_system.h"
#include "reconstruct/solve/batch_options.h"
#include "reconstruct/solve/camera_path.h"
#include "reconstruct/solve/flock_curve.h"
#include "reconstruct/solve/terms.h"

namespace flocklift::internal {

// The flock's unknowns; its curves over time follow the last.
inline constexpr int kFlockLogSpeed = 0, kSizeRatio = 1, kLogTrunk = 2, kLogUp = 3, kLean = 4;
inline constexpr int kFlockScalars = 5;
inline constexpr double kDepthKnotTime = 2;  // [s]
inline constexpr double kTurnKnotTime = 2;   // [s]
// An animal's own unknowns.
inline constexpr int kOwnLogSpeed = 0, kOwnSizeBias = 1, kOwnUnknowns = 2;

// The spreads of the priors; estimated while solving, but for `along`.
struct Spreads {
  MarkovProcess acceleration, speed, size, climb, depth;
  MarkovProcess turn;   // the acceleration that the flock has in common
  MarkovProcess along;  // speed along the line of sight over the mean, in erratic flight
  double speed_between = 0.1;
  double size_between = 0.05;
};

struct Bird {
  const Segment* segment = nullptr;
  int first_knot = 0;        // on the sequence's grid of knots
  int knots = 0;             // at least 2; control points: knots + 2
  std::vector<double> path;  // control points, (X, Y, L) each
  std::array<double, kOwnUnknowns> own{};
  std::vector<std::optional<double>> size;  // mean log angular size around each knot
  std::vector<std::optional<Vec2d>> form;   // mean ellipticity there (initialize/segments.h)
  std::vector<Vec3d> curve;                 // acceleration over gravity's, at the knots [1]
  double reference_depth = 1;               // scale of accelerations [m]
  double softening = 1e-3;                  // speed over depth that counts as none [1/s]

  struct Place {  // a time on the path
    int interval = 0;
    std::array<double, 4> weights{};
    std::array<double, 4> slopes{};  // by time
  };
  std::vector<Place> places;       // of the sightings
  std::vector<Place> view_places;  // of the second camera's views
  struct Known {
    Place place;
    Vec3d position_in_cam;
    double sd = 1;
  };
  std::vector<Known> anchors;

  int unknowns() const { return static_cast<int>(path.size()); }
};

// What is known of the body of the flock's animals from the forms of their images.
struct FlockBody {
  BodyImage image;
  double length_sd = 0.06, amplitude_sd = 0.25;  // of birds in general
  double lean = 0;                               // into turns, where it is seen
  double share = 0;  // how probably sizes follow it (cost_functions/size.h)
  bool weak_perspective = false;

  double Perspective() const { return weak_perspective ? 1 - share : 1; }  // cost_functions/size.h
};

// What is known of the flock's scalars from another part of the same sequence.
struct Belief {
  using Vector = Eigen::Matrix<double, kFlockScalars, 1>;
  using Matrix = Eigen::Matrix<double, kFlockScalars, kFlockScalars>;
  Vector mean = Vector::Zero();
  Matrix information = Matrix::Zero();
  FlockBody body = {};
};

// What stays fixed during one solve.
struct BatchModel {
  double knot_interval = 0.1;  // [s]
  CameraPath camera;
  Spreads spreads;
  double log_wingspan = 0;  // [log m]; 0 m^0 where unknown (the ratio is then free)
  std::optional<Vec3d> up_in_cam;
  bool use_size = true, use_climb = true, use_depth = true;
  std::optional<double> log_near, log_far;
  bool erratic = false;  // speeds are not kept (cost_functions/erratic_flight.h)
  FlockBody body;
  Uncertain flock_log_speed, size_ratio, log_trunk, log_up, lean, log_depth;
  std::optional<Belief> belief;  // instead of the scalars' priors
  double depth_step_sd = 0.3;    // of the flock's middle over one kDepthKnotTime
  FlockCurve depth;              // log depth of the flock's middle
  FlockCurve turn;               // its common acceleration [m/s^2]

  // Solvers call it before every iteration, from one thread at a time; may be empty.
  std::function<void()> on_iteration = {};

  int shared() const { return turn.end(); }
  void CountIteration() const {
    if (on_iteration) on_iteration();
  }
};

// Which residuals: where forces explain accelerations, those are not among them.
enum class RowKind { kAll, kNoAccelerations };

// Hands every whitened residual of one bird to `take`, with derivatives when asked; else nothing of
// a row but its residual counts.
void ForEachRow(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
                bool derivatives, const RowSink& take, RowKind kind = RowKind::kAll);

// The unwhitened errors e of the Markov terms at every knot, one row each, with derivatives.
void ForEachError(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
                  const RowSink& take);

double CostOf(const BatchModel& model, const Bird& bird, const Eigen::VectorXd& shared,
              RowKind kind = RowKind::kAll);

// Priors of the flock's unknowns: cost, and if not null their normal equations (added).
double SharedPriors(const BatchModel& model, const Eigen::VectorXd& shared, Eigen::MatrixXd* matrix,
                    Eigen::VectorXd* gradient);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_PROBLEM_H_
