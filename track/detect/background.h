// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sky behind the animals and its noise, from one frame alone: a local mean over a window wider
// than an animal, from which whatever stands out has been taken away,
//   B(x) = sum_w m I / sum_w m,   m = 0 where |I - B| > max(3 sd, least outlier) (repeated),
// and the noise's standard deviation by tile, 1.4826 median |I - B|. Clouds are smooth over the
// window and pass into B; a change of light between frames (a fade, the sun) changes B at once.

#ifndef FLOCKLIFT_TRACK_DETECT_BACKGROUND_H_
#define FLOCKLIFT_TRACK_DETECT_BACKGROUND_H_

#include <cstddef>
#include <vector>

#include "track/gray_image.h"

namespace flocklift {

// Two fields on a grid of width x height nodes that covers the image; node (i, j) stands at pixel
// ((i + 0.5) step - 0.5, (j + 0.5) step - 0.5).
struct LocalBackground {
  int width = 0, height = 0;
  int step = 1;              // [px]
  std::vector<float> level;  // [grey levels]
  std::vector<float> noise;  // sd of a pixel about the level [grey levels]

  // Bilinear in between, constant outside.
  double LevelAt(double x, double y) const { return Interpolate(level, x, y); }
  double NoiseAt(double x, double y) const { return Interpolate(noise, x, y); }

 private:
  double Interpolate(const std::vector<float>& field, double x, double y) const;
};

// The level at the pixels of an image, quickly: the rows are interpolated beforehand.
class LevelTable {
 public:
  LevelTable(const LocalBackground& background, int image_width, int image_height);

  float At(int u, int v) const {
    const Column& c = columns_[u];
    const float* row = rows_.data() + nodes_ * v + c.node;
    return row[0] + c.share * (row[1] - row[0]);
  }

 private:
  struct Column {
    int node;
    float share;  // of the node at its right
  };
  std::size_t nodes_;  // of a row, and one beyond
  std::vector<Column> columns_;
  std::vector<float> rows_;
};

// `window` [px] is the side of the local mean, three or so times the length of an animal.
// `least_noise` bounds the noise from below: a rendered sky has none. What differs by less than
// `least_outlier` [grey levels] stays in the mean: so do the curves of a cloud.
LocalBackground EstimateBackground(const GrayImage& image, double window, double least_noise,
                                   double least_outlier);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_BACKGROUND_H_
