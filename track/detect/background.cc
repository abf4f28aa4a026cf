// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/background.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr int kPasses = 3;
constexpr double kGridRows = 120;
constexpr double kMaskSds = 3;
constexpr int kLargePicture = 900;  // rows, of which every second one tells enough of the noise

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

// A node's value and its weight (0 or 1) in one number, so that one addition sums both: the value,
// 0 where the weight is, in the lower half, the weight in the upper half.
using Pairs = std::vector<std::uint64_t>;
constexpr int kWeightShift = 32;
float ValueOf(std::uint64_t pair) {
  return static_cast<float>(static_cast<std::int32_t>(static_cast<std::uint32_t>(pair)));
}
float WeightOf(std::uint64_t pair) {
  return static_cast<float>(static_cast<std::int32_t>(pair >> kWeightShift));
}

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

// Sums over a square of radius r, cut off at the border.
class BoxSums {
 public:
  BoxSums(int width, int height)
      : width_(width), height_(height), before_(static_cast<std::size_t>(width) + 1) {}

  void Compute(const Pairs& pairs, int radius, Pairs* sums) {
    const std::size_t w = static_cast<std::size_t>(width_);
    column_.assign(w, 0);
    sums->resize(w * height_);
    for (int v = -radius; v < height_; ++v) {
      if (v + radius < height_) {
        const std::uint64_t* row = pairs.data() + (v + radius) * w;
        for (std::size_t u = 0; u < w; ++u) column_[u] += row[u];
      }
      if (v - radius - 1 >= 0) {
        const std::uint64_t* row = pairs.data() + (v - radius - 1) * w;
        for (std::size_t u = 0; u < w; ++u) column_[u] -= row[u];
      }
      if (v >= 0) SumAlong(radius, sums->data() + v * w);
    }
  }

 private:
  void SumAlong(int radius, std::uint64_t* out) {
    before_[0] = 0;  // the sum of the columns before this one
    for (int u = 0; u < width_; ++u) before_[u + 1] = before_[u] + column_[u];
    for (int u = 0; u < width_; ++u) {
      out[u] = before_[std::min(u + radius + 1, width_)] - before_[std::max(u - radius, 0)];
    }
  }

  int width_, height_;
  Pairs column_, before_;
};

// Takes out the nodes that stand out by more than `limit`, and their neighbours.
void MaskOutliers(const Grid& values, const std::vector<float>& level, float limit, int width,
                  int height, Pairs* pairs) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    (*pairs)[k] = (std::uint64_t{1} << kWeightShift) + static_cast<std::uint64_t>(values[k]);
  }
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const std::size_t k = static_cast<std::size_t>(v) * width + u;
      if (std::abs(static_cast<float>(values[k]) - level[k]) <= limit) continue;
      for (int y = std::max(v - 1, 0); y <= std::min(v + 1, height - 1); ++y) {
        for (int x = std::max(u - 1, 0); x <= std::min(u + 1, width - 1); ++x) {
          (*pairs)[static_cast<std::size_t>(y) * width + x] = 0;
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

LevelTable::LevelTable(const LocalBackground& background, int image_width, int image_height)
    : nodes_(static_cast<std::size_t>(background.width) + 1),
      columns_(static_cast<std::size_t>(image_width)),
      rows_(nodes_ * static_cast<std::size_t>(image_height)) {
  const auto place = [&](double at, int count) {
    return std::clamp((at + 0.5) / background.step - 0.5, 0.0, count - 1.0);
  };
  for (int u = 0; u < image_width; ++u) {
    const double x = place(u, background.width);
    columns_[u] = {static_cast<int>(x), static_cast<float>(x - std::floor(x))};
  }
  for (int v = 0; v < image_height; ++v) {
    const double y = place(v, background.height);
    const int j = static_cast<int>(y);
    const auto share = static_cast<float>(y - j);
    const float* above = background.level.data() + static_cast<std::size_t>(j) * background.width;
    const float* below = j + 1 < background.height ? above + background.width : above;
    float* row = rows_.data() + nodes_ * v;
    for (int i = 0; i < background.width; ++i) row[i] = above[i] + share * (below[i] - above[i]);
    row[background.width] = row[background.width - 1];
  }
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
  Pairs pairs(values.size()), near, wide;
  const int radius = std::max(1, static_cast<int>(std::lround(0.5 * window / factor)));
  BoxSums sums(width, height);
  std::vector<float>& level = background.level;
  level.assign(values.begin(), values.end());
  float limit = std::numeric_limits<float>::infinity();
  for (int pass = 0; pass < kPasses; ++pass) {
    if (pass > 0) {
      AbsoluteHistogram residuals;
      for (std::size_t k = 0; k < values.size(); ++k) {
        residuals.Add(static_cast<float>(values[k]) - level[k]);
      }
      const double sd = kSdOfMedianAbsolute * residuals.Median();
      limit = static_cast<float>(std::max(kMaskSds * sd, least_outlier));
    }
    MaskOutliers(values, level, limit, width, height, &pairs);
    sums.Compute(pairs, radius, &near);
    sums.Compute(pairs, 4 * radius, &wide);
    for (std::size_t k = 0; k < values.size(); ++k) {
      // The wide window counts where the near one is nearly empty.
      const float wide_weight = WeightOf(wide[k]);
      const float share = wide_weight > 0 ? 1.0f / wide_weight : 0.0f;
      const float value = ValueOf(near[k]) + ValueOf(wide[k]) * share;
      const float weight = WeightOf(near[k]) + wide_weight * share;
      level[k] = weight > 0 ? value / weight : static_cast<float>(values[k]);
    }
  }

  // Noise by tile of about 8 x 6, from one pixel in some.
  const int tiles_x = std::max(1, std::min(8, image.width / 32));
  const int tiles_y = std::max(1, std::min(6, image.height / 32));
  const int row_step = image.height < kLargePicture ? 4 : 8;
  std::vector<AbsoluteHistogram> histograms(static_cast<std::size_t>(tiles_x) * tiles_y);
  for (int v = 1; v < image.height; v += row_step) {
    const std::uint8_t* row = image.Row(v);
    const float* levels = level.data() + static_cast<std::size_t>(v / factor) * background.width;
    AbsoluteHistogram* tile =
        histograms.data() + static_cast<std::size_t>(v * tiles_y / image.height) * tiles_x;
    int tile_end = image.width / tiles_x, cell_end = factor;
    for (int u = 1; u < image.width; u += 4) {
      while (u >= cell_end) {
        ++levels;
        cell_end += factor;
      }
      if (u >= tile_end && tile_end + image.width / tiles_x <= image.width) {
        ++tile;
        tile_end += image.width / tiles_x;
      }
      tile->Add(static_cast<float>(row[u]) - *levels);
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
