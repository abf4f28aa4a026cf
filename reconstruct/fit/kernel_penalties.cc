// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/kernel_penalties.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flocklift {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kSmoothnesses = 6;  // of a kernel, over the breaks

// Of one kernel, placed in its block among all terms.
void AddPenalties(const SplineBasis& basis, Index offset, Index terms, KernelPenalties* penalties) {
  const std::vector<double>& breaks = basis.breaks();
  const auto intervals = static_cast<double>(breaks.size() - 1);
  for (int g = 0; g < kSmoothnesses; ++g) {
    const auto weight = [&](double r) {
      const auto after = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, r);
      const double width = *after - *(after - 1);
      const double at =
          static_cast<double>(after - breaks.begin()) - 1 + (r - *(after - 1)) / width;
      const double hat = 1 - std::abs(at / intervals * (kSmoothnesses - 1) - g);
      return std::max(0.0, hat) * width * width * width;
    };
    const std::vector<double> roughness = basis.Roughness(2, weight);
    MatrixXd penalty = MatrixXd::Zero(terms, terms);
    const Index n = basis.size();
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < n; ++j) {
        penalty(offset + i, offset + j) = roughness[static_cast<std::size_t>(i * n + j)];
      }
    }
    penalties->parts.push_back(std::move(penalty));
  }
  penalties->pins.push_back(offset);
  penalties->pins.push_back(offset + basis.size() - 1);
}

}  // namespace

KernelPenalties SmoothnessOf(const KernelDesign& design) {
  KernelPenalties penalties;
  if (design.has_attraction) AddPenalties(design.attraction, 0, design.terms(), &penalties);
  if (design.has_alignment) {
    AddPenalties(design.alignment, design.alignment_offset(), design.terms(), &penalties);
  }
  return penalties;
}

}  // namespace flocklift
