// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One fit in the making (fit.h): what its stages share. The rows of the regression and its solution
// (fit.cc), a goal where one is called for (fitter_goal.cc), whether what is held fixed should be
// (fitter_held.cc), what depth errors do (fitter_depth.cc) and what is reported
// (fitter_summary.cc).

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_FITTER_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_FITTER_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reconstruct/fit/fit.h"
#include "reconstruct/fit/flock_terms.h"
#include "reconstruct/fit/motion_rows.h"
#include "reconstruct/fit/observed_flock.h"
#include "reconstruct/fit/state_space.h"
#include "reconstruct/fit/term_surroundings.h"
#include "reconstruct/fit/whitened_fit.h"

namespace flocklift::internal {

// What a regression takes for granted of what the model leaves over. Where the model is wrong, so
// may be all else that is estimated with it: its memory, or weights by instruments.
enum class NoiseAssumed {
  kMayLast,
  kIsNew,    // in every frame
  kIsSmall,  // beside what the model explains: least squares
};

class Fitter {
 public:
  Fitter(const FitOptions& options, const FitProblem& problem, const Trajectories& trajectories,
         double fps, std::uint64_t seed, int threads)
      : options_(options),
        problem_(problem),
        trajectories_(trajectories),
        fps_(fps),
        seed_(seed),
        threads_(threads),
        flock_(trajectories, fps, options.bridged_gap) {}

  void Assume(NoiseAssumed noise) { noise_assumed_ = noise; }

  FitResult Run(const Progress& progress);

 private:
  void UseGoal(const std::optional<GoalSpec>& goal);
  // And puts the parameters that are not weights, which only a state-space estimate can free,
  // last.
  void ChooseMethod();
  // From the regression's estimate, which it replaces, and the other parameters as given.
  void EstimateStates(WhitenedFit* fit);
  // As the file states them; none where it does not.
  std::optional<DepthErrors> StatedDepthErrors() const;
  // Those of these names that are not free, but could be.
  std::vector<std::string> HeldOf(const std::vector<std::string>& names) const;
  // How well the values of what is held agree with the motion: by the score of the likelihood, or
  // by a regression in which they are free.
  void ScoreHeldParameters(const StateSpaceOptions& options, const StateSpaceFit& states,
                           const FilterInput& input, const DepthPaths* paths);
  void TestHeldWeights();
  // Without the parameters that are none.
  std::vector<double> WeightsOf(const std::vector<double>& theta) const;
  void ChooseWhitening();
  // Rows and weights for the terms as they are; u_ is what they leave over.
  WhitenedFit Solve(const Progress& progress);
  double Pull() const;
  bool IsHeld() const;
  std::optional<double> Prediction() const;
  // Fits with a goal where one is called for, and keeps it when it predicts better.
  void SettleGoal(WhitenedFit* fit);
  // The goal moves to where the mean of what is left over vanishes, unless its place was given.
  void LocateGoal(GoalSpec goal, WhitenedFit* fit);
  void ChooseRows();
  MotionRows Rows(const ObservedFlock& flock, const Progress& progress) const;
  void SummarizeWeights(const WhitenedFit& fit);
  // Of the return to cruising speeds, by the model and its terms [1/s].
  double CruiseRate() const;
  // May the model's weight be no less than 0?
  bool IsPositive(const std::string& name) const;
  void SummarizeRest(const WhitenedFit& fit);
  // Simulation extrapolation: what one more error of the stated size does. A state-space estimate
  // has the errors among its unknowns and is told only how much of each term they are.
  void AddDepthFactors(const WhitenedFit& fit);
  void WriteParametersOf(const WhitenedFit& fit);

  const FitOptions& options_;
  const FitProblem& problem_;
  const Trajectories& trajectories_;
  double fps_;
  std::uint64_t seed_;
  int threads_;
  ObservedFlock flock_;
  ModelSpec model_;                    // complete
  std::vector<std::string> free_;      // of the model
  std::size_t weights_ = 0;            // of them; then those by which accelerations are not linear
  std::vector<double> parameter_rms_;  // of a state-space estimate
  TermSurroundings around_;
  std::optional<GoalSpec> goal_;
  double cruising_speed_ = 0;  // that the terms count on [m/s]
  FlockTerms terms_;
  WhiteningOptions whitening_;
  MotionRows rows_;
  NoiseAssumed noise_assumed_ = NoiseAssumed::kMayLast;
  int window_ = 1, stride_ = 1;
  std::vector<int> middles_;
  std::vector<Vec3d> u_;
  FitResult result_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_FITTER_H_
