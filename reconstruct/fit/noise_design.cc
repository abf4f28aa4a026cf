// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/noise_design.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "simulate/core/check.h"
#include "simulate/fields/lattice.h"
#include "simulate/fields/perlin_noise.h"

namespace flocklift {
namespace {

constexpr int kGradients = 16;

double Component(int gradient, int axis) { return 0.5 * kDoubledGradients[gradient][axis]; }

double At(const Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

LatticePoint Corner(const LatticePoint& low, int q) {
  return {low[0] + (q & 1), low[1] + (q >> 1 & 1), low[2] + (q >> 2)};
}

// Row `axis` of a curl is d_second of noise `first` less the other way round.
struct CurlPart {
  int row, noise, slope;
  double sign;
};
constexpr CurlPart kCurl[] = {{0, 2, 1, 1},  {0, 1, 2, -1}, {1, 0, 2, 1},
                              {1, 2, 0, -1}, {2, 1, 0, 1},  {2, 0, 1, -1}};

}  // namespace

NoiseDesign MakeNoiseDesign(std::span<const Vec3d> positions, double scale) {
  Check(scale > 0, "the scale of noise must be positive");
  std::vector<LatticePoint> low;
  NoiseDesign design;
  for (const Vec3d& x : positions) {
    const auto cell = [scale](double u) {
      return static_cast<std::int64_t>(std::floor(u / scale));
    };
    low.push_back({cell(x.x), cell(x.y), cell(x.z)});
    for (int q = 0; q < 8; ++q) design.lattice.push_back(Corner(low.back(), q));
  }
  std::sort(design.lattice.begin(), design.lattice.end());
  design.lattice.erase(std::unique(design.lattice.begin(), design.lattice.end()),
                       design.lattice.end());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(144 * positions.size());
  for (std::size_t k = 0; k < positions.size(); ++k) {
    double f[3], w[3][2], slope[3];
    for (int a = 0; a < 3; ++a) {
      f[a] = At(positions[k], a) / scale - static_cast<double>(low[k][a]);
      w[a][1] = Fade(f[a]);
      w[a][0] = 1 - w[a][1];
      slope[a] = FadeSlope(f[a]);
    }
    for (int q = 0; q < 8; ++q) {
      const int c[3] = {q & 1, q >> 1 & 1, q >> 2};
      const auto found =
          std::lower_bound(design.lattice.begin(), design.lattice.end(), Corner(low[k], q));
      const auto column = 9 * static_cast<int>(found - design.lattice.begin());
      const double weight = w[0][c[0]] * w[1][c[1]] * w[2][c[2]];
      for (const CurlPart& part : kCurl) {
        const int j = part.slope, a = (j + 1) % 3, b = (j + 2) % 3;
        const double weight_slope = (c[j] == 1 ? slope[j] : -slope[j]) * w[a][c[a]] * w[b][c[b]];
        for (int g = 0; g < 3; ++g) {
          const double value = weight_slope * (f[g] - c[g]) + (g == j ? weight : 0);
          entries.emplace_back(3 * static_cast<int>(k) + part.row, column + 3 * part.noise + g,
                               part.sign / scale * value);
        }
      }
    }
  }
  design.matrix.resize(static_cast<Eigen::Index>(3 * positions.size()),
                       static_cast<Eigen::Index>(9 * design.lattice.size()));
  design.matrix.setFromTriplets(entries.begin(), entries.end());
  return design;
}

std::array<double, 3> GradientVariance() {
  std::array<double, 3> variance{};
  for (int a = 0; a < 3; ++a) {
    for (int g = 0; g < kGradients; ++g) {
      variance[a] += Component(g, a) * Component(g, a) / kGradients;
    }
  }
  return variance;
}

std::array<double, 81> GradientCumulants() {
  const std::array<double, 3> variance = GradientVariance();
  std::array<double, 81> cumulants{};
  const auto same = [](int a, int b) { return a == b ? 1.0 : 0.0; };
  for (int n = 0; n < 81; ++n) {
    const int a = n / 27, b = n / 9 % 3, c = n / 3 % 3, d = n % 3;
    double moment = 0;
    for (int g = 0; g < kGradients; ++g) {
      moment += Component(g, a) * Component(g, b) * Component(g, c) * Component(g, d) / kGradients;
    }
    moment /= std::sqrt(variance[a] * variance[b] * variance[c] * variance[d]);
    cumulants[n] =
        moment - same(a, b) * same(c, d) - same(a, c) * same(b, d) - same(a, d) * same(b, c);
  }
  return cumulants;
}

}  // namespace flocklift
