// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/background.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr int kPasses = 3;
constexpr double kGridRows = 120;
constexpr double kMaskSds = 3;

// Median of |values|, where the values were rounded to whole grey levels: each stands for all that
// is nearest to it.
class AbsoluteHistogram {
 public:
  void Add(float value) {
    ++counts_[static_cast<std::size_t>(std::min(std::abs(value) + 0.5f, kBins - 1.0f))];
    ++total_;
  }
  double Median() const {
    int below = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      const int count = counts_[bin];
      if (count > 0 && 2L * (below + count) >= total_) {
        const double share = (0.5 * total_ - below) / count;
        return bin == 0 ? 0.5 * share : static_cast<double>(bin) - 0.5 + share;
      }
      below += count;
    }
    return 0;
  }

 private:
  static constexpr std::size_t kBins = 257;
  std::array<int, kBins> counts_{};
  int total_ = 0;
};

constexpr double kSdOfMedianAbsolute = 1.4826;  // of a normal distribution

// A field of small whole numbers on the grid, so that sums are exact.
using Grid = std::vector<int>;

// Means over cells of factor x factor pixels; those at the right and the bottom may be smaller.
Grid CellMeans(const GrayImage& image, int factor, int width, int height) {
  Grid means(static_cast<std::size_t>(width) * height);
  std::vector<std::uint16_t> column(static_cast<std::size_t>(image.width));
  for (int j = 0; j < height; ++j) {
    std::fill(column.begin(), column.end(), std::uint16_t{0});
    const int top = j * factor, bottom = std::min(top + factor, image.height);
    for (int v = top; v < bottom; ++v) {
      const std::uint8_t* row = image.Row(v);
      for (int u = 0; u < image.width; ++u)
        column[u] = static_cast<std::uint16_t>(column[u] + row[u]);
    }
    for (int i = 0; i < width; ++i) {
      const int left = i * factor, right = std::min(left + factor, image.width);
      int sum = 0;
      for (int u = left; u < right; ++u) sum += column[u];
      const int count = (right - left) * (bottom - top);
      means[static_cast<std::size_t>(j) * width + i] = (sum + count / 2) / count;
    }
  }
  return means;
}

// Sums over a square of radius r, cut off at the border, of `values` and of `weights` (0 or 1).
class BoxSums {
 public:
  BoxSums(int width, int height) : width_(width), height_(height) {}

  void Compute(const Grid& values, const Grid& weights, int radius, Grid* value_sums,
               Grid* weight_sums) {
    const std::size_t w = static_cast<std::size_t>(width_);
    value_column_.assign(w, 0);
    weight_column_.assign(w, 0);
    value_sums->resize(w * height_);
    weight_sums->resize(w * height_);
    for (int v = -radius; v < height_; ++v) {
      if (v + radius < height_) AddRow(values, weights, v + radius, 1);
      if (v - radius - 1 >= 0) AddRow(values, weights, v - radius - 1, -1);
      if (v < 0) continue;
      SlideAlong(value_column_, radius, value_sums->data() + v * w);
      SlideAlong(weight_column_, radius, weight_sums->data() + v * w);
    }
  }

 private:
  void AddRow(const Grid& values, const Grid& weights, int v, int sign) {
    const int* value = values.data() + static_cast<std::size_t>(v) * width_;
    const int* weight = weights.data() + static_cast<std::size_t>(v) * width_;
    for (int u = 0; u < width_; ++u) {
      value_column_[u] += sign * value[u] * weight[u];
      weight_column_[u] += sign * weight[u];
    }
  }

  void SlideAlong(const Grid& column, int radius, int* out) const {
    int sum = 0;
    for (int u = 0; u < std::min(radius, width_); ++u) sum += column[u];
    for (int u = 0; u < width_; ++u) {
      if (u + radius < width_) sum += column[u + radius];
      out[u] = sum;
      if (u - radius >= 0) sum -= column[u - radius];
    }
  }

  int width_, height_;
  Grid value_column_, weight_column_;
};

// Marks the nodes that stand out by more than `limit`, and their neighbours, with weight 0.
void MaskOutliers(const Grid& values, const std::vector<float>& level, float limit, int width,
                  int height, Grid* weights) {
  std::fill(weights->begin(), weights->end(), 1);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const std::size_t k = static_cast<std::size_t>(v) * width + u;
      if (std::abs(static_cast<float>(values[k]) - level[k]) <= limit) continue;
      for (int y = std::max(v - 1, 0); y <= std::min(v + 1, height - 1); ++y) {
        for (int x = std::max(u - 1, 0); x <= std::min(u + 1, width - 1); ++x) {
          (*weights)[static_cast<std::size_t>(y) * width + x] = 0;
        }
      }
    }
  }
}

}  // namespace

double LocalBackground::Interpolate(const std::vector<float>& field, double x, double y) const {
  const double gx = std::clamp((x + 0.5) / step - 0.5, 0.0, width - 1.0);
  const double gy = std::clamp((y + 0.5) / step - 0.5, 0.0, height - 1.0);
  const int i = std::min(static_cast<int>(gx), std::max(width - 2, 0));
  const int j = std::min(static_cast<int>(gy), std::max(height - 2, 0));
  const double fx = gx - i, fy = gy - j;
  const int right = width > 1 ? 1 : 0;
  const std::size_t below = height > 1 ? static_cast<std::size_t>(width) : 0;
  const float* at = field.data() + static_cast<std::size_t>(j) * width + i;
  return (1 - fy) * ((1 - fx) * at[0] + fx * at[right]) +
         fy * ((1 - fx) * at[below] + fx * at[below + right]);
}

LocalBackground EstimateBackground(const GrayImage& image, double window, double least_noise,
                                   double least_outlier) {
  FLOCKLIFT_DCHECK(image.width > 0 && image.height > 0);
  const int factor = std::max(1, static_cast<int>(std::lround(image.height / kGridRows)));

  LocalBackground background;
  const int width = background.width = (image.width + factor - 1) / factor;
  const int height = background.height = (image.height + factor - 1) / factor;
  background.step = factor;
  const Grid values = CellMeans(image, factor, width, height);
  Grid weights(values.size(), 1), near_value, near_weight, wide_value, wide_weight;
  const int radius = std::max(1, static_cast<int>(std::lround(0.5 * window / factor)));
  BoxSums sums(width, height);
  std::vector<float>& level = background.level;
  level.resize(values.size());
  for (int pass = 0; pass < kPasses; ++pass) {
    if (pass > 0) {
      AbsoluteHistogram residuals;
      for (std::size_t k = 0; k < values.size(); ++k) {
        residuals.Add(static_cast<float>(values[k]) - level[k]);
      }
      const double sd = kSdOfMedianAbsolute * residuals.Median();
      MaskOutliers(values, level, static_cast<float>(std::max(kMaskSds * sd, least_outlier)), width,
                   height, &weights);
    }
    sums.Compute(values, weights, radius, &near_value, &near_weight);
    sums.Compute(values, weights, 4 * radius, &wide_value, &wide_weight);
    for (std::size_t k = 0; k < values.size(); ++k) {
      // The wide window counts where the near one is nearly empty.
      const float wide = wide_weight[k] > 0 ? 1.0f / static_cast<float>(wide_weight[k]) : 0.0f;
      const float value =
          static_cast<float>(near_value[k]) + static_cast<float>(wide_value[k]) * wide;
      const float weight =
          static_cast<float>(near_weight[k]) + static_cast<float>(wide_weight[k]) * wide;
      level[k] = weight > 0 ? value / weight : static_cast<float>(values[k]);
    }
  }

  // Noise by tile of about 8 x 6, from one pixel in sixteen.
  const int tiles_x = std::max(1, std::min(8, image.width / 32));
  const int tiles_y = std::max(1, std::min(6, image.height / 32));
  std::vector<AbsoluteHistogram> histograms(static_cast<std::size_t>(tiles_x) * tiles_y);
  for (int v = 1; v < image.height; v += 4) {
    const std::uint8_t* row = image.Row(v);
    const int tile_y = v * tiles_y / image.height;
    const int j = v / factor;
    const float* levels = level.data() + static_cast<std::size_t>(j) * background.width;
    for (int u = 1; u < image.width; u += 4) {
      const int i = u / factor;
      histograms[static_cast<std::size_t>(tile_y) * tiles_x + u * tiles_x / image.width].Add(
          static_cast<float>(row[u]) - levels[i]);
    }
  }
  cv::Mat tiles(tiles_y, tiles_x, CV_32F);
  for (int j = 0; j < tiles_y; ++j) {
    for (int i = 0; i < tiles_x; ++i) {
      tiles.at<float>(j, i) = static_cast<float>(std::max(
          least_noise,
          kSdOfMedianAbsolute * histograms[static_cast<std::size_t>(j) * tiles_x + i].Median()));
    }
  }
  cv::Mat noise;
  cv::resize(tiles, noise, cv::Size(width, height), 0, 0, cv::INTER_LINEAR);
  background.noise.assign(noise.ptr<float>(0), noise.ptr<float>(0) + noise.total());
  return background;
}

}  // namespace flocklift
