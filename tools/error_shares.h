// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A chain's final error, shared out among its stages by sequential substitution: the chain is run
// again from each stage on, with the truth put in for all that comes before. With E_k the rms error
// of the chain whose first stage that is not the truth's is k (E_1: none is the truth's),
//   share_k = (E_k^2 - E_{k+1}^2) / E_1^2,   E_{K+1} = 0
// of the final squared error: what stage k adds when those before it make no mistake and those
// after it work as they do. Shares sum to 1. Where errors of two stages interact, another order
// would share them out otherwise; a stage whose errors offset those of later ones has a negative
// share. sd by the jackknife over the moments that errors are of.

#ifndef FLOCKLIFT_TOOLS_ERROR_SHARES_H_
#define FLOCKLIFT_TOOLS_ERROR_SHARES_H_

#include <vector>

namespace flocklift {

struct ErrorShare {
  double value = 0, sd = 0;
};

// `squared` has a row for each stage, of sums of squared errors by moment, over the same animals in
// every row. Throws std::invalid_argument when rows differ in length.
std::vector<ErrorShare> SharesOf(const std::vector<std::vector<double>>& squared);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_ERROR_SHARES_H_
