// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/error_shares.h"

#include <cmath>
#include <cstddef>
#include <numeric>

#include "simulate/core/check.h"

namespace flocklift {

std::vector<ErrorShare> SharesOf(const std::vector<std::vector<double>>& squared) {
  Check(!squared.empty(), "shares of no stage");
  const std::size_t starts = squared.front().size();
  std::vector<double> sums;
  for (const std::vector<double>& row : squared) {
    Check(row.size() == starts, "every stage needs a sum for each start");
    sums.push_back(std::accumulate(row.begin(), row.end(), 0.0));
  }
  const auto share = [&](std::size_t k, std::size_t without) {
    const auto sum = [&](std::size_t row) {
      if (row == squared.size()) return 0.0;
      return sums[row] - (without < starts ? squared[row][without] : 0.0);
    };
    const double all = sum(0);
    return all > 0 ? (sum(k) - sum(k + 1)) / all : 0.0;
  };
  std::vector<ErrorShare> shares(squared.size());
  for (std::size_t k = 0; k < squared.size(); ++k) {
    shares[k].value = share(k, starts);
    double mean = 0, squares = 0;
    for (std::size_t s = 0; s < starts; ++s) mean += share(k, s) / static_cast<double>(starts);
    for (std::size_t s = 0; s < starts; ++s) {
      squares += (share(k, s) - mean) * (share(k, s) - mean);
    }
    const auto n = static_cast<double>(starts);
    shares[k].sd = std::sqrt((n - 1) / n * squares);
  }
  return shares;
}

}  // namespace flocklift
