// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several runs of a flock as the normal equations of kernels without a form,
//   f_i = sum_j phi_E(r_ij) (x_j - x_i) + phi_A(r_ij) (v_j - v_i),   phi = sum_k c_k B_k
// (the sum over all others within reach; f a velocity or an acceleration, kernel_modes.h). Each
// animal's frames are cut into runs of at most `segment`, whose independent rows are gathered by
// their lambda, to within 10 %: any s and D weigh the gathered moments afterwards.
// World frame; coordinates that no animal ever changes (opinions have one) are left out.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_MOMENTS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_MOMENTS_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "reconstruct/fit/kernel_modes.h"
#include "reconstruct/fit/observed_flock.h"
#include "reconstruct/fit/spline_basis.h"

namespace flocklift {

struct KernelDesign {
  int order = 2;           // 1: f moves positions; 2: velocities
  SplineBasis attraction;  // B of phi_E [1/s or 1/s^2]
  SplineBasis alignment;   // B of phi_A [1/s]; order 2 only
  bool has_attraction = true, has_alignment = true;
  std::array<bool, 3> coordinates = {true, true, true};
  double reach = 0;   // farther pairs do not interact [m]; 0: all do
  int segment = 100;  // frames

  int terms() const {
    return (has_attraction ? attraction.size() : 0) + (has_alignment ? alignment.size() : 0);
  }
  // Place of the alignment's first function among the terms.
  int alignment_offset() const { return has_attraction ? attraction.size() : 0; }
};

// Of one animal of a flock.
struct KernelRun {
  std::size_t flock = 0;
  int animal = 0, first = 0, frames = 0;
};

// Frames that were measured, one after the other, in pieces of nearly one length; by flock.
std::vector<KernelRun> KernelRuns(const KernelDesign& design,
                                  const std::vector<ObservedFlock>& flocks);

// Rows of nearly one lambda: the lower triangle of sum [X y]'[X y].
struct KernelBin {
  double lambda = 0;  // sum over the rows
  double rows = 0;
  Eigen::MatrixXd moment;  // (terms + 1)^2
};

struct KernelMoments {
  int terms = 0;
  int dimensions = 0;             // coordinates in use
  std::map<int, KernelBin> bins;  // by the place of lambda on a logarithmic scale
  // By run length: sum of g over the runs, terms x F; and the modes that it belongs to.
  std::map<int, Eigen::MatrixXd> divergence;
  std::map<int, KernelModes> modes;
  // Sum of g g' n / (n - 1) over runs and frames, n the animals there: with coefficients, how fast
  // an animal's own noise is forgotten where a term acts (RatesOf).
  Eigen::MatrixXd relaxation;
  std::int64_t runs = 0, frames = 0;  // of animals

  double rows() const;
  // Of each term, for these coefficients [1/s]; 0 for terms without a divergence.
  Eigen::VectorXd RatesOf(const Eigen::VectorXd& coefficients) const;
};

// How many equations GatherKernelMoments can make of these flocks at most.
std::int64_t CountKernelRows(const KernelDesign& design, const std::vector<ObservedFlock>& flocks);

// `moved` are the same flocks, with other noise perhaps: displacements and velocities are taken
// from these, the offsets between the animals from `flocks`. Same sums at any number of threads.
KernelMoments GatherKernelMoments(const KernelDesign& design,
                                  const std::vector<ObservedFlock>& flocks,
                                  const std::vector<ObservedFlock>& moved, int threads);

// Right-hand side of animal i in a frame, term by term, into `out` (terms); and its divergence by
// the animal's own state, summed over the coordinates, into `divergence` when not null. False when
// it is not known: an alignment where somebody has no velocity.
bool KernelTerms(const KernelDesign& design, const ObservedFlock& flock, const ObservedFlock& moved,
                 int animal, int frame, std::vector<Vec3d>* out, double* divergence);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_MOMENTS_H_
