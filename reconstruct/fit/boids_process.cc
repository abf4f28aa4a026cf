// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/boids_process.h"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

namespace flocklift {
namespace {

using Jet = ceres::Jet<double, 6>;  // by the animal's own position and velocity

// Sets the fields that theta names.
struct Assign {
  const std::vector<std::string>& free;
  std::span<const double> theta;

  void operator()(std::string_view name, double& value, Range range, std::string_view /*unit*/,
                  std::string_view /*help*/) const {
    const auto found = std::find(free.begin(), free.end(), name);
    if (found == free.end()) return;
    value = theta[static_cast<std::size_t>(found - free.begin())];
    const bool is_weight = name.starts_with("alpha") || name == "level";
    if (!is_weight) value = std::clamp(value, range.low, range.high);
  }
  void operator()(std::string_view, const Choice&, Range, std::string_view,
                  std::string_view) const {}
};

template <typename T>
Vec3<T> CastVector(const Vec3d& v) {
  return {T(v.x), T(v.y), T(v.z)};
}

double Value(double x) { return x; }
double Value(const Jet& x) { return x.a; }

class BoidsProcess {
 public:
  BoidsProcess(const BoidsParameters<double>& given, const std::optional<Region>& walls,
               std::vector<std::string> free)
      : given_(given), walls_(walls), free_(std::move(free)) {}

  BoidsParameters<double> With(std::span<const double> theta) const {
    BoidsParameters<double> p = given_;
    Assign assign{free_, theta};
    Describe(assign, p);
    return InSeconds(p);
  }

  void operator()(std::span<const double> theta, std::span<const Vec3d> x, std::span<const Vec3d> v,
                  std::span<Vec3d> a, std::span<OwnSlope> slopes) const {
    const BoidsParameters<double> p = With(theta);
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (slopes.empty()) {
        a[i] = Acceleration<double>(p, i, x[i], v[i], x, v);
        continue;
      }
      const Vec3<Jet> own_x{{x[i].x, 0}, {x[i].y, 1}, {x[i].z, 2}};
      const Vec3<Jet> own_v{{v[i].x, 3}, {v[i].y, 4}, {v[i].z, 5}};
      const Vec3<Jet> jet = Acceleration<Jet>(p, i, own_x, own_v, x, v);
      a[i] = {jet.x.a, jet.y.a, jet.z.a};
      const Jet* const axes[] = {&jet.x, &jet.y, &jet.z};
      for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
          const auto k = static_cast<Eigen::Index>(column);
          slopes[i].position[3 * row + column] = axes[row]->v[k];
          slopes[i].velocity[3 * row + column] = axes[row]->v[k + 3];
        }
      }
    }
  }

 private:
  template <typename T>
  Vec3<T> Acceleration(const BoidsParameters<double>& p, std::size_t i, const Vec3<T>& own_x,
                       const Vec3<T>& own_v, std::span<const Vec3d> x,
                       std::span<const Vec3d> v) const {
    Vec3<T> a = Level::At(Level::Params<T>{T(p.level)}, own_x, own_v);
    if (walls_) {
      a += Boundary::At(Boundary::Params<T>{T(p.alpha_b), CastVector<T>(walls_->low),
                                            CastVector<T>(walls_->high), T(p.wall_taper)},
                        own_x, own_v);
    }
    if (p.blind > 0) {
      const ViewCone<T> view{{}, T(SightCosine(p.blind)), T(p.blind_taper)};
      return a + Pairs(MakeBoidsPairs<T>(p, T(p.taper), view).For(own_v), Reach(p), i, own_x, own_v,
                       x, v);
    }
    return a + Pairs(MakeBoidsPairs<T>(p, T(p.taper)), Reach(p), i, own_x, own_v, x, v);
  }

  template <typename Rules, typename T>
  static Vec3<T> Pairs(const Rules& rules, double reach, std::size_t i, const Vec3<T>& own_x,
                       const Vec3<T>& own_v, std::span<const Vec3d> x, std::span<const Vec3d> v) {
    typename Rules::Sums sums;
    const Vec3d at{Value(own_x.x), Value(own_x.y), Value(own_x.z)};
    for (std::size_t j = 0; j < x.size(); ++j) {
      if (j == i || SquaredNorm(x[j] - at) > reach * reach) continue;
      sums += rules.Pair(CastVector<T>(x[j]) - own_x, CastVector<T>(v[j]) - own_v);
    }
    return rules.Finish(sums);
  }

  BoidsParameters<double> given_;
  std::optional<Region> walls_;
  std::vector<std::string> free_;
};

}  // namespace

std::vector<std::string> SmoothBoidsParameters(const BoidsParameters<double>& given) {
  const bool white = static_cast<NoiseKind>(given.noise_kind.index) == NoiseKind::kWhite ||
                     static_cast<NoiseKind>(given.noise_kind.index) == NoiseKind::kNone;
  const bool forgets = given.noise == 0 || (white && given.noise_time == 0);
  if (!(given.taper > 0) || !(given.wall_taper > 0) || given.nearest > 0 || given.cruise > 0 ||
      !forgets || (given.blind > 0 && !(given.blind_taper > 0))) {
    return {};
  }
  std::vector<std::string> names = {"alpha_s", "alpha_c", "alpha_a", "alpha_b",    "level", "d_s",
                                    "d_v",     "s_min",   "s_max",   "wall_taper", "taper"};
  if (given.blind > 0) names.insert(names.end(), {"blind", "blind_taper"});
  return names;
}

void SetBoidsProcess(const BoidsParameters<double>& given, const std::optional<Region>& walls,
                     ProcessModel* process) {
  const BoidsProcess boids(given, walls, process->free);
  process->evaluate = boids;
  process->speed_range = [boids](std::span<const double> theta) {
    const BoidsParameters<double> p = boids.With(theta);
    return SpeedRange{p.s_min, p.s_max};
  };
}

}  // namespace flocklift
