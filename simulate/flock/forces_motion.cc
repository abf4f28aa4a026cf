// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/forces_motion.h"

#include <algorithm>

#include "simulate/flock/force_passes.h"
#include "simulate/flock/integrator.h"

namespace flocklift {
namespace {

template <typename T>
class ForcesMotion final : public Motion<T> {
 public:
  ForcesMotion(const ForcesParameters& p, const MotionContext& context, const Herd<T>& herd)
      : p_(p), forces_(context, herd.size()) {}

  void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    herd->SortBy(forces_.Reach(), pool);
    for (std::vector<T>* column : {&herd->ax, &herd->ay, &herd->az, &herd->neighbours}) {
      std::fill(column->begin(), column->end(), T(0));
    }
    forces_.Add(around, pool, herd);
    const SpeedLimit::Params<T> limit{static_cast<T>(p_.s_min), static_cast<T>(p_.s_max), T(0)};
    ForEachAnimal(*herd, pool, [&](std::size_t k) {
      Vec3<T> x = herd->now.Position(k), v = herd->now.Velocity(k);
      Advance(herd->Acceleration(k), static_cast<T>(around.dt()), limit, &x, &v);
      herd->now.Set(k, x, v);
    });
  }
  void Retune(const ModelParameters& parameters) override {
    p_ = std::get<ForcesParameters>(parameters);
  }
  void Save(StateWriter* out) const override { forces_.Save(out); }
  void Load(StateReader* in) override { forces_.Load(in); }

 private:
  ForcesParameters p_;
  ForcePasses<T> forces_;
};

}  // namespace

template <typename T>
std::unique_ptr<Motion<T>> MakeForcesMotion(const ForcesParameters& parameters,
                                            const MotionContext& context, const Herd<T>& herd) {
  return std::make_unique<ForcesMotion<T>>(parameters, context, herd);
}

template std::unique_ptr<Motion<float>> MakeForcesMotion(const ForcesParameters&,
                                                         const MotionContext&, const Herd<float>&);
template std::unique_ptr<Motion<double>> MakeForcesMotion(const ForcesParameters&,
                                                          const MotionContext&,
                                                          const Herd<double>&);

}  // namespace flocklift
