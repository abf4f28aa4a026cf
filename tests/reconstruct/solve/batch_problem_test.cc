// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/batch_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "reconstruct/solve/batch_model.h"
#include "reconstruct/solve/batch_start.h"
#include "tests/reconstruct/circling_flock.h"

namespace flocklift::internal {
namespace {

// A bird of a small flock, with every kind of residual at work.
class BatchProblemTest : public testing::Test {
 protected:
  BatchProblemTest() {
    const Camera camera = WatchingCamera();
    const Tracks tracks = Observe(flock_, {}, CirclingFlock(flock_), camera);
    segments_ = MakeSegments({}, tracks, camera, flock_.fps);
    knowledge_.speed = Uncertain{10, 1};
    knowledge_.wingspan = Uncertain{0.6, 0.03};
    knowledge_.near = 40;  // most of the flock is nearer: the wall is felt
    knowledge_.far = 45;
    knowledge_.up_in_cam = camera.cam_from_world->rotation * Vec3d{0, 0, 1};
    knowledge_.anchors = {{12, 2, {1, 2, 43}, 2}};
    for (const int k : {5, 17}) {  // a second camera 20 m to the right that looks to the left
      View view;
      view.time = segments_.segments[1].sightings[static_cast<std::size_t>(k)].time + 0.01;
      view.view_from_ref = {Rotation3d::FromRows({0.8, 0, 0.6}, {0, 1, 0}, {-0.6, 0, 0.8}),
                            {-16, 0.3, 12}};
      view.ray = {0.2, -0.1};
      view.ray_sd = 0.1;
      segments_.segments[1].views.push_back(view);
    }
    const ScaleGuess guess = GuessScale(knowledge_, segments_);
    BatchOptions options;
    options.flock_turn = true;
    model_ = MakeModel(options, knowledge_, segments_, guess, std::nullopt, flock_.fps);
    bird_ = StartBird(model_, knowledge_, guess, segments_.segments[1], flock_.fps, 1);
    shared_ = StartOfShared(model_);
    for (std::size_t k = 0; k < bird_.curve.size(); ++k) {
      bird_.curve[k] = {0.3 * std::sin(0.5 * static_cast<double>(k)), -0.2, 0.4};
    }
    // Away from the start, where depths are piecewise linear, and from the joints of the losses.
    for (std::size_t k = 2; k < bird_.path.size(); k += 3) {
      bird_.path[k] += 0.02 * std::sin(0.9 * static_cast<double>(k));
    }
  }

  std::vector<double> Residuals() const {
    std::vector<double> residuals;
    ForEachRow(model_, bird_, shared_, false,
               [&](Term, const ResidualRow& row) { residuals.push_back(row.residual); });
    return residuals;
  }

  // Of rows of so many kinds of terms.
  void ExpectDerivatives(std::size_t kinds) {
    std::vector<ResidualRow> rows;
    std::set<Term> terms;
    ForEachRow(model_, bird_, shared_, true, [&](Term term, const ResidualRow& row) {
      rows.push_back(row);
      terms.insert(term);
    });
    EXPECT_EQ(terms.size(), kinds);
    const std::vector<double> residuals = Residuals();
    ASSERT_EQ(rows.size(), residuals.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      EXPECT_NEAR(rows[r].residual, residuals[r], 1e-12 * (1 + std::abs(residuals[r])));
    }

    const auto check = [&](double* unknown, const auto& derivative_of) {
      constexpr double kStep = 1e-6;
      const double value = *unknown;
      *unknown = value + kStep;
      const std::vector<double> after = Residuals();
      *unknown = value - kStep;
      const std::vector<double> before = Residuals();
      *unknown = value;
      for (std::size_t r = 0; r < rows.size(); ++r) {
        const double numeric = (after[r] - before[r]) / (2 * kStep);
        EXPECT_NEAR(derivative_of(rows[r]), numeric, 1e-4 * (1 + std::abs(numeric))) << r;
      }
    };
    for (int i = 0; i < bird_.unknowns(); ++i) {
      check(&bird_.path[static_cast<std::size_t>(i)], [i](const ResidualRow& row) {
        const int a = i - row.first;
        return a >= 0 && a < 12 ? row.path[static_cast<std::size_t>(a)] : 0.0;
      });
    }
    const auto by_border = [](int index) {
      return [index](const ResidualRow& row) {
        for (int a = 0; a < row.border_count; ++a) {
          if (row.border[static_cast<std::size_t>(a)].first == index) {
            return row.border[static_cast<std::size_t>(a)].second;
          }
        }
        return 0.0;
      };
    };
    for (int i = 0; i < kOwnUnknowns; ++i) {
      check(&bird_.own[static_cast<std::size_t>(i)], by_border(i));
    }
    for (int i = 0; i < model_.shared(); ++i) check(&shared_[i], by_border(kOwnUnknowns + i));
  }

  FlockSpec flock_{.count = 3, .frames = 40};
  Segments segments_;
  Knowledge knowledge_;
  BatchModel model_;
  Bird bird_;
  Eigen::VectorXd shared_;
};

TEST_F(BatchProblemTest, EveryDerivativeMatchesNumericDifferences) {
  // The common acceleration is the flock's, the other is of erratic flight.
  ExpectDerivatives(kTermCount - 2u);
}

TEST_F(BatchProblemTest, AlsoInErraticFlight) {
  model_.erratic = true;
  model_.spreads.along = {0.6, 0.2};
  ExpectDerivatives(kTermCount - 1u);
}

// Of the priors' gradient and matrix, at the present place.
void ExpectNumericDerivatives(const BatchModel& model, const Eigen::VectorXd& shared) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(shared.size(), shared.size());
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(shared.size());
  SharedPriors(model, shared, &matrix, &gradient);
  for (Eigen::Index i = 0; i < shared.size(); ++i) {
    Eigen::VectorXd after = shared, before = shared;
    after[i] += 1e-5;
    before[i] -= 1e-5;
    const double numeric = (SharedPriors(model, after, nullptr, nullptr) -
                            SharedPriors(model, before, nullptr, nullptr)) /
                           2e-5;
    EXPECT_NEAR(gradient[i], numeric, 1e-5 * (1 + std::abs(numeric)));
    // Quadratic: the gradient's change is the matrix.
    Eigen::MatrixXd ignored = Eigen::MatrixXd::Zero(shared.size(), shared.size());
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(shared.size());
    SharedPriors(model, after, &ignored, &moved);
    EXPECT_LT(((moved - gradient) / 1e-5 - matrix.col(i)).norm(), 1e-3 * (1 + matrix.norm()));
  }
}

TEST_F(BatchProblemTest, PriorsOfTheFlockMatchNumericDifferences) {
  shared_ += Eigen::VectorXd::LinSpaced(shared_.size(), -0.3, 0.4);
  ASSERT_GT(model_.turn.knots, 0);
  ExpectNumericDerivatives(model_, shared_);
  // What another window has found takes the place of the scalars' priors.
  Belief::Matrix root;
  root << 9, 0, 0, 0, 0, 3, 7, 0, 0, 0, -2, 1, 4, 0, 0, 1, 2, -1, 3, 0, 0, 1, 0, -1, 2;
  model_.belief = Belief{Belief::Vector(2, -0.5, -1, -2, 0.6), root * root.transpose()};
  ExpectNumericDerivatives(model_, shared_);
  shared_.head<kFlockScalars>() = model_.belief->mean;
  const double least = SharedPriors(model_, shared_, nullptr, nullptr);
  shared_[kSizeRatio] += 0.1;
  EXPECT_NEAR(SharedPriors(model_, shared_, nullptr, nullptr) - least, 0.5 * 0.01 * (9 + 49), 1e-9);
}

// A scene twice as far, twice as fast, of animals twice as large looks the same: but for the priors
// of the scale and a second camera, every residual is what it was.
TEST_F(BatchProblemTest, TheImageKnowsNoScale) {
  bird_.anchors.clear();
  bird_.view_places.clear();
  model_.log_near = model_.log_far = std::nullopt;
  const std::vector<double> before = Residuals();
  const double shift = std::log(2.0);
  for (std::size_t k = 2; k < bird_.path.size(); k += 3) bird_.path[k] += shift;
  bird_.own[kOwnLogSpeed] += shift;
  shared_[kFlockLogSpeed] += shift;
  shared_[kSizeRatio] += shift;
  shared_.segment(model_.depth.first, model_.depth.size()).array() += shift;
  const std::vector<double> after = Residuals();
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t r = 0; r < before.size(); ++r) EXPECT_NEAR(before[r], after[r], 1e-9);
}

TEST(RobustCost, ByHand) {
  EXPECT_EQ(RobustCost(Term::kReprojection, 2), 2);
  EXPECT_EQ(RobustCost(Term::kReprojection, -5), 3 * (5 - 1.5));
  EXPECT_EQ(RobustWeight(Term::kReprojection, -6), 0.5);
  EXPECT_EQ(RobustCost(Term::kSpeedSpread, 10), 50);
}

}  // namespace
}  // namespace flocklift::internal
