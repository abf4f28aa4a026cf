// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The cheapest assignment of rows to columns over sparse candidates, exact: every row takes one
// column that no other row takes, or stays alone at its own price,
//   min  sum_{(i, j) taken} cost_ij + sum_{i alone} alone_i.
// Shortest augmenting paths with potentials (Jonker, Volgenant, "A shortest augmenting path
// algorithm for dense and sparse linear assignment problems", Computing 38, 1987). A search never
// leaves its row's connected component of the candidate graph, and ends at the first way out, so
// the cost is that of many small problems; no matrix is formed.

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_ASSIGNMENT_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_ASSIGNMENT_H_

#include <span>
#include <vector>

namespace flocklift {

struct Candidate {
  int row = 0, column = 0;
  double cost = 0;  // finite, of any sign
};

// Returns the column of each row, -1 where it stays alone. `alone` has one price a row; columns
// are 0 .. columns - 1. Throws std::invalid_argument for an index out of range.
std::vector<int> Assign(int columns, std::span<const Candidate> candidates,
                        std::span<const double> alone);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_ASSIGNMENT_H_
