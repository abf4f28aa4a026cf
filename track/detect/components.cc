// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/components.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace flocklift {
namespace {

// Appends the runs of one row. Empty stretches go by 32 bytes at a time.
void FindRuns(const std::uint8_t* row, int width, int v, std::vector<PixelRun>* runs) {
  int u = 0;
  while (u < width) {
    while (u + 32 <= width) {
      std::uint64_t words[4];
      std::memcpy(words, row + u, 32);
      if ((words[0] | words[1] | words[2] | words[3]) != 0) break;
      u += 32;
    }
    while (u + 8 <= width) {
      std::uint64_t eight;
      std::memcpy(&eight, row + u, 8);
      if (eight != 0) break;
      u += 8;
    }
    while (u < width && row[u] == 0) ++u;
    if (u == width) return;
    const int first = u;
    while (u < width && row[u] != 0) ++u;
    runs->push_back({v, first, u - 1});
  }
}

int Root(std::vector<int>* parent, int k) {
  while ((*parent)[k] != k) {
    (*parent)[k] = (*parent)[(*parent)[k]];
    k = (*parent)[k];
  }
  return k;
}

}  // namespace

Components FindComponents(const GrayImage& mask) {
  std::vector<PixelRun> runs;
  std::vector<int> parent;
  std::size_t above_begin = 0, above_end = 0;  // runs of the row above
  for (int v = 0; v < mask.height; ++v) {
    const std::size_t begin = runs.size();
    FindRuns(mask.Row(v), mask.width, v, &runs);
    std::size_t above = above_begin;
    for (std::size_t k = begin; k < runs.size(); ++k) {
      parent.push_back(static_cast<int>(k));
      while (above < above_end && runs[above].last + 1 < runs[k].first) ++above;
      for (std::size_t a = above; a < above_end && runs[a].first <= runs[k].last + 1; ++a) {
        const int x = Root(&parent, static_cast<int>(a)), y = Root(&parent, static_cast<int>(k));
        parent[std::max(x, y)] = std::min(x, y);
      }
    }
    above_begin = begin;
    above_end = runs.size();
  }

  // Number the roots, count their runs, then put each run where its component's stand.
  Components found;
  std::vector<Component>& components = found.components_;
  std::vector<int> index(runs.size(), -1), count;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const int root = Root(&parent, static_cast<int>(k));
    const PixelRun& run = runs[k];
    if (index[root] < 0) {
      index[root] = static_cast<int>(components.size());
      components.push_back({run.first, run.v, run.last, run.v, 0, {}});
      count.push_back(0);
    }
    index[k] = index[root];
    Component& c = components[index[k]];
    c.left = std::min(c.left, run.first);
    c.right = std::max(c.right, run.last);
    c.bottom = run.v;
    c.area += run.last - run.first + 1;
    ++count[index[k]];
  }
  found.runs_.resize(runs.size());
  std::vector<PixelRun*> next(components.size());
  PixelRun* at = found.runs_.data();
  for (std::size_t c = 0; c < components.size(); ++c) {
    components[c].runs = {at, static_cast<std::size_t>(count[c])};
    next[c] = at;
    at += count[c];
  }
  for (std::size_t k = 0; k < runs.size(); ++k) *next[index[k]]++ = runs[k];
  return found;
}

}  // namespace flocklift
