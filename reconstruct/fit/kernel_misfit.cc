// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_misfit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kPoints = 4;                   // of an interval, that a difference is taken at
constexpr double kSlowest = 0.5;             // share left by a halving that is believed at most
constexpr std::size_t kStep = 2, kWide = 4;  // intervals of f_0 in one of f_1, of f_2

SplineBasis EveryOther(const SplineBasis& basis) {
  const std::vector<double>& breaks = basis.breaks();
  std::vector<double> kept;
  for (std::size_t k = 0; k + 1 < breaks.size(); k += 2) kept.push_back(breaks[k]);
  kept.push_back(breaks.back());
  return SplineBasis(kept, basis.degree());
}

// As many distances as there are functions, whose values make the spline (Greville's: each at the
// mean of its function's inner knots).
std::vector<double> Sites(const SplineBasis& basis) {
  const std::vector<double>& breaks = basis.breaks();
  const int degree = basis.degree(), last = static_cast<int>(breaks.size()) - 1;
  std::vector<double> sites;
  for (int k = 0; k < basis.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    double sum = degree > 0 ? 0 : 0.5 * (breaks[at] + breaks[at + 1]);
    for (int i = 1; i <= degree; ++i) {
      sum += breaks[static_cast<std::size_t>(std::clamp(k + i - degree, 0, last))] / degree;
    }
    sites.push_back(sum);
  }
  return sites;
}

// distances x functions.
MatrixXd ValuesAt(const SplineBasis& basis, const std::vector<double>& distances) {
  MatrixXd values = MatrixXd::Zero(static_cast<Index>(distances.size()), basis.size());
  for (std::size_t k = 0; k < distances.size(); ++k) {
    const SplineBasis::Local local = basis.At(distances[k]);
    for (int i = 0; i <= basis.degree(); ++i) {
      values(static_cast<Index>(k), local.first + i) = local.value[static_cast<std::size_t>(i)];
    }
  }
  return values;
}

// T: coefficients of `fine` from those of `coarse`, kernel by kernel.
MatrixXd Refinement(const std::vector<SplineBasis>& coarse, const std::vector<SplineBasis>& fine) {
  Index rows = 0, columns = 0;
  for (const SplineBasis& basis : fine) rows += basis.size();
  for (const SplineBasis& basis : coarse) columns += basis.size();
  MatrixXd t = MatrixXd::Zero(rows, columns);
  Index row = 0, column = 0;
  for (std::size_t k = 0; k < fine.size(); ++k) {
    const std::vector<double> sites = Sites(fine[k]);
    t.block(row, column, fine[k].size(), coarse[k].size()) =
        ValuesAt(fine[k], sites).partialPivLu().solve(ValuesAt(coarse[k], sites));
    row += fine[k].size();
    column += coarse[k].size();
  }
  return t;
}

// Of every interval, the pairs and the sum over them of d^2, less what noise alone would make it.
struct Squares {
  std::vector<double> pairs, sum;

  // Mean over the group of `size` intervals that `k` is in, and the groups beside it; 0 at least.
  double MeanAbout(std::size_t k, std::size_t size) const {
    const std::size_t group = k / size;
    const std::size_t first = group > 0 ? (group - 1) * size : 0;
    const std::size_t end = std::min(sum.size(), (group + 2) * size);
    double squares = 0, all = 0;
    for (std::size_t i = first; i < end; ++i) {
      squares += sum[i];
      all += pairs[i];
    }
    return all > 0 ? std::max(0.0, squares / all) : 0;
  }
};

// `difference` are coefficients of d, `covariance` is what noise alone would make theirs.
Squares SquaresOf(const SplineBasis& basis, const PairDensity& pairs, const VectorXd& difference,
                  const MatrixXd& covariance) {
  const std::vector<double>& breaks = basis.breaks();
  Squares squares;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const double width = (breaks[k + 1] - breaks[k]) / kPoints;
    std::vector<double> at;
    VectorXd weight(kPoints);
    for (int part = 0; part < kPoints; ++part) {
      at.push_back(breaks[k] + (part + 0.5) * width);
      weight[part] = width * pairs.At(at.back(), 0.5 * width);
    }
    const MatrixXd values = ValuesAt(basis, at);
    const VectorXd noise = (values * covariance).cwiseProduct(values).rowwise().sum();
    squares.pairs.push_back(weight.sum());
    squares.sum.push_back(weight.dot((values * difference).cwiseAbs2() - noise));
  }
  return squares;
}

std::vector<double> Extrapolated(const Squares& first, const Squares& second) {
  std::vector<double> misfit;
  for (std::size_t k = 0; k < first.sum.size(); ++k) {
    const double fine = first.MeanAbout(k, kWide), coarse = second.MeanAbout(k, kWide);
    const double left = fine < kSlowest * kSlowest * coarse ? std::sqrt(fine / coarse) : kSlowest;
    misfit.push_back(std::sqrt(first.MeanAbout(k, kStep)) * left / (1 - left));
  }
  return misfit;
}

}  // namespace

std::vector<std::vector<double>> KernelMisfits(const std::vector<SplineBasis>& kernels,
                                               const PairDensity& pairs, const MatrixXd& h,
                                               const VectorXd& r) {
  Check(h.rows() == r.size() && h.cols() == r.size(), "equations as wide as they are long");
  std::vector<SplineBasis> coarser = kernels;
  MatrixXd finer = Eigen::LLT<MatrixXd>(h).solve(MatrixXd::Identity(h.rows(), h.cols()));  // V_l
  std::array<std::vector<Squares>, 2> squares;  // of d_l, by kernel
  for (auto& of_kernels : squares) {
    for (SplineBasis& basis : coarser) basis = EveryOther(basis);
    const MatrixXd t = Refinement(coarser, kernels);
    const MatrixXd v = t * Eigen::LLT<MatrixXd>(t.transpose() * h * t).solve(t.transpose());
    const MatrixXd lost = finer - v;
    const VectorXd difference = lost * r;
    Index offset = 0;
    for (const SplineBasis& basis : kernels) {
      const Index n = basis.size();
      of_kernels.push_back(
          SquaresOf(basis, pairs, difference.segment(offset, n), lost.block(offset, offset, n, n)));
      offset += n;
    }
    finer = v;
  }
  std::vector<std::vector<double>> misfits;
  for (std::size_t k = 0; k < kernels.size(); ++k) {
    misfits.push_back(Extrapolated(squares[0][k], squares[1][k]));
  }
  return misfits;
}

}  // namespace flocklift
