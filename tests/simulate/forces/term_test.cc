// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/term.h"

#include <gtest/gtest.h>

#include "simulate/forces/alignment.h"
#include "simulate/forces/attraction.h"
#include "simulate/forces/boundary.h"
#include "simulate/forces/cohesion.h"
#include "simulate/forces/flee.h"
#include "simulate/forces/lin.h"
#include "simulate/forces/linear.h"
#include "simulate/forces/opensteer.h"
#include "simulate/forces/separation.h"
#include "simulate/forces/speed.h"
#include "simulate/forces/zones.h"
#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

template <typename Term>
concept PairTermOfEveryScalar =
    PairTerm<Term, float> && PairTerm<Term, double> && PairTerm<Term, Pack> && PairTerm<Term, Jet>;
template <typename Term>
concept AgentTermOfEveryScalar = AgentTerm<Term, float> && AgentTerm<Term, double> &&
    AgentTerm<Term, Pack> && AgentTerm<Term, Jet>;

static_assert(PairTermOfEveryScalar<Separation>);
static_assert(PairTermOfEveryScalar<Cohesion>);
static_assert(PairTermOfEveryScalar<Alignment>);
static_assert(PairTermOfEveryScalar<Flee>);
static_assert(PairTermOfEveryScalar<LinSeparation>);
static_assert(PairTermOfEveryScalar<LinCohesion>);
static_assert(PairTermOfEveryScalar<LinearCohesion>);
static_assert(PairTermOfEveryScalar<LinearAlignment>);
static_assert(PairTermOfEveryScalar<RepulsionZone>);
static_assert(PairTermOfEveryScalar<AlignmentZone>);
static_assert(PairTermOfEveryScalar<AttractionZone>);
static_assert(PairTermOfEveryScalar<SteerSeparation>);
static_assert(PairTermOfEveryScalar<SteerAlignment>);
static_assert(PairTermOfEveryScalar<SteerCohesion>);
static_assert(AgentTermOfEveryScalar<Boundary>);
static_assert(AgentTermOfEveryScalar<CruiseSpeed>);
static_assert(AgentTermOfEveryScalar<Attraction>);

struct MeanOf {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return Mean(Weighted<T>{{in[0], in[1], in[2]}, in[3]});
  }
};

TEST(Mean, CountsDivideAsPublished) {
  for (const double count : {1.0, 2.0, 7.0}) {
    EXPECT_EQ(Evaluate<double>(MeanOf{}, std::array{3.0, -1.0, 0.5, count}),
              (Vec3d{3 / count, -1 / count, 0.5 / count}));
  }
}

TEST(Mean, NobodyIsZero) {
  EXPECT_EQ(Evaluate<double>(MeanOf{}, std::array{0.0, 0.0, 0.0, 0.0}), (Vec3d{}));
}

// One neighbour of weight w at x: 2 w x / (1 + w^2), which fades with w and meets x at w = 1.
TEST(Mean, FadesWithTheLastNeighbour) {
  EXPECT_DOUBLE_EQ(Evaluate<double>(MeanOf{}, std::array{0.5 * 4, 0.0, 0.0, 0.5}).x, 3.2);
  EXPECT_LT(Evaluate<double>(MeanOf{}, std::array{1e-6 * 4, 0.0, 0.0, 1e-6}).x, 1e-5);
  EXPECT_NEAR(Evaluate<double>(MeanOf{}, std::array{0.999 * 4, 0.0, 0.0, 0.999}).x, 4, 1e-5);
}

TEST(Mean, ScalarsAgreeAndGradient) {
  for (const double weight : {0.25, 0.8, 1.5, 12.0}) {
    ExpectScalarsAgree(MeanOf{}, std::array{3.0, -1.0, 0.5, weight});
    ExpectGradientMatches(MeanOf{}, std::array{3.0, -1.0, 0.5, weight});
  }
}

}  // namespace
}  // namespace flocklift
