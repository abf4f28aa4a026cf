// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/assignment.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Edge {
  int column = 0;
  double cost = 0;
};

}  // namespace

std::vector<int> Assign(int columns, std::span<const Candidate> candidates,
                        std::span<const double> alone) {
  const int rows = static_cast<int>(alone.size());
  std::vector<std::vector<Edge>> edges(rows);
  for (const Candidate& c : candidates) {
    Check(c.row >= 0 && c.row < rows && c.column >= 0 && c.column < columns,
          "a candidate's row or column is out of range");
    Check(std::isfinite(c.cost), "a candidate's cost is not finite");
    if (c.cost < alone[c.row]) edges[c.row].push_back({c.column, c.cost});
  }
  // Staying alone is a column of the row's own: columns + row.
  for (int row = 0; row < rows; ++row) edges[row].push_back({columns + row, alone[row]});

  const int all = columns + rows;
  std::vector<double> potential(all, 0), distance(all, kInfinity);
  std::vector<int> row_of(all, -1), column_of(rows, -1), from_row(all, -1);
  std::vector<double> taken_cost(rows, 0);  // of each row's present column
  std::vector<char> done(all, 0);
  std::vector<int> touched;
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;

  for (int start = 0; start < rows; ++start) {
    queue = {};
    touched.clear();
    int row = start, end = -1;
    double reached = 0;
    while (true) {
      // Reduced cost of leaving `row`; its present edge has reduced cost 0.
      const double base =
          row == start ? 0 : reached - (taken_cost[row] - potential[column_of[row]]);
      for (const Edge& edge : edges[row]) {
        if (done[edge.column]) continue;
        const double d = base + edge.cost - potential[edge.column];
        if (d < distance[edge.column]) {
          if (distance[edge.column] == kInfinity) touched.push_back(edge.column);
          distance[edge.column] = d;
          from_row[edge.column] = row;
          queue.emplace(d, edge.column);
        }
      }
      int column = -1;
      while (!queue.empty()) {
        const auto [d, c] = queue.top();
        queue.pop();
        if (!done[c] && d == distance[c]) {
          column = c;
          reached = d;
          break;
        }
      }
      FLOCKLIFT_DCHECK(column >= 0);
      done[column] = 1;
      if (row_of[column] < 0) {
        end = column;
        break;
      }
      row = row_of[column];
    }
    for (const int column : touched) {
      if (done[column]) potential[column] += distance[column] - reached;
      distance[column] = kInfinity;
      done[column] = 0;
    }
    for (int column = end; column >= 0;) {
      const int r = from_row[column];
      const int previous = column_of[r];
      column_of[r] = column;
      row_of[column] = r;
      taken_cost[r] = kInfinity;
      for (const Edge& edge : edges[r]) {
        if (edge.column == column) taken_cost[r] = std::min(taken_cost[r], edge.cost);
      }
      column = r == start ? -1 : previous;
    }
  }
  for (int& column : column_of) {
    if (column >= columns) column = -1;
  }
  return column_of;
}

}  // namespace flocklift
