// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/spline_basis.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {

SplineBasis::SplineBasis(std::vector<double> breaks, int degree)
    : breaks_(std::move(breaks)), degree_(degree) {
  Check(breaks_.size() >= 2, "a spline needs two breaks");
  for (std::size_t k = 1; k < breaks_.size(); ++k) {
    Check(breaks_[k] > breaks_[k - 1], "the breaks of a spline must increase");
  }
  Check(degree >= 0 && degree <= kMaxDegree, "the degree of a spline is 0 to 3");
  knots_.assign(static_cast<std::size_t>(degree), breaks_.front());
  knots_.insert(knots_.end(), breaks_.begin(), breaks_.end());
  knots_.insert(knots_.end(), static_cast<std::size_t>(degree), breaks_.back());
  size_ = static_cast<int>(breaks_.size()) - 1 + degree;
}

SplineBasis::Local SplineBasis::At(double r) const {
  Local local;
  const bool inside = r >= low() && r <= high();
  r = std::clamp(r, low(), high());
  const auto after = std::upper_bound(breaks_.begin(), breaks_.end() - 1, r);
  local.first = static_cast<int>(after - breaks_.begin()) - 1;
  const auto knot = [&](int k) { return knots_[static_cast<std::size_t>(k)]; };
  const int last = local.first + degree_;  // knot(last) <= r: the interval's own
  auto& b = local.value;
  b[0] = 1;
  std::array<double, kMaxDegree + 1> lower{};  // of one degree less, for the slopes
  for (int d = 1; d <= degree_; ++d) {
    lower = b;
    double saved = 0;
    for (int k = 0; k < d; ++k) {
      const double right = knot(last + k + 1), left = knot(last + 1 - d + k);
      const double share = lower[static_cast<std::size_t>(k)] / (right - left);
      b[static_cast<std::size_t>(k)] = saved + (right - r) * share;
      saved = (r - left) * share;
    }
    b[static_cast<std::size_t>(d)] = saved;
  }
  if (degree_ == 0 || !inside) return local;
  for (int k = 0; k <= degree_; ++k) {
    const int at = local.first + k;
    double slope = 0;
    if (k > 0) slope += lower[static_cast<std::size_t>(k - 1)] / (knot(at + degree_) - knot(at));
    if (k < degree_) {
      slope -= lower[static_cast<std::size_t>(k)] / (knot(at + degree_ + 1) - knot(at + 1));
    }
    local.slope[static_cast<std::size_t>(k)] = degree_ * slope;
  }
  return local;
}

double SplineBasis::Value(std::span<const double> coefficients, double r) const {
  Check(static_cast<int>(coefficients.size()) == size_, "a coefficient for each spline");
  const Local local = At(r);
  double sum = 0;
  for (int k = 0; k <= degree_; ++k) {
    sum += local.value[static_cast<std::size_t>(k)] *
           coefficients[static_cast<std::size_t>(local.first + k)];
  }
  return sum;
}

double SplineBasis::Derivative(int k, int order, int degree, double r) const {
  const auto knot = [&](int at) { return knots_[static_cast<std::size_t>(at)]; };
  const auto share = [](double a, double width) { return width > 0 ? a / width : 0; };
  if (degree == 0) return order == 0 && r >= knot(k) && r < knot(k + 1) ? 1 : 0;
  const double left = knot(k + degree) - knot(k), right = knot(k + degree + 1) - knot(k + 1);
  if (order == 0) {
    return share((r - knot(k)) * Derivative(k, 0, degree - 1, r), left) +
           share((knot(k + degree + 1) - r) * Derivative(k + 1, 0, degree - 1, r), right);
  }
  return degree * (share(Derivative(k, order - 1, degree - 1, r), left) -
                   share(Derivative(k + 1, order - 1, degree - 1, r), right));
}

std::vector<double> SplineBasis::Roughness(int order,
                                           const std::function<double(double)>& weight) const {
  Check(order == 1 || order == 2, "the order of a roughness is 1 or 2");
  const auto n = static_cast<std::size_t>(size_);
  std::vector<double> roughness(n * n, 0.0);
  if (order > degree_) {  // divided differences of the coefficients at their mean knots
    std::vector<double> at(n);
    for (int k = 0; k < size_; ++k) {
      const auto i = static_cast<std::size_t>(k);
      at[i] = degree_ == 0 ? 0.5 * (breaks_[i] + breaks_[i + 1]) : knots_[i + 1];
    }
    for (std::size_t k = 0; k + static_cast<std::size_t>(order) < n; ++k) {
      std::array<double, 3> c{};
      double width = at[k + 1] - at[k];
      if (order == 1) {
        c = {-1 / width, 1 / width, 0};
      } else {
        const double a = width, b = at[k + 2] - at[k + 1];
        width = 0.5 * (a + b);
        c = {1 / (a * width), -1 / (a * width) - 1 / (b * width), 1 / (b * width)};
      }
      const double w = width * weight(0.5 * (at[k] + at[k + static_cast<std::size_t>(order)]));
      for (std::size_t i = 0; i <= static_cast<std::size_t>(order); ++i) {
        for (std::size_t j = 0; j <= static_cast<std::size_t>(order); ++j) {
          roughness[(k + i) * n + k + j] += w * c[i] * c[j];
        }
      }
    }
    return roughness;
  }
  // Gauss's three points an interval: exact for a weight that is linear there.
  constexpr std::array<double, 3> kNode = {-0.7745966692414834, 0, 0.7745966692414834};
  constexpr std::array<double, 3> kShare = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  for (std::size_t interval = 0; interval + 1 < breaks_.size(); ++interval) {
    const double a = breaks_[interval], b = breaks_[interval + 1];
    for (std::size_t g = 0; g < kNode.size(); ++g) {
      const double r = 0.5 * (a + b) + 0.5 * (b - a) * kNode[g];
      std::array<double, kMaxDegree + 1> d{};
      for (int k = 0; k <= degree_; ++k) {
        d[static_cast<std::size_t>(k)] =
            Derivative(static_cast<int>(interval) + k, order, degree_, r);
      }
      const double w = (b - a) * kShare[g] * weight(r);
      for (int i = 0; i <= degree_; ++i) {
        for (int j = 0; j <= degree_; ++j) {
          roughness[(interval + static_cast<std::size_t>(i)) * n + interval +
                    static_cast<std::size_t>(j)] +=
              w * d[static_cast<std::size_t>(i)] * d[static_cast<std::size_t>(j)];
        }
      }
    }
  }
  return roughness;
}

}  // namespace flocklift
