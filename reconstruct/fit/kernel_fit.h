// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Interaction kernels without a form, from positions alone: functions of distance
//   order 1   dx_i = sum_j phi_E(r_ij) (x_j - x_i) dt + sqrt(2 D) dW       (opinions, gradients)
//   order 2   dv_i = sum_j [phi_E(r_ij) (x_j - x_i) + phi_A(r_ij) (v_j - v_i)] dt + sqrt(2 D) dW
// as splines, with pointwise bands. phi_E > 0 attracts, < 0 repels; phi_A > 0 aligns. Least squares
// over all runs at once with the weights that position noise and D, both unknown, call for
// (kernel_modes.h), smoothness by marginal likelihood, its own in each part of the distances
// (kernel_evidence.h). Breaks lie where pairs are, where distances are, and, in a second round,
// where the first round's kernel bends.
//
// The bands are as wide as the least smoothness that the data allow makes them (kernel_evidence.h).
// Over 8 seeds of the system `flock` of tools/kernel_case.h, 5 runs seen with noise of 0, 1 and
// 5 mm, the 95 % bands of the alignment cover 98, 96 and 94 % of the pairs in the mean, of the
// attraction 97 (79 to 100 by seed). They count on the kernels being all there is. Where there is
// next to no noise what is left is of the splines, which a kink or a step is not: that is told from
// fits of fewer intervals (kernel_misfit.h) and added. How far rows of one flock err together is
// told from how the flocks differ (kernel_sandwich.h), where there is more than one; not with an
// alignment, out of whose moments the noise that was found, however little, is taken.
//
// How many pieces a spline has matters little once there are enough: what is too many is smoothed
// away. Chosen, it is as many as there are equations for, 80 at most.
//
// Position noise is in the features too. In the offsets it blurs a kernel by sqrt(2) of its sd, and
// no part of a spline is made shorter than 4 of these. In the velocities, which an alignment
// multiplies, it is large: what it does to the moments is found by doing it once more, with the
// variance found and either sign, and taken out (simulation extrapolation, Cook and Stefanski 1994;
// of the moments, not of the estimate). Where the pairs' density rho is nearly 0, a spline on its
// own would be uncertain, or the band is wider than the kernel is high, the kernel is flagged as
// not known.
//
// The setting is that of Lu, Zhong, Tang and Maggioni, "Nonparametric inference of interaction laws
// in systems of agents from trajectory data", PNAS 116 (2019), who divide the sum by the number of
// animals, take the velocities as seen or as differences, and give no bands.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_FIT_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_FIT_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reconstruct/fit/spline_basis.h"
#include "simulate/core/options.h"
#include "simulate/core/progress.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

// The model's name where models are named.
inline constexpr const char* kKernelsModel = "kernels";

struct KernelFitOptions {
  int order = 2;              // of the equation of motion
  int intervals = 0;          // of each kernel's spline; 0: chosen from the data
  int degree = 3;             // of the spline: 0 steps, 1 chain, 3 cubic
  double reach = 0;           // farther pairs do not interact [m]; 0: all pairs do
  double position_noise = 0;  // sd of each coordinate where it is known [m]; 0: estimated
  int segment = 100;          // longest run of frames that is taken at once

  // Not described here: `fit --free` and FitOptions say these.
  std::vector<std::string> kernels = {};  // attraction, alignment; empty: all that the order has
  int bridged_gap = 5;                    // missing frames that neighbours are interpolated over

  // Is the kernel of this name to be fitted?
  bool Has(const std::string& kernel) const;
};

template <typename Visitor>
void Describe(Visitor& visit, KernelFitOptions& o) {
  visit("order", o.order, {.low = 1, .high = 2}, "",
        "what the kernels drive: 1 velocities (opinions, gradients), 2 accelerations");
  visit("intervals", o.intervals, {.low = 0, .high = 400}, "",
        "pieces of each kernel's spline; 0: chosen from the data");
  visit("degree", o.degree, {.low = 0, .high = 3}, "", "of the spline: 0 steps .. 3 cubic");
  visit("reach", o.reach, {.low = 0}, "m", "farther pairs do not interact; 0: all pairs do");
  visit("position-noise", o.position_noise, {.low = 0}, "m",
        "sd of each coordinate of the positions where it is known; 0: estimated");
  visit("segment", o.segment, {.low = 8, .high = 400}, "frames",
        "longest run of an animal's frames that is taken at once");
}

struct KernelPoint {
  double distance = 0;  // [m]
  double value = 0;     // phi
  double sd = 0;        // pointwise; value +- 1.96 sd is the band
  double density = 0;   // rho of pairs [1/m]
  bool known = false;   // do the data say anything?
};

struct FittedKernel {
  std::string name;  // attraction [1/s^order] or alignment [1/s]
  SplineBasis basis;
  std::vector<double> coefficients;
  std::vector<KernelPoint> points;  // by distance, denser where the breaks are

  // 1/s or 1/s^2, by the order of the motion.
  std::string Unit(int order) const;
  double Value(double distance) const { return basis.Value(coefficients, distance); }
  // sd of Value at a distance: of noise, and of misfit.
  double Sd(double distance) const;
  std::vector<double> covariance;  // of the coefficients by noise, row-major
  // sd between each two breaks, of what a spline cannot follow; empty: 0.
  std::vector<double> misfit;
};

enum class KernelFitStatus {
  kOk,
  kTooFewAnimals,  // no two animals at once, or all at one distance
  kTooFewFrames,   // no run of frames is long enough
  kTooFewRows,     // fewer equations than coefficients
};
std::string StatusText(KernelFitStatus status);

struct KernelFit {
  KernelFitStatus status = KernelFitStatus::kOk;
  std::vector<FittedKernel> kernels;
  std::int64_t flocks = 0, animals = 0, rows = 0;
  int intervals = 0;          // asked for, or chosen
  int dimensions = 3;         // coordinates that change
  double position_noise = 0;  // sd of each coordinate [m]
  double diffusion = 0;       // D [m^2/s, or m^2/s^3]
  double explained = 0;       // share of what is not noise, weighted
  double effective = 0;       // parameters that the data decide
  bool converged = false;
  // A kernel of this order that was not asked for, and the share of the pairs where a fit of both
  // finds it: its 95 % band leaves 0 out.
  struct LeftOut {
    std::string name;  // empty: all were asked for
    double share = 0;
  } left_out;
  std::vector<std::string> warnings;

  bool IsUsable() const { return status == KernelFitStatus::kOk; }
};

// `flocks`: one or more runs of the same kind of flock, at the same fps. Deterministic in all but
// `threads`. Throws std::invalid_argument for options out of range, or kernels that do not exist.
KernelFit FitKernels(const KernelFitOptions& options, const std::vector<Trajectories>& flocks,
                     double fps, std::uint64_t seed, int threads, const Progress& progress = {});

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_KERNEL_FIT_H_
