// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/metrics/matching.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Minimises the sum of cost = -weight over the rows, each of which takes one of its columns or its
// private column of cost 0. Invariant: cost - row_price - column_price >= 0 on every edge, = 0 on
// the matched ones; columns that are free have price 0, private columns always.
class Matcher {
 public:
  explicit Matcher(std::span<const WeightedPair> pairs) : pairs_(pairs) {
    int rows = 0, columns = 0;
    for (const WeightedPair& pair : pairs) {
      Check(pair.row >= 0 && pair.column >= 0, "rows and columns of a matching count from 0");
      rows = std::max(rows, pair.row + 1);
      columns = std::max(columns, pair.column + 1);
    }
    first_edge_.assign(rows + 1, 0);
    for (const WeightedPair& pair : pairs) ++first_edge_[pair.row + 1];
    for (int row = 0; row < rows; ++row) first_edge_[row + 1] += first_edge_[row];
    edges_.resize(pairs.size());
    std::vector<int> next = first_edge_;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      edges_[next[pairs[k].row]++] = static_cast<int>(k);
    }
    row_price_.assign(rows, 0);
    for (const WeightedPair& pair : pairs) {
      row_price_[pair.row] = std::min(row_price_[pair.row], -pair.weight);
    }
    column_price_.assign(columns, 0);
    matched_edge_of_column_.assign(columns, -1);
    matched_edge_of_row_.assign(rows, -1);
    distance_.assign(columns, kInfinity);
    edge_to_.assign(columns, -1);
    settled_.assign(columns, false);
  }

  std::vector<int> Solve() {
    for (int row = 0; row < static_cast<int>(row_price_.size()); ++row) Augment(row);
    std::vector<int> chosen;
    for (const int edge : matched_edge_of_row_) {
      if (edge >= 0) chosen.push_back(edge);
    }
    return chosen;
  }

 private:
  // Dijkstra from a row without partner to the nearest free column, private ones included.
  void Augment(int start) {
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>>
        queue;
    touched_.clear();
    settled_columns_.clear();
    double shortest = kInfinity;
    int end_column = -1, end_row = -1;  // the path's end: a free column, or a row's private column
    int row = start;
    double row_distance = 0;
    while (true) {
      if (row_distance - row_price_[row] < shortest) {
        shortest = row_distance - row_price_[row];
        end_row = row;
      }
      for (int k = first_edge_[row]; k < first_edge_[row + 1]; ++k) {
        const WeightedPair& pair = pairs_[edges_[k]];
        if (!(pair.weight > 0) || settled_[pair.column]) continue;
        const double distance =
            row_distance - pair.weight - row_price_[row] - column_price_[pair.column];
        if (distance >= distance_[pair.column] || distance >= shortest) continue;
        if (distance_[pair.column] == kInfinity) touched_.push_back(pair.column);
        distance_[pair.column] = distance;
        edge_to_[pair.column] = edges_[k];
        queue.emplace(distance, pair.column);
      }
      while (!queue.empty() && queue.top().first > distance_[queue.top().second]) queue.pop();
      if (queue.empty() || queue.top().first >= shortest) break;
      const auto [distance, column] = queue.top();
      queue.pop();
      if (settled_[column]) continue;
      if (matched_edge_of_column_[column] < 0) {
        shortest = distance;
        end_column = column;
        break;
      }
      settled_[column] = true;
      settled_columns_.push_back(column);
      row = pairs_[matched_edge_of_column_[column]].row;
      row_distance = distance;
    }
    Reprice(start, shortest);
    Flip(start, end_column, end_row);
    for (const int column : touched_) {
      distance_[column] = kInfinity;
      settled_[column] = false;
    }
  }

  void Reprice(int start, double shortest) {
    row_price_[start] += shortest;
    for (const int column : settled_columns_) {
      column_price_[column] -= shortest - distance_[column];
      row_price_[pairs_[matched_edge_of_column_[column]].row] += shortest - distance_[column];
    }
  }

  // Exchanges matched and unmatched edges along the path that ends in `column`, or in the private
  // column of `end_row`.
  void Flip(int start, int column, int end_row) {
    if (column < 0) {
      if (end_row == start) return;
      const int freed = matched_edge_of_row_[end_row];
      matched_edge_of_row_[end_row] = -1;
      column = pairs_[freed].column;
    }
    while (true) {
      const int edge = edge_to_[column];
      const int row = pairs_[edge].row;
      const int previous = matched_edge_of_row_[row];
      matched_edge_of_row_[row] = edge;
      matched_edge_of_column_[column] = edge;
      if (row == start) return;
      column = pairs_[previous].column;
    }
  }

  std::span<const WeightedPair> pairs_;
  std::vector<int> first_edge_, edges_;  // edges of row r: edges_[first_edge_[r] .. [r + 1])
  std::vector<double> row_price_, column_price_;
  std::vector<int> matched_edge_of_row_, matched_edge_of_column_;
  std::vector<double> distance_;  // from the start of the path, by column
  std::vector<int> edge_to_;      // the last edge of the shortest path, by column
  std::vector<bool> settled_;
  std::vector<int> touched_, settled_columns_;
};

}  // namespace

std::vector<int> MaximumWeightMatching(std::span<const WeightedPair> pairs) {
  return Matcher(pairs).Solve();
}

}  // namespace flocklift
