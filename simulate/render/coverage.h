// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How much of a silhouette each pixel sees. A pixel at (u, v) weighs the plane with
//   B(x - u) B(y - v),   B(t) = max(0, 1 - |t|),
// the extent of the pixel and the blur of a good lens. As the sum of k B(t - k) over the integers k
// is t itself, the centroid of the pixels is the centroid of the silhouette, wherever it lies and
// however small it is (with the area of each pixel alone, a bird inside one pixel would sit at its
// middle). Integrated in closed form along x, in strips of a quarter pixel, where B is straight,
// along y. Several exposures of one body add up in one mask: motion blur.

#ifndef FLOCKLIFT_SIMULATE_RENDER_COVERAGE_H_
#define FLOCKLIFT_SIMULATE_RENDER_COVERAGE_H_

#include <vector>

#include "simulate/render/silhouette.h"

namespace flocklift {

// A window of the image: pixels [left, left + width) x [top, top + height).
class CoverageMask {
 public:
  // The pixels that see something of `bounds`, inside an image of the given size; may be empty.
  CoverageMask(const Box& bounds, int image_width, int image_height);

  int left() const { return left_; }
  int top() const { return top_; }
  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return width_ == 0 || height_ == 0; }

  // Adds weight x the share that each pixel sees. What lies outside the window is cut off.
  void Add(const Silhouette& silhouette, double weight);

  // After the last Add: makes the rows.
  void Finish();
  // `width` shares of row v of the window, in [0, 1] when the weights added up to 1.
  const float* Row(int v) const { return rows_.data() + Offset(v); }
  float* Row(int v) { return rows_.data() + Offset(v); }

 private:
  std::size_t Offset(int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
  }
  void AddEdge(double x0, double x1, double height, float* row) const;

  int left_ = 0, top_ = 0, width_ = 0, height_ = 0;
  // Of each strip, as differences between neighbours: what is covered, and its first moment along y
  // about the strip's middle.
  std::vector<float> amounts_, moments_;
  std::vector<float> rows_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_COVERAGE_H_
