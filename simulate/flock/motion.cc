// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/motion.h"

#include <stdexcept>

#include "simulate/core/check.h"
#include "simulate/flock/boids_motion.h"
#include "simulate/flock/bswarm_motion.h"
#include "simulate/flock/crowd_motion.h"
#include "simulate/flock/forces_motion.h"
#include "simulate/flock/lin_motion.h"
#include "simulate/flock/linear_motion.h"
#include "simulate/flock/morph_motion.h"
#include "simulate/flock/opensteer_motion.h"
#include "simulate/flock/shape_motion.h"
#include "simulate/flock/swarm_motion.h"

namespace flocklift {
namespace {

// One overload for each model of ModelParameters.
template <typename T>
struct Make {
  const MotionContext& context;
  Herd<T>* herd;

  using Result = std::unique_ptr<Motion<T>>;
  Result operator()(const BoidsParameters<double>& p) { return MakeBoidsMotion(p, context, *herd); }
  Result operator()(const LinParameters<double>& p) { return MakeLinMotion<T>(p, context); }
  Result operator()(const LinearParameters<double>& p) { return MakeLinearMotion<T>(p, context); }
  Result operator()(const OpenSteerParameters& p) { return MakeOpenSteerMotion(p, context, *herd); }
  Result operator()(const BSwarmParameters& p) { return MakeBSwarmMotion(p, context, *herd); }
  Result operator()(const MorphParameters& p) { return MakeMorphMotion<T>(p, context, herd); }
  Result operator()(const ForcesParameters& p) { return MakeForcesMotion(p, context, *herd); }
  Result operator()(const SwarmParameters& p) { return MakeSwarmMotion(p, context, *herd); }
  Result operator()(const ShapeParameters& p) { return MakeShapeMotion(p, context, *herd); }
  Result operator()(const CrowdParameters& p) { return MakeCrowdMotion(p, context, herd); }
};

}  // namespace

void RefuseModel(const MotionContext& context, const std::string& fault, const std::string& mend) {
  if (context.where.empty()) throw std::invalid_argument(fault + "; " + mend);
  throw InputError(context.where, 0, fault, mend);
}

template <typename T>
std::unique_ptr<Motion<T>> MakeMotion(const ModelParameters& parameters,
                                      const MotionContext& context, Herd<T>* herd) {
  return std::visit(Make<T>{context, herd}, parameters);
}

template std::unique_ptr<Motion<float>> MakeMotion(const ModelParameters&, const MotionContext&,
                                                   Herd<float>*);
template std::unique_ptr<Motion<double>> MakeMotion(const ModelParameters&, const MotionContext&,
                                                    Herd<double>*);

}  // namespace flocklift
