// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/forces/zones.h"

#include <gtest/gtest.h>

#include "simulate/core/rigid3.h"
#include "tests/simulate/forces/scalars.h"
#include "tests/support/gradient_check.h"

namespace flocklift {
namespace {

// The whole force: the sum of the three zones. in: three gains, three radii, taper, then dx and dv
// of two neighbours.
struct TwoNeighbours {
  template <typename T>
  Vec3<T> operator()(const T* in) const {
    return Of<RepulsionZone>(in, 0) + Of<AlignmentZone>(in, 1) + Of<AttractionZone>(in, 2);
  }
  template <typename Term, typename T>
  static Vec3<T> Of(const T* in, int zone) {
    const typename Term::template Params<T> p{in[zone], in[3], in[4], in[5], in[6]};
    Weighted<T> sum;
    for (const T* n = in + 7; n != in + 19; n += 6) {
      sum += Term::Pair(p, Vec3<T>{n[0], n[1], n[2]}, Vec3<T>{n[3], n[4], n[5]});
    }
    return Term::Finish(p, sum);
  }
};
using Inputs = std::array<double, 19>;

constexpr Inputs With(const Vec3d& a, const Vec3d& u, const Vec3d& b, const Vec3d& v,
                      double taper = 0) {
  return {0.2, 3, 13, 1, 2, 4, taper, a.x, a.y, a.z, u.x, u.y, u.z, b.x, b.y, b.z, v.x, v.y, v.z};
}
Vec3d Force(const Inputs& in) { return Evaluate<double>(TwoNeighbours{}, in); }

TEST(Zones, ByHand) {
  const Vec3d still{}, far{5, 0, 0}, along{0, 0, 2};
  // Pushed away with 0.2, along nobody's velocity.
  ExpectNear(Force(With({0.3, 0.4, 0}, along, far, along)), {-0.12, -0.16, 0}, 1e-9);
  // Turned towards the other's velocity with 3, wherever it is.
  ExpectNear(Force(With({0, 1.5, 0}, along, far, along)), {0, 0, 3}, 1e-9);
  ExpectNear(Force(With({0, 1.5, 0}, still, far, along)), {}, 1e-9);
  // Pulled with 13; nobody beyond.
  ExpectNear(Force(With({0, -3, 0}, along, far, along)), {0, -13, 0}, 1e-9);
  ExpectNear(Force(With(far, along, far, along)), {}, 1e-9);
  // The mean is over the zone, not over all: two zones add, two of one zone halve.
  ExpectNear(Force(With({0, -3, 0}, along, {0.5, 0, 0}, along)), {-0.2, -13, 0}, 1e-9);
  ExpectNear(Force(With({0, -3, 0}, along, {3, 0, 0}, along)), {6.5, -6.5, 0}, 1e-9);
}

TEST(Zones, TheRimsBelongWhereTheyArePublished) {
  const Vec3d along{0, 0, 2}, far{5, 0, 0};
  ExpectNear(Force(With({1, 0, 0}, along, far, along)), {0, 0, 3}, 1e-9);   // R_rep <= r
  ExpectNear(Force(With({2, 0, 0}, along, far, along)), {13, 0, 0}, 1e-9);  // R_ali <= r
  ExpectNear(Force(With({4, 0, 0}, along, far, along)), {13, 0, 0}, 1e-9);  // r <= R_att
}

// The reading of the square: 1 - S^2 is 3/4 at S = 1/2, where (1 - S)^2 would be 1/4.
TEST(Zones, TheSquareBelongsToS) {
  const ZoneParams<double> p{1, 1, 2, 4, 0.5};
  const double r = 2 + 0;  // W(r_ali) = 1/2
  const Vec3d way = ZoneDirection(p, Vec3d{r, 0, 0}, Vec3d{0, 5, 0});
  ExpectNear(way, {0.5, 0.75, 0}, 1e-9);
}

TEST(Zones, EveryNeighbourInSightIsInOneZone) {
  for (const double taper : {0.0, 0.4}) {
    const ZoneParams<double> p{1, 1, 2, 4, taper};
    for (double r = 0.01; r < 5; r += 0.01) {
      const Vec3d dx{0, r, 0}, none{};
      const double a = RepulsionZone::Pair(p, dx, none).weight;
      const double b = AlignmentZone::Pair(p, dx, none).weight;
      const double c = AttractionZone::Pair(p, dx, none).weight;
      EXPECT_GE(std::min({a, b, c}), 0) << r;
      EXPECT_NEAR(a + b + c, TaperWindow(r * r, 4.0, taper), 1e-12) << r;
    }
  }
}

TEST(Zones, HardEdgeIsTaperZero) {
  const ZoneParams<double, HardEdge> hard{1, 1, 2, 4, {}};
  const ZoneParams<double> soft{1, 1, 2, 4, 0};
  for (const double r : {0.0, 0.5, 0.999, 1.001, 1.7, 2.0, 3.0, 3.999, 4.001, 9.0}) {
    const Vec3d dx{0, 0, r}, dv{1, -2, 0.5};
    ExpectNear(ZoneDirection(hard, dx, dv), ZoneDirection(soft, dx, dv), 1e-15);
    EXPECT_EQ(RepulsionZone::Pair(hard, dx, dv).weight, RepulsionZone::Pair(soft, dx, dv).weight);
    EXPECT_EQ(AlignmentZone::Pair(hard, dx, dv).weight, AlignmentZone::Pair(soft, dx, dv).weight);
    EXPECT_EQ(AttractionZone::Pair(hard, dx, dv).weight, AttractionZone::Pair(soft, dx, dv).weight);
  }
}

// The sign of u: with v_j - v_i two animals end up with one velocity; with v_i - v_j they part.
TEST(Zones, TwoAnimalsAlign) {
  const ZoneParams<double> p{1, 0.1, 50, 60, 0};
  Vec3d v[2] = {{1, 0, 0}, {0, 1, 0.5}};
  const Vec3d dx{3, 0, 0};
  for (int step = 0; step < 300; ++step) {
    const Vec3d a = One<AlignmentZone>(p, dx, v[1] - v[0]);
    const Vec3d b = One<AlignmentZone>(p, -dx, v[0] - v[1]);
    v[0] += 0.01 * a;
    v[1] += 0.01 * b;
  }
  EXPECT_LT(Norm(v[1] - v[0]), 0.03);
  ExpectNear(0.5 * (v[0] + v[1]), {0.5, 0.5, 0.25}, 1e-9);  // momentum is kept
}

TEST(Zones, AClosePairParts) {
  Vec3d x[2] = {{0, 0, 0}, {0.05, 0.02, 0}}, v[2];
  const ZoneParams<double> p{0.2, 0.3, 10, 30, 0};
  double distance = Norm(x[1] - x[0]);
  for (int step = 0; step < 100 && distance < 0.29; ++step) {
    const Vec3d push = One<RepulsionZone>(p, x[1] - x[0], v[1] - v[0]);
    v[0] += 0.05 * push;
    v[1] -= 0.05 * push;
    for (int k = 0; k < 2; ++k) x[k] += 0.05 * v[k];
    EXPECT_GT(Norm(x[1] - x[0]), distance);
    distance = Norm(x[1] - x[0]);
  }
  EXPECT_GT(distance, 0.29);
}

TEST(Zones, ScalarsAgreeAndGradient) {
  const Vec3d u{0.5, -1, 2}, v{-1, 0.3, 0.1};
  for (const double taper : {0.0, 0.8}) {
    ExpectScalarsAgree(TwoNeighbours{}, With({0.5, 0.3, -0.2}, u, {1, 1, 0.4}, v, taper));
    ExpectScalarsAgree(TwoNeighbours{}, With({0.5, 3.1, -0.2}, u, {1.2, 1.5, 0.4}, v, taper));
  }
  ExpectGradientMatches(TwoNeighbours{}, With({0.6, 0.6, -0.2}, u, {1, 1.5, 0.4}, v, 0.8));
  ExpectGradientMatches(TwoNeighbours{}, With({0.5, 3.8, -0.2}, u, {1, 0.5, 0.4}, v, 0.8));
}

TEST(Zones, TurnsWithTheWorld) {
  const Rotation3d turn = RotationFromQuaternion({0.5, 0.5, -0.5, 0.5});
  const Vec3d a{0.7, 0.6, -0.2}, u{0.5, -1, 2}, b{1, 1.5, 0.4}, v{-1, 0.3, 0.1};
  ExpectNear(Force(With(turn * a, turn * u, turn * b, turn * v, 0.8)),
             turn * Force(With(a, u, b, v, 0.8)), 1e-12);
}

}  // namespace
}  // namespace flocklift
