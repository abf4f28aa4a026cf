// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Curl noise (simulate/fields/curl_noise.h) of a known scale is linear in the gradients g of its
// lattice points, three a point, one for each of the noises P_1, P_2, P_3:
//   V(x) = gain A(x; scale) g,    A from d_j (w_c g_c . (f - c)) of perlin_noise.h
// The gradients are drawn from sixteen by a hash, so that to who does not know the seed they are
// independent, of mean 0 and uncorrelated, component a of variance GradientVariance()[a].

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_NOISE_DESIGN_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_NOISE_DESIGN_H_

#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

using LatticePoint = std::array<std::int64_t, 3>;

struct NoiseDesign {
  // 3 N x 9 M [1/m]: row 3 k + axis, column 9 m + 3 noise + component.
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix;
  std::vector<LatticePoint> lattice;  // M, that any of the positions feels, in increasing order
};

NoiseDesign MakeNoiseDesign(std::span<const Vec3d> positions, double scale);

std::array<double, 3> GradientVariance();

// Fourth cumulants of one noise's gradient, each component in units of its sd: of normal gradients
// all were 0. [((a 3 + b) 3 + c) 3 + d].
std::array<double, 81> GradientCumulants();

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_NOISE_DESIGN_H_
