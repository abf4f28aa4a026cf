// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// B-splines on given breaks (de Boor, "A practical guide to splines", 1978): a function of distance
// without a form,
//   phi(r) = sum_k c_k B_k(r),
// of piecewise polynomials of one degree whose derivatives below it are continuous. Outside the
// breaks it keeps the value that it has at the nearer end.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_SPLINE_BASIS_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_SPLINE_BASIS_H_

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace flocklift {

class SplineBasis {
 public:
  static constexpr int kMaxDegree = 3;

  SplineBasis() = default;
  // At least two breaks, increasing; degree 0 (steps) to 3 (cubic).
  SplineBasis(std::vector<double> breaks, int degree);

  // How many functions: breaks - 1 + degree.
  int size() const { return size_; }
  int degree() const { return degree_; }
  const std::vector<double>& breaks() const { return breaks_; }
  double low() const { return breaks_.front(); }
  double high() const { return breaks_.back(); }

  // The functions first .. first + degree, which alone are not 0 at r, and their slopes.
  struct Local {
    int first = 0;
    std::array<double, kMaxDegree + 1> value{}, slope{};
  };
  Local At(double r) const;
  double Value(std::span<const double> coefficients, double r) const;

  // size x size, row-major: the integral of weight(r) (phi^(order))^2 dr is c' R c. `order` 1 or 2,
  // at most the degree (of steps and of chains: squared differences over distances, likewise).
  std::vector<double> Roughness(int order, const std::function<double(double)>& weight) const;

 private:
  // Derivative `order` of function k at r inside the breaks.
  double Derivative(int k, int order, int degree, double r) const;

  std::vector<double> breaks_, knots_;  // knots: breaks with the ends `degree` times more
  int degree_ = 0, size_ = 0;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_SPLINE_BASIS_H_
