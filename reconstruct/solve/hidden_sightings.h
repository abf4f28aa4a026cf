// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sightings kept back from a solver, to see which of two solutions predicts them better: pieces of
// tracks, each with sightings before and after it.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_HIDDEN_SIGHTINGS_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_HIDDEN_SIGHTINGS_H_

#include <vector>

#include "reconstruct/initialize/segments.h"
#include "reconstruct/solve/batch_problem.h"

namespace flocklift::internal {

class HiddenSightings {
 public:
  // Hides about `share` of every long enough segment in pieces of `duration` [s], evenly spread and
  // staggered from segment to segment; other pieces for every `fold`, of which there are 1 / share.
  HiddenSightings(double share, double duration, double fps, const Segments& segments,
                  int fold = 0);

  const Segments& rest() const { return rest_; }  // the segments without what is hidden
  long count() const { return count_; }
  std::size_t pieces() const { return pieces_.size(); }

  // Of every piece: the mean error of the image positions that the paths predict, in their sds.
  // Far errors count little more than near ones: square roots are averaged.
  std::vector<double> ErrorsOf(const std::vector<Bird>& birds, double knot_interval) const;

 private:
  struct Piece {
    std::size_t segment = 0;
    std::vector<Sighting> sightings;
  };
  Segments rest_;
  std::vector<Piece> pieces_;
  long count_ = 0;
};

double MeanOf(const std::vector<double>& values);

// How probable it is, from `odds` before, that what made `errors` of the pieces is nearer to the
// truth than what made `others`. Errors of pieces come from one distribution of unknown scale each,
// two coordinates a piece, so that the likelihoods stand as the scales do to the power of -2 n.
double ProbabilityOfBetter(const std::vector<double>& errors, const std::vector<double>& others,
                           double odds = 1);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_HIDDEN_SIGHTINGS_H_
