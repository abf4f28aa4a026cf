// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several models of the same trajectories, compared by what they predict of the time that was held
// out of their fits: 1 - sum |y - yhat|^2 / sum |y|^2 of accelerations after it, from states before
// each (HeldOutR2 of reconstruct/fit/fit_measures.h; of models that have no weights to regress on,
// reconstruct/fit/simulated_prediction.h). Constant velocity, yhat = 0, has 0 and is the
// model to beat; below it a model explains nothing.

#ifndef FLOCKLIFT_TOOLS_FIT_COMPARISON_H_
#define FLOCKLIFT_TOOLS_FIT_COMPARISON_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/kernel_fit.h"

namespace flocklift {

struct ModelScore {
  std::string model;
  std::size_t weights = 0;  // that were fitted; of kernels: that the data decide
  std::optional<double> r2_held_out;
  std::string fault;  // why there is no score
};

// Throws InputError for a model that does not exist, or that cannot be flown from trajectories;
// `in_scene` has a scene to fly in.
void CheckComparable(const std::vector<std::string>& models, const std::string& in_scene = {});

// By errors-in-variables, or by the model's own default where that cannot be, each with all its
// weights and otherwise its defaults (the problem's settings, and its scene, where it is the
// problem's model; the others have its walls), best first, constant velocity among them; empty for
// no names. The model `kernels` is fitted to all the flocks, every other to the first. Throws as
// CheckComparable.
std::vector<ModelScore> CompareModels(const FitOptions& options, const FitProblem& problem,
                                      const KernelFitOptions& kernels,
                                      const std::vector<std::string>& models,
                                      const std::vector<Trajectories>& flocks, double fps,
                                      std::uint64_t seed, int threads);

nlohmann::ordered_json ScoresAsJson(const std::vector<ModelScore>& scores);
void PrintScores(const std::vector<ModelScore>& scores);  // on standard error

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_FIT_COMPARISON_H_
