// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A reconstruction's depth errors as unknowns of a fit: positions are
//   y_i(t) = x_i(t) + g_i(t) e_i(t) + c_i(t) z_0
// with g_i the stated sd as a vector along the line of sight, e_i a smooth Gaussian process of
// variance 1 and correlation exp(-dt^2 / (2 time^2)), as depth_noise.h draws it, and c_i what one
// sd of the common scale moves. e_i is known by its values at knots 0.7 time apart (the
// interpolation that the process itself expects, exact to 1e-3), these by K = L L', and so by
// independent z ~ N(0, 1):
//   e_i(t) = k(t, knots) L^-T z
// An animal nearer than it seems is smaller in its motion too, across the line of sight, so that
// the density of the positions has the volume of x for y in it: log V = sum 2 log(1 - e_i |g_i| /
// r_i)
// + 3 log(1 - z_0 |c_i| / r_i), r the distance from the eye.
// Errors last, so the unknowns are few beside the positions: estimated together with the parameters
// they leave those unbiased (Deming's regression; Fuller, "Measurement error models", 1987), and
// the joint information says what not knowing them costs, between animals too.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_DEPTH_PATHS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_DEPTH_PATHS_H_

#include <functional>
#include <span>
#include <vector>

#include "reconstruct/fit/flock_filter.h"

namespace flocklift {

struct DepthErrors {
  // From the eye to an animal in a frame [m], and one sd of its own error as a share of that.
  std::function<Vec3d(int animal, int frame)> sight;
  std::function<double(int animal, int frame)> own;
  double scale_sd = 0;  // of the common scale
  double time = 2;      // correlation time of `own` [s]
};

// How many unknowns they would be.
std::size_t UnknownDepthErrors(const DepthErrors& errors, const FilterInput& input);

class DepthPaths {
 public:
  // Of the positions in `input`; animals whose errors are stated to be 0 have none.
  DepthPaths(const DepthErrors& errors, const FilterInput& input);

  std::size_t size() const { return size_; }  // unknowns z
  // The positions less the errors that z stands for.
  FilterInput Without(const FilterInput& input, std::span<const double> z) const;
  // log V; -infinity where a position would be behind the eye.
  double LogVolume(std::span<const double> z) const;
  // Adds the gradient of -log V to `gradient` and its second derivatives to `second`, size()
  // squared.
  void AddVolume(std::span<const double> z, std::span<double> gradient,
                 std::span<double> second) const;

 private:
  struct Part {
    std::size_t first = 0;      // of z
    std::vector<double> share;  // of the animal's z: e = share' z
    Vec3d sight;
    double own = 0;  // share of sight
    double Error(std::span<const double> z) const;
  };
  std::vector<std::vector<Part>> frames_;  // as the input's sightings
  std::size_t size_ = 0;
  double scale_sd_ = 0;  // above 0: z_0 is the first unknown
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_DEPTH_PATHS_H_
