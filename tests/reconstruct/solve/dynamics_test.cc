// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "reconstruct/solve/coupled_flock.h"
#include "reconstruct/solve/force_search.h"
#include "reconstruct/solve/window_solver.h"
#include "tests/reconstruct/coupled_case.h"

namespace flocklift {
namespace {

// Longer than the target stays between two of its knots.
constexpr int kLong = 150;
static_assert(kLong / kFps > internal::kTargetKnotTime);

// Gradient of the whole coupled cost against differences, in random directions.
TEST(CoupledFlock, GradientIsThatOfDifferences) {
  WithFlock({.count = 5, .frames = kLong}, {.max_iterations = 3},
            [](const internal::WindowToRefine& window, internal::CoupledFlock& flock) {
              flock.noise = {.sd = 2, .time = 0.7};
              Rng rng(4);
              for (double& x : flock.forces.unknowns) x += 0.1 * rng.Normal();
              flock.Relinearize();
              const Eigen::VectorXd gradient = flock.Gradient();
              const auto move = [&](const Eigen::VectorXd& d, double step) {
                Eigen::Index at = 0;
                for (internal::Bird& bird : window.state.birds) {
                  for (double& p : bird.path) p += step * d[at++];
                  for (double& p : bird.own) p += step * d[at++];
                }
                for (double& p : window.state.shared) p += step * d[at++];
                for (double& p : flock.forces.unknowns) p += step * d[at++];
                EXPECT_EQ(at, d.size());
              };
              for (int trial = 0; trial < 5; ++trial) {
                Eigen::VectorXd d(gradient.size());
                for (double& x : d) x = rng.Normal();
                constexpr double kStep = 1e-7;
                move(d, kStep);
                const double up = flock.Cost();
                move(d, -2 * kStep);
                const double down = flock.Cost();
                move(d, kStep);
                const double slope = (up - down) / (2 * kStep);
                EXPECT_NEAR(slope / gradient.dot(d), 1, 1e-4);
              }
            });
}

// Column by column.
Eigen::MatrixXd MatrixOf(internal::CoupledFlock* flock) {
  const Eigen::Index n = flock->Gradient().size();
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    internal::Columns<1> column;
    flock->Multiply<1>(Eigen::VectorXd::Unit(n, k), &column);
    matrix.col(k) = column;
  }
  return matrix;
}

// Conjugate gradients against the direct factor of the same matrix.
TEST(CoupledFlock, SolvesWhatADirectFactorSolves) {
  WithFlock({.count = 3, .frames = kLong}, {},
            [](const internal::WindowToRefine&, internal::CoupledFlock& flock) {
              const Eigen::MatrixXd matrix = MatrixOf(&flock);
              EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-9 * matrix.norm());
              const Eigen::LLT<Eigen::MatrixXd> direct(matrix);
              ASSERT_EQ(direct.info(), Eigen::Success);
              Rng rng(6);
              Eigen::VectorXd x(matrix.rows());
              for (double& v : x) v = rng.Normal();
              const Eigen::VectorXd b = matrix * x;
              ASSERT_TRUE(flock.Factorise(0));
              const Eigen::VectorXd solved = flock.Solve<1>(b, {.share = 1e-12, .most = 500});
              const Eigen::VectorXd off = solved - direct.solve(b);
              // In the norm of the matrix: what is hardly known may be off.
              EXPECT_LT(off.dot(matrix * off), 1e-8 * b.dot(x));
            });
}

// Draws spread as the inverse of the matrix says, animal by animal and all together.
TEST(CoupledFlock, DepthsAreAsSureAsTheInverseSays) {
  WithFlock({.count = 4, .frames = 40}, {},
            [](const internal::WindowToRefine& window, internal::CoupledFlock& flock) {
              const auto sds = flock.Depths();
              const Eigen::MatrixXd covariance = MatrixOf(&flock).inverse();
              const std::vector<internal::Bird>& birds = window.state.birds;
              Eigen::Index at = 0;
              std::vector<Eigen::VectorXd> rows;
              Eigen::VectorXd mean = Eigen::VectorXd::Zero(covariance.rows());
              for (const internal::Bird& bird : birds) {
                for (const internal::Bird::Place& place : bird.places) {
                  Eigen::VectorXd& row = rows.emplace_back(Eigen::VectorXd::Zero(mean.size()));
                  for (int a = 0; a < 4; ++a) {
                    row[at + 3 * (place.interval + a) + 2] =
                        place.weights[static_cast<std::size_t>(a)];
                  }
                  mean += row;
                }
                at += bird.unknowns() + internal::kOwnUnknowns;
              }
              mean /= static_cast<double>(rows.size());
              // 32 draws: the root of 2 / 32 for one variance.
              EXPECT_NEAR(sds.mean * sds.mean / mean.dot(covariance * mean), 1, 0.75);
              std::size_t next = 0;
              for (const auto& animal : sds.at) {
                double drawn = 0, exact = 0;
                for (const double sd : animal) {
                  const Eigen::VectorXd row = rows[next++] - mean;
                  drawn += sd * sd;
                  exact += row.dot(covariance * row);
                }
                EXPECT_NEAR(drawn / exact, 1, 0.6);
              }
              EXPECT_EQ(next, rows.size());
            });
}

TEST(CoupledFlock, MinimizeLowersTheCostToWhereItStays) {
  WithFlock({.count = 6, .frames = 60}, {},
            [](const internal::WindowToRefine&, internal::CoupledFlock& flock) {
              const double at_first = flock.Cost();
              flock.FitForces(20);
              const double before = flock.Cost();
              EXPECT_LT(before, at_first);
              flock.Minimize(30);
              const double after = flock.Cost();
              EXPECT_LT(after, before);
              flock.Minimize(30);
              EXPECT_NEAR(flock.Cost(), after, 1e-2 * after);
            });
}

// Separation stays where it is held, and nothing moves the common scale.
TEST(CoupledFlock, HoldsWhatItIsToldToHold) {
  WithFlock({.count = 5, .frames = 60}, {},
            [](const internal::WindowToRefine& window, internal::CoupledFlock& flock) {
              const double usual = flock.forces[internal::kLogAlphaS];
              const double speed = window.state.shared[internal::kFlockLogSpeed];
              flock.HoldSeparation(0.1);
              flock.FitForces(5);
              flock.Minimize(10);
              EXPECT_NEAR(flock.forces[internal::kLogAlphaS] / usual, 0.1, 0.01);
              EXPECT_NEAR(window.state.shared[internal::kFlockLogSpeed], speed, 0.01);
              flock.HoldSeparation(1);
              EXPECT_NEAR(flock.forces[internal::kLogAlphaS] / usual, 1, 0.01);
            });
}

// After the first step, where no number of such steps would lead there; else it goes on.
TEST(CoupledFlock, GivesUpWhatIsHopeless) {
  WithFlock({.count = 5, .frames = 60}, {},
            [](const internal::WindowToRefine&, internal::CoupledFlock& flock) {
              const double start = flock.Cost();
              EXPECT_FALSE(flock.Minimize(20, {.enough = 0, .hopeless = -1e9}));
              const double once = flock.Cost();
              EXPECT_LT(once, start);
              flock.Minimize(20, {.enough = 0, .hopeless = once});
              EXPECT_LT(flock.Cost(), once - 1);
            });
}

// As probable, but for little, as what the batch solution gives, or more so.
TEST(ForceSearch, IsAtLeastAsProbableAsFromTheBatchSolutionAlone) {
  const FlockSpec spec{.count = 5, .frames = 90};
  WithWindow(spec, {}, [&](const internal::WindowToRefine& window) {
    const auto found = internal::FollowForces({}, window.state);
    ASSERT_EQ(found.open.size(), window.state.birds.size());
    for (const double sd : found.open) {
      EXPECT_GT(sd, 0);
      EXPECT_LT(sd, 0.5);
    }
    internal::CoupledFlock fitted(window.state.model, &window.state.birds, &window.state.shared);
    fitted.noise = {window.state.model.spreads.acceleration.sd, 0.7};
    fitted.FitForces(12);
    for (int round = 0; round < 3; ++round) {
      fitted.Minimize(6);
      fitted.Relinearize();
      fitted.noise.sd = fitted.EstimateNoise().value();
    }
    double accelerations = 0;
    for (const internal::Bird& bird : window.state.birds) accelerations += 3.0 * bird.knots;
    const double improbable = fitted.Cost() + accelerations * std::log(fitted.noise.sd);
    EXPECT_LT(found.improbable, improbable + 0.02 * accelerations);
  });
}

// Where paths and forces come to rest from a flock's, with the noise of a solution.
double CostOfRest(const internal::BatchModel& model, const internal::FollowedFlock& solution,
                  std::vector<internal::Bird> birds, Eigen::VectorXd shared) {
  internal::CoupledFlock flock(model, &birds, &shared, solution.scale);
  flock.noise = solution.noise;
  flock.FitForces(12);
  for (int round = 0; round < 3; ++round) {
    flock.Minimize(20);
    flock.Relinearize();
  }
  return flock.Cost();
}

// Puts animals 1 and 4 farther away and nearer.
internal::BatchState WithAnimalsOff(double off, const internal::BatchState& batch) {
  internal::BatchState start{batch.model, batch.birds, batch.shared};
  for (const std::size_t i : {1, 4}) {
    for (std::size_t k = 2; k < start.birds[i].path.size(); k += 3) {
      start.birds[i].path[k] += i == 1 ? off : -off;
    }
  }
  return start;
}

// As probable, but for little, as what the batch solution leads to with the same noise; more so
// where that has animals in wrong places.
TEST(ForceSearch, LeadsOutOfWrongPlaces) {
  const FlockSpec spec{.count = 8, .frames = 90};
  double gain = 0;
  WithWindow(spec, {}, [&](const internal::WindowToRefine& window) {
    for (const double off : {0.0, 0.2, 0.4}) {
      const internal::BatchState start = WithAnimalsOff(off, window.state);
      const auto found = internal::FollowForces({}, start);
      const double rest = CostOfRest(start.model, found, found.birds, found.shared);
      const double without = CostOfRest(start.model, found, start.birds, start.shared);
      EXPECT_LT(rest, without + (off > 0 ? 0 : 3));
      gain += without - rest;
    }
  });
  EXPECT_GT(gain, 15);
}

// Two starts of a few animals, one of many; each drawn together first.
TEST(ForceSearch, FewAndManyAreFoundWithoutSizesToo) {
  for (const FlockSpec& spec :
       {FlockSpec{.count = 6, .frames = 60}, FlockSpec{.count = 32, .frames = 20}}) {
    WithWindow(spec, {}, [&](const internal::WindowToRefine& window) {
      internal::BatchState start = WithAnimalsOff(0.3, window.state);
      start.model.use_size = false;
      const auto found = internal::FollowForces({}, start);
      ASSERT_EQ(found.open.size(), start.birds.size());
      for (const double sd : found.open) {
        EXPECT_GT(sd, 0);
        EXPECT_LT(sd, 1);
      }
      const double rest = CostOfRest(start.model, found, found.birds, found.shared);
      const double without = CostOfRest(start.model, found, start.birds, start.shared);
      EXPECT_LT(rest, without);
    });
  }
}

// A sd for every sighting; more noise leaves depths less certain.
TEST(CoupledFlock, ItsDepthsAreAsCertainAsItsNoiseLetsThemBe) {
  WithFlock({.count = 5, .frames = 90}, {},
            [](const internal::WindowToRefine& window, internal::CoupledFlock& flock) {
              flock.noise.sd = 1;
              const auto calm = flock.Depths();
              flock.noise.sd = 4;
              const auto noisy = flock.Depths();
              ASSERT_EQ(calm.at.size(), window.state.birds.size());
              ASSERT_EQ(noisy.at.size(), window.state.birds.size());
              for (std::size_t i = 0; i < calm.at.size(); ++i) {
                ASSERT_EQ(calm.at[i].size(), window.state.birds[i].places.size());
                ASSERT_EQ(noisy.at[i].size(), calm.at[i].size());
                for (std::size_t k = 0; k < calm.at[i].size(); ++k) {
                  EXPECT_GT(calm.at[i][k], 0);
                  EXPECT_LT(calm.at[i][k], noisy.at[i][k]);
                }
              }
              EXPECT_GT(calm.mean, 0);
            });
}

std::map<std::pair<Id, int>, double> Depths(const BatchResult& result, const Segments& segments) {
  std::map<std::pair<Id, int>, double> depths;
  for (std::size_t i = 0; i < segments.segments.size(); ++i) {
    for (std::size_t k = 0; k < segments.segments[i].sightings.size(); ++k) {
      depths[{segments.segments[i].id, segments.segments[i].sightings[k].frame}] =
          result.paths[i][k].position_in_cam.z;
    }
  }
  return depths;
}

TEST(Dynamics, GivesTheSameAtAnyNumberOfThreadsAndAlwaysADepth) {
  const FlockSpec spec{.count = 6, .frames = 90};
  const Segments segments = Seen(spec);
  const DynamicsOptions options{.hidden_time = 0.8, .rounds = 2};
  const auto one = Depths(SolveDynamics(options, {}, Known(spec), segments, kFps, 1, {}), segments);
  const auto two = Depths(SolveDynamics(options, {}, Known(spec), segments, kFps, 2, {}), segments);
  EXPECT_EQ(one, two);
  for (const auto& [row, depth] : one) {
    EXPECT_TRUE(std::isfinite(depth) && depth > 0) << row.first << " " << row.second;
  }
}

// Animals on circles of their own hear nobody: what is kept must not be worse, and batch is kept
// to the digit where forces do not help.
TEST(Dynamics, LeavesBatchAloneWhereForcesAreNotKept) {
  const FlockSpec spec{.count = 6, .frames = 120};
  const Segments segments = Seen(spec);
  const BatchResult dynamics = SolveDynamics({.rounds = 1}, {}, Known(spec), segments, kFps, 1, {});
  EXPECT_EQ(dynamics.report.dynamics.windows, 1);
  EXPECT_GT(dynamics.report.dynamics.hidden, 0.3 * segments.rows);  // of .2 in one fold
  if (dynamics.report.dynamics.kept == 0) {
    const BatchResult batch = SolveBatch({}, Known(spec), segments, kFps, 1, {});
    for (std::size_t i = 0; i < batch.paths.size(); ++i) {
      EXPECT_EQ(batch.paths[i].back().position_in_cam.z,
                dynamics.paths[i].back().position_in_cam.z);
    }
  } else {
    EXPECT_LT(dynamics.report.dynamics.dynamics_error, dynamics.report.dynamics.batch_error);
  }
}

TEST(Dynamics, TellsOfProgressWhileForcesAreFound) {
  const FlockSpec spec{.count = 6, .frames = 90};
  const Segments segments = Seen(spec);
  const auto steps = [](std::set<std::int64_t>* done) {
    return [done](std::int64_t now, std::int64_t total) {
      EXPECT_LE(now, total);
      if (!done->empty()) {
        EXPECT_GE(now, *done->rbegin());
      }
      done->insert(now);
    };
  };
  std::set<std::int64_t> batch, dynamics;
  SolveBatch({}, Known(spec), segments, kFps, 1, steps(&batch));
  SolveDynamics({.hidden_time = 0.8}, {}, Known(spec), segments, kFps, 1, steps(&dynamics));
  EXPECT_GT(dynamics.size(), 3 * batch.size());
}

TEST(Dynamics, ShortTracksAreLeftToBatch) {
  const FlockSpec spec{.count = 3, .frames = 6};
  const Segments segments = Seen(spec);
  const BatchResult result = SolveDynamics({}, {}, Known(spec), segments, kFps, 1, {});
  EXPECT_EQ(result.report.dynamics.windows, 0);
  EXPECT_EQ(result.paths.size(), segments.segments.size());
}

}  // namespace
}  // namespace flocklift
