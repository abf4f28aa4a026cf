// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Connected components (8 neighbours) of a mask, by runs and union-find.

#ifndef FLOCKLIFT_TRACK_DETECT_COMPONENTS_H_
#define FLOCKLIFT_TRACK_DETECT_COMPONENTS_H_

#include <cstddef>
#include <span>
#include <vector>

#include "track/gray_image.h"

namespace flocklift {

// Pixels first .. last of row v.
struct PixelRun {
  int v = 0, first = 0, last = 0;
};

struct Component {
  int left = 0, top = 0, right = 0, bottom = 0;  // inclusive
  int area = 0;
  std::span<const PixelRun> runs;  // by row, then column; of `Components`
};

// Holds the runs of all, component by component.
class Components {
 public:
  Components() = default;
  Components(Components&&) = default;
  Components& operator=(Components&&) = default;

  auto begin() const { return components_.begin(); }
  auto end() const { return components_.end(); }
  std::size_t size() const { return components_.size(); }
  bool empty() const { return components_.empty(); }
  const Component& operator[](std::size_t k) const { return components_[k]; }

  // The components of the pixels that are not 0, in the order of their first pixel.
  friend Components FindComponents(const GrayImage& mask);

 private:
  std::vector<PixelRun> runs_;
  std::vector<Component> components_;
};

Components FindComponents(const GrayImage& mask);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_COMPONENTS_H_
