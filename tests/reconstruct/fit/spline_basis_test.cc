// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/spline_basis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

namespace flocklift {
namespace {

const std::vector<double> kBreaks = {0.5, 0.7, 1.5, 1.6, 3};

double Quadratic(const std::vector<double>& matrix, const std::vector<double>& c) {
  double sum = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    for (std::size_t j = 0; j < c.size(); ++j) sum += c[i] * matrix[i * c.size() + j] * c[j];
  }
  return sum;
}

TEST(SplineBasis, ByHand) {
  const SplineBasis steps({0, 1, 3}, 0);
  EXPECT_EQ(steps.size(), 2);
  EXPECT_EQ(steps.Value(std::vector<double>{5, 7}, 0.99), 5);
  EXPECT_EQ(steps.Value(std::vector<double>{5, 7}, 1), 7);
  const SplineBasis chain({0, 1, 3}, 1);
  EXPECT_EQ(chain.size(), 3);
  EXPECT_DOUBLE_EQ(chain.Value(std::vector<double>{4, 6, 2}, 0.5), 5);
  EXPECT_DOUBLE_EQ(chain.Value(std::vector<double>{4, 6, 2}, 2), 4);
  // One interval of degree 3 is Bernstein's: r^2 has the coefficients 0, 0, 1/3, 1.
  const SplineBasis cubic({0, 1}, 3);
  const std::vector<double> square = {0, 0, 1.0 / 3, 1};
  EXPECT_NEAR(cubic.Value(square, 0.3), 0.09, 1e-15);
}

TEST(SplineBasis, SumsToOneWithTheSlopesOfItsValues) {
  for (int degree = 0; degree <= 3; ++degree) {
    const SplineBasis basis(kBreaks, degree);
    const std::vector<double> ones(static_cast<std::size_t>(basis.size()), 1.0);
    std::vector<double> c(ones.size());
    for (std::size_t k = 0; k < c.size(); ++k) c[k] = std::sin(3.0 * static_cast<double>(k));
    for (double r = 0.51; r < 3; r += 0.0931) {
      EXPECT_NEAR(basis.Value(ones, r), 1, 1e-14);
      const SplineBasis::Local local = basis.At(r);
      double slope = 0;
      for (int k = 0; k <= degree; ++k) {
        slope +=
            local.slope[static_cast<std::size_t>(k)] * c[static_cast<std::size_t>(local.first + k)];
      }
      const double step = 1e-6;
      if (degree == 0) continue;
      EXPECT_NEAR(slope, (basis.Value(c, r + step) - basis.Value(c, r - step)) / (2 * step), 1e-6);
    }
  }
}

TEST(SplineBasis, KeepsItsEndsOutside) {
  const SplineBasis basis(kBreaks, 3);
  std::vector<double> c(static_cast<std::size_t>(basis.size()));
  std::iota(c.begin(), c.end(), 1.0);
  EXPECT_EQ(basis.Value(c, 0), 1);
  EXPECT_EQ(basis.Value(c, 99), c.back());
  EXPECT_EQ(basis.At(99).slope[3], 0);
}

TEST(SplineBasis, RoughnessByHand) {
  const std::vector<double> square = {0, 0, 1.0 / 3, 1};
  const SplineBasis cubic({0, 1}, 3);
  const auto one = [](double) { return 1.0; };
  EXPECT_NEAR(Quadratic(cubic.Roughness(2, one), square), 4, 1e-12);        // (2)^2
  EXPECT_NEAR(Quadratic(cubic.Roughness(1, one), square), 4.0 / 3, 1e-12);  // (2 r)^2
  EXPECT_NEAR(Quadratic(cubic.Roughness(2, [](double r) { return r; }), square), 2, 1e-12);
  const SplineBasis chain({0, 1, 3}, 1);
  EXPECT_NEAR(Quadratic(chain.Roughness(1, one), {4, 6, 2}), 4 + 2 * 4, 1e-12);
}

TEST(SplineBasis, StraightLinesAreNotRough) {
  for (int degree = 0; degree <= 3; ++degree) {
    const SplineBasis basis(kBreaks, degree);
    // Coefficients of r: the knots' means (Greville); of steps the middles.
    std::vector<double> knots(static_cast<std::size_t>(degree), kBreaks.front());
    knots.insert(knots.end(), kBreaks.begin(), kBreaks.end());
    knots.insert(knots.end(), static_cast<std::size_t>(degree), kBreaks.back());
    std::vector<double> line;
    for (std::size_t k = 0; k < static_cast<std::size_t>(basis.size()); ++k) {
      double mean = 0;
      const auto d = static_cast<std::size_t>(degree);
      if (degree == 0) mean = 0.5 * (kBreaks[k] + kBreaks[k + 1]);
      for (std::size_t i = 1; i <= d; ++i) mean += knots[k + i] / degree;
      line.push_back(mean);
    }
    if (degree > 0) {
      EXPECT_NEAR(basis.Value(line, 1.23), 1.23, 1e-14);
    }
    const auto one = [](double) { return 1.0; };
    EXPECT_NEAR(Quadratic(basis.Roughness(2, one), line), 0, 1e-12) << degree;
    line[1] += 0.1;
    EXPECT_GT(Quadratic(basis.Roughness(2, one), line), 1e-3) << degree;
  }
}

TEST(SplineBasis, RefusesWhatIsNone) {
  EXPECT_THROW(SplineBasis({1}, 3), std::invalid_argument);
  EXPECT_THROW(SplineBasis({1, 1, 2}, 3), std::invalid_argument);
  EXPECT_THROW(SplineBasis({1, 2}, 4), std::invalid_argument);
  EXPECT_THROW(SplineBasis({1, 2}, -1), std::invalid_argument);
  const SplineBasis basis({1, 2}, 1);
  EXPECT_THROW(static_cast<void>(basis.Value(std::vector<double>{1}, 1)), std::invalid_argument);
  EXPECT_THROW(basis.Roughness(3, [](double) { return 1.0; }), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
