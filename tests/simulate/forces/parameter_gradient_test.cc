// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What an inversion asks of every force term: the derivative of the acceleration with respect to
// every parameter, radii and tapers included, by ceres::Jet and by central differences, at random
// neighbours and parameters. Draws at a joint of a window, where the two differences from the left
// and from the right part, are left out; the rest must agree to 1e-6.

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "simulate/core/rng.h"
#include "simulate/forces/alignment.h"
#include "simulate/forces/attraction.h"
#include "simulate/forces/boundary.h"
#include "simulate/forces/cohesion.h"
#include "simulate/forces/drag.h"
#include "simulate/forces/flee.h"
#include "simulate/forces/level.h"
#include "simulate/forces/lin.h"
#include "simulate/forces/linear.h"
#include "simulate/forces/obstacle.h"
#include "simulate/forces/opensteer.h"
#include "simulate/forces/separation.h"
#include "simulate/forces/shape_distance.h"
#include "simulate/forces/shape_force.h"
#include "simulate/forces/speed.h"
#include "simulate/forces/zones.h"

namespace flocklift {
namespace {

constexpr int kDraws = 40;

// A moment of an animal among others: its own x and v, and dx, dv of six neighbours.
struct Draw {
  Vec3d x, v;
  std::array<Vec3d, 6> dx, dv;
};

template <typename T>
Vec3<T> As(const Vec3d& v) {
  return {T(v.x), T(v.y), T(v.z)};
}

template <typename Term, typename Params, typename T>
Vec3<T> OfPairs(const Params& p, const Draw& draw) {
  Weighted<T> sum;
  for (std::size_t k = 0; k < draw.dx.size(); ++k) {
    sum += Term::Pair(p, As<T>(draw.dx[k]), As<T>(draw.dv[k]));
  }
  return Term::Finish(p, sum);
}

// `f(const T* parameters, draw)` is an acceleration; parameters are drawn around `middle`, by a
// tenth of each.
template <int kParameters, typename Function>
void ExpectGradients(const char* name, const std::array<double, kParameters>& middle,
                     const Function& f) {
  using Jet = ceres::Jet<double, kParameters>;
  int compared = 0, felt = 0;
  for (int number = 0; number < kDraws; ++number) {
    Rng rng(77, static_cast<std::uint64_t>(number));
    const auto normal = [&rng](double sd) {
      return sd * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
    };
    Draw draw{.x = normal(2), .v = normal(2), .dx = {}, .dv = {}};
    for (Vec3d& dx : draw.dx) dx = normal(1.5);
    for (Vec3d& dv : draw.dv) dv = normal(1);
    std::array<double, kParameters> p;
    std::array<Jet, kParameters> jets;
    for (std::size_t k = 0; k < kParameters; ++k) {
      p[k] = middle[k] * (1 + 0.1 * (2 * rng.Uniform() - 1));
      jets[k] = Jet(p[k], static_cast<int>(k));
    }
    const Vec3<Jet> a = f(jets.data(), draw);
    const Vec3d value = f(p.data(), draw);
    for (std::size_t k = 0; k < kParameters; ++k) {
      const auto at = [&](double steps) {
        std::array<double, kParameters> moved = p;
        moved[k] += steps * 1e-5 * (1 + std::abs(p[k]));
        return f(moved.data(), draw);
      };
      const double step = 1e-5 * (1 + std::abs(p[k]));
      const Vec3d left = (value - at(-1)) / step, right = (at(1) - value) / step;
      const Vec3d slope = (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * step);
      const double scale = 1 + Norm(slope);
      const auto column = static_cast<Eigen::Index>(k);
      const Vec3d jet{a.x.v[column], a.y.v[column], a.z.v[column]};
      // Across a joint the second derivative jumps: the two halves differ in it.
      const Vec3d bend_left = at(0) - 2.0 * at(-1) + at(-2),
                  bend_right = at(2) - 2.0 * at(1) + at(0);
      const bool joint = Norm(right - left) > 1e-9 * scale &&
                         Norm(bend_right - bend_left) > 1e-2 * (Norm(bend_left) + Norm(bend_right));
      if (joint && Norm(jet - slope) > 1e-6 * scale) continue;
      EXPECT_LT(Norm(jet - slope), 1e-6 * scale) << name << ", parameter " << k;
      ++compared;
      felt += Norm(jet) > 1e-9 ? 1 : 0;
    }
  }
  EXPECT_GT(compared, kDraws * kParameters * 3 / 4) << name;
  EXPECT_GT(felt, kDraws * kParameters / 4) << name << ": the draws never act";
}

template <typename Term, int kParameters>
void ExpectPairGradients(const char* name, const std::array<double, kParameters>& middle) {
  ExpectGradients<kParameters>(name, middle, []<typename T>(const T* p, const Draw& draw) {
    using Params = typename Term::template Params<T>;
    if constexpr (kParameters == 1) {
      return OfPairs<Term, Params, T>(Params{p[0]}, draw);
    } else if constexpr (kParameters == 3) {
      return OfPairs<Term, Params, T>(Params{p[0], p[1], p[2]}, draw);
    } else if constexpr (kParameters == 4) {
      return OfPairs<Term, Params, T>(Params{p[0], p[1], p[2], p[3]}, draw);
    } else {
      return OfPairs<Term, Params, T>(Params{p[0], p[1], p[2], p[3], p[4]}, draw);
    }
  });
}

TEST(ParameterGradient, OfEveryPairTerm) {
  ExpectPairGradients<Separation, 3>("separation", {2, 2.5, 1.5});
  ExpectPairGradients<Cohesion, 3>("cohesion", {0.3, 2.5, 1.5});
  ExpectPairGradients<Alignment, 3>("alignment", {0.7, 2.5, 1.5});
  ExpectPairGradients<Flee, 3>("flee", {3, 2.5, 1.5});
  ExpectPairGradients<LinSeparation, 3>("lin separation", {2.5, 0.7, 1.5});
  ExpectPairGradients<LinearCohesion, 1>("linear cohesion", {0.05});
  ExpectPairGradients<LinearAlignment, 1>("linear alignment", {0.2});
  ExpectPairGradients<ShapeForce, 4>("shape force", {1, 2.5, 1.2, 1.5});
  ExpectPairGradients<ZoneForce<Zone::kRepulsion>, 5>("repulsion", {0.2, 1.2, 2.4, 4, 1.1});
  ExpectPairGradients<ZoneForce<Zone::kAlignment>, 5>("zone alignment", {3, 1.2, 2.4, 4, 1.1});
  ExpectPairGradients<ZoneForce<Zone::kAttraction>, 5>("attraction", {13, 1.2, 2.4, 4, 1.1});
}

template <typename Term>
void ExpectSteerGradients(const char* name) {
  ExpectGradients<5>(name, {8, 2.5, 0.8, 0.9, -0.2}, []<typename T>(const T* p, const Draw& draw) {
    const ViewCone<T> view{SoftUnit(As<T>(draw.v)), p[4], p[3]};
    return OfPairs<Term, SteerParams<T>, T>(SteerParams<T>{p[0], p[1], p[2], p[3], view}, draw);
  });
}

TEST(ParameterGradient, OfTheSteeringRules) {
  ExpectSteerGradients<SteerSeparation>("steer separation");
  ExpectSteerGradients<SteerAlignment>("steer alignment");
  ExpectSteerGradients<SteerCohesion>("steer cohesion");
}

TEST(ParameterGradient, OfEveryAgentTerm) {
  ExpectGradients<5>("attraction", {0.6, 1, -2, 0.5, 3},
                     []<typename T>(const T* p, const Draw& draw) {
                       const Attraction::Params<T> params{p[0], {p[1], p[2], p[3]}, p[4]};
                       return Attraction::At(params, As<T>(draw.x), As<T>(draw.v));
                     });
  ExpectGradients<8>(
      "boundary", {8, -1.5, -1.2, -1, 1, 1.3, 1.6, 2.5},
      []<typename T>(const T* p, const Draw& draw) {
        const Boundary::Params<T> params{p[0], {p[1], p[2], p[3]}, {p[4], p[5], p[6]}, p[7]};
        return Boundary::At(params, As<T>(draw.x), As<T>(draw.v));
      });
  ExpectGradients<4>("drag", {0.4, 2, -1, 0.5}, []<typename T>(const T* p, const Draw& draw) {
    const Drag::Params<T> params{p[0], {p[1], p[2], p[3]}};
    return Drag::At(params, As<T>(draw.x), As<T>(draw.v));
  });
  ExpectGradients<1>("level", {0.5}, []<typename T>(const T* p, const Draw& draw) {
    return Level::At(Level::Params<T>{p[0]}, As<T>(draw.x), As<T>(draw.v));
  });
  ExpectGradients<2>("cruise", {1.2, 3}, []<typename T>(const T* p, const Draw& draw) {
    return CruiseSpeed::At(CruiseSpeed::Params<T>{p[0], p[1]}, As<T>(draw.x), As<T>(draw.v));
  });
  ExpectGradients<3>("speed limit", {2.5, 4, 1}, []<typename T>(const T* p, const Draw& draw) {
    return SpeedLimit::Limit(SpeedLimit::Params<T>{p[0], p[1], p[2]}, As<T>(draw.v));
  });
  ExpectGradients<5>("shape distance", {4, 3.5, 1, -1, 0.5},
                     []<typename T>(const T* p, const Draw& draw) {
                       const ShapeDistance::Params<T> params{p[0], p[1], {p[2], p[3], p[4]}};
                       return ShapeDistance::At(params, As<T>(draw.x), As<T>(draw.v));
                     });
  ExpectGradients<1>("obstacle", {3}, []<typename T>(const T* p, const Draw& draw) {
    const double distance = 0.5 * Norm(draw.x);
    return ObstacleAvoidance::Turn(ObstacleAvoidance::Params<T>{p[0]}, T(distance),
                                   As<T>(Normalized(draw.x)), As<T>(draw.v));
  });
  ExpectGradients<1>("lin target", {0.6}, []<typename T>(const T* p, const Draw& draw) {
    return LinTarget(As<T>(draw.x), p[0], As<T>(draw.dx[0]), As<T>(draw.dx[1]));
  });
}

}  // namespace
}  // namespace flocklift
