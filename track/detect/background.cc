// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/background.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
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
  // Values that follow each other mostly fall into one bin: by turns into its halves 0 and 1, so
  // that none waits for the one before.
  void Add(float value, std::size_t half) {
    const int bin = static_cast<int>(std::min(std::abs(value) + 0.5f, kBins - 1.0f));
    ++counts_[2 * static_cast<std::size_t>(bin) + half];
  }
  double Median() const {
    const int total = std::accumulate(counts_.begin(), counts_.end(), 0);
    int below = 0;
    for (int bin = 0; bin < kBins; ++bin) {
      const int count = counts_[2 * bin] + counts_[2 * bin + 1];
      if (count > 0 && 2L * (below + count) >= total) {
        const double share = (0.5 * total - below) / count;
        return bin == 0 ? 0.5 * share : bin - 0.5 + share;
      }
      below += count;
    }
    return 0;
  }

 private:
  static constexpr int kBins = 257;
  std::array<int, 2 * kBins> counts_{};
};

constexpr double kSdOfMedianAbsolute = 1.4826;  // of a normal distribution

// A field of small whole numbers on the grid, so that sums are exact.
using Grid = std::vector<int>;

// A node's value and its weight (0 or 1) in one number, so that one addition sums both: the value,
// 0 where the weight is, in the lower half, the weight in the upper half.
using Pairs = std::vector<std::uint64_t>;
constexpr int kWeightShift = 32;
int ValueOf(std::uint64_t pair) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(pair));
}
int WeightOf(std::uint64_t pair) { return static_cast<std::int32_t>(pair >> kWeightShift); }

// Means over cells of factor x factor pixels; those at the right and the bottom may be smaller.
Grid CellMeans(const GrayImage& image, int factor, int width, int height) {
  Grid means(static_cast<std::size_t>(width) * height);
  std::vector<std::uint16_t> column(static_cast<std::size_t>(image.width));
  int last_count = 0;
  double inverse = 0;
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
      if (count != last_count) inverse = 1.0 / (last_count = count);
      // (sum + count / 2) / count in whole numbers: the half keeps it off the rounding's edge.
      means[static_cast<std::size_t>(j) * width + i] =
          static_cast<int>((sum + count / 2 + 0.5) * inverse);
    }
  }
  return means;
}

// Sums over a square of radius r, cut off at the border.
class BoxSums {
 public:
  BoxSums(int width, int height) : width_(width), height_(height) {}

  void Compute(const Pairs& pairs, int radius, Pairs* sums) {
    const std::size_t w = static_cast<std::size_t>(width_);
    column_.assign(w, 0);
    before_.assign(w + 2 * static_cast<std::size_t>(radius) + 1, 0);
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
    // The sum of the columns before this one; as far beyond the border as the square reaches.
    std::uint64_t* before = before_.data() + radius;
    std::uint64_t sum = 0;
    for (int u = 0; u < width_; ++u) {
      before[u] = sum;
      sum += column_[u];
    }
    std::fill(before + width_, before + width_ + radius + 1, sum);
    for (int u = 0; u < width_; ++u) out[u] = before[u + radius + 1] - before[u - radius];
  }

  int width_, height_;
  Pairs column_, before_;
};

// All nodes, but those that stand out by more than a limit, and their neighbours.
class OrdinaryNodes {
 public:
  OrdinaryNodes(int width, int height)
      : width_(static_cast<std::size_t>(width)),
        height_(static_cast<std::size_t>(height)),
        stride_(width_ + 2),
        stands_out_(stride_ * (height_ + 2), 0),
        is_near_(stride_, 0) {}

  void Find(const Grid& values, const std::vector<float>& level, float limit, Pairs* pairs) {
    for (std::size_t v = 0; v < height_; ++v) {
      const int* value = values.data() + v * width_;
      const float* expected = level.data() + v * width_;
      std::uint8_t* out = stands_out_.data() + (v + 1) * stride_ + 1;
      for (std::size_t u = 0; u < width_; ++u) {
        out[u] = std::abs(static_cast<float>(value[u]) - expected[u]) > limit ? 1 : 0;
      }
    }
    for (std::size_t v = 0; v < height_; ++v) {
      const std::uint8_t* above = stands_out_.data() + v * stride_;
      for (std::size_t u = 0; u < stride_; ++u) {
        is_near_[u] =
            static_cast<std::uint8_t>(above[u] | above[stride_ + u] | above[2 * stride_ + u]);
      }
      const int* value = values.data() + v * width_;
      std::uint64_t* out = pairs->data() + v * width_;
      for (std::size_t u = 0; u < width_; ++u) {
        const int left_out = is_near_[u] | is_near_[u + 1] | is_near_[u + 2];
        const std::uint64_t all =
            (std::uint64_t{1} << kWeightShift) + static_cast<unsigned>(value[u]);
        out[u] = all & (static_cast<std::uint64_t>(left_out) - 1);  // no bit, or each
      }
    }
  }

 private:
  std::size_t width_, height_, stride_;
  std::vector<std::uint8_t> stands_out_;  // inside a border of zeros
  std::vector<std::uint8_t> is_near_;     // of one row: to one of the row itself, above or below
};

// The means over both squares; the wide one counts where the near one is nearly empty, and where
// that is empty too the node stands for itself.
void SetLevels(const Grid& values, const Pairs& near, const Pairs& wide,
               std::vector<float>* level) {
  const std::size_t count = values.size();
  float* out = level->data();
  for (std::size_t k = 0; k < count; ++k) {
    const int near_weight = WeightOf(near[k]), wide_weight = WeightOf(wide[k]);
    const float share = 1.0f / static_cast<float>(std::max(wide_weight, 1));
    const float value =
        static_cast<float>(ValueOf(near[k])) + static_cast<float>(ValueOf(wide[k])) * share;
    const float weight = static_cast<float>(near_weight) + static_cast<float>(wide_weight) * share;
    const auto empty = static_cast<float>((near_weight | wide_weight) == 0);  // value, weight: 0
    out[k] = (value + empty * static_cast<float>(values[k])) / (weight + empty);
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
  OrdinaryNodes ordinary(width, height);
  std::vector<float>& level = background.level;
  level.assign(values.begin(), values.end());
  float limit = std::numeric_limits<float>::infinity();
  for (int pass = 0; pass < kPasses; ++pass) {
    if (pass > 0) {
      AbsoluteHistogram residuals;
      for (std::size_t k = 0; k < values.size(); ++k) {
        residuals.Add(static_cast<float>(values[k]) - level[k], k & 1);
      }
      const double sd = kSdOfMedianAbsolute * residuals.Median();
      limit = static_cast<float>(std::max(kMaskSds * sd, least_outlier));
    }
    ordinary.Find(values, level, limit, &pairs);
    sums.Compute(pairs, radius, &near);
    sums.Compute(pairs, 4 * radius, &wide);
    SetLevels(values, near, wide, &level);
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
      tile->Add(static_cast<float>(row[u]) - *levels, u / 4 % 2);
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
