// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A solution for paths and forces together (coupled_flock.h), and how probable it is.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_FOLLOWED_FLOCK_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_FOLLOWED_FLOCK_H_

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "reconstruct/solve/coupled_flock.h"

namespace flocklift::internal {

struct FollowedFlock {
  std::vector<Bird> birds;
  Eigen::VectorXd shared, forces;
  MarkovProcess noise;
  double improbable = 0;                     // minus log of its probability, but for a constant
  std::vector<double> open;                  // sds that the search leaves, by animal [log depth]
  std::optional<CoupledFlock::Scale> scale;  // at which that is told

  // The problem from where this solution is; it moves `birds` and `shared`.
  CoupledFlock Coupled(const BatchModel& model);
  // What the problem has come to: forces, noise, and the least cost + n log(sd of the noise), of n
  // accelerations.
  void Take(const CoupledFlock& coupled);
  // Goes on with what is known of forces and noise; gives up where it will hardly become less
  // improbable than `hopeless`.
  CoupledFlock Settle(const BatchModel& model, int iterations,
                      double hopeless = std::numeric_limits<double>::infinity());

 private:
  double OfNoise() const;  // what it adds to a cost
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_FOLLOWED_FLOCK_H_
