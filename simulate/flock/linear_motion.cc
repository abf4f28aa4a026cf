// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/linear_motion.h"

#include <cmath>

#include "simulate/flock/force_passes.h"
#include "simulate/flock/streams.h"
#include "simulate/forces/linear.h"

namespace flocklift {
namespace {

template <typename T>
class LinearMotion final : public Motion<T> {
 public:
  LinearMotion(const LinearParameters<double>& p, std::uint64_t seed) : p_(p), seed_(seed) {}

  void Step(const Surroundings& around, ThreadPool* /*pool*/, Herd<T>* herd) override {
    Bodies<T>& s = herd->now;
    const auto n = static_cast<double>(s.size());
    const Vec3d x_sum = SumOfPositions(s);
    Vec3d v_sum;
    for (std::size_t k = 0; k < s.size(); ++k) v_sum += ToDouble(s.Velocity(k));
    const double dt = around.dt(), diffusion = std::sqrt(2 * p_.diffusion * dt);
    for (std::size_t k = 0; k < s.size(); ++k) {
      const Vec3d x = ToDouble(s.Position(k)), v = ToDouble(s.Velocity(k));
      const Vec3d a = LinearCohesion::Finish(LinearCohesion::Params<double>{p_.cohesion},
                                             Weighted<double>{x_sum - n * x, n - 1}) +
                      LinearAlignment::Finish(LinearAlignment::Params<double>{p_.alignment},
                                              Weighted<double>{v_sum - n * v, n - 1});
      Rng rng = StreamOf(Stream::kNoise, seed_, herd->first_agent + s.agent[k], around.step);
      const Vec3d kick = diffusion * Vec3d{rng.Normal(), rng.Normal(), rng.Normal()};
      const Vec3<T> faster = Flattened(around.flat(), Cast<T>(v + dt * a + kick));
      s.Set(k, Cast<T>(x + dt * ToDouble(faster)), faster);
      herd->neighbours[k] = static_cast<T>(n - 1);
    }
  }
  void Retune(const ModelParameters& parameters) override {
    p_ = std::get<LinearParameters<double>>(parameters);
  }

 private:
  LinearParameters<double> p_;
  std::uint64_t seed_;
};

}  // namespace

template <typename T>
std::unique_ptr<Motion<T>> MakeLinearMotion(const LinearParameters<double>& parameters,
                                            const MotionContext& context) {
  RefuseForces(context, "linear", "its estimators know of no others");
  return std::make_unique<LinearMotion<T>>(parameters, context.world->seed);
}

template std::unique_ptr<Motion<float>> MakeLinearMotion(const LinearParameters<double>&,
                                                         const MotionContext&);
template std::unique_ptr<Motion<double>> MakeLinearMotion(const LinearParameters<double>&,
                                                          const MotionContext&);

}  // namespace flocklift
