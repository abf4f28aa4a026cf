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
constexpr double kMaskSds = 3;

// Quantile of |values| by a histogram of 1/8 grey level.
class AbsoluteHistogram {
 public:
  void Add(float value) {
    ++counts_[static_cast<std::size_t>(std::min(std::abs(value) * 8.0f, kBins - 1.0f))];
    ++total_;
  }
  long total() const { return total_; }
  double Median() const {
    long below = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      if (2 * (below + counts_[bin]) >= total_) {
        const double share =
            counts_[bin] == 0 ? 0.5
                              : (0.5 * static_cast<double>(total_) - static_cast<double>(below)) /
                                    static_cast<double>(counts_[bin]);
        return (static_cast<double>(bin) + share) / 8;
      }
      below += counts_[bin];
    }
    return 0;
  }

 private:
  static constexpr std::size_t kBins = 2048;
  std::array<long, kBins> counts_{};
  long total_ = 0;
};

constexpr double kSdOfMedianAbsolute = 1.4826;  // of a normal distribution

double RobustSd(const cv::Mat& residual) {
  AbsoluteHistogram histogram;
  for (int v = 0; v < residual.rows; ++v) {
    const float* row = residual.ptr<float>(v);
    for (int u = 0; u < residual.cols; ++u) histogram.Add(row[u]);
  }
  return kSdOfMedianAbsolute * histogram.Median();
}

void LocalMean(const cv::Mat& in, int side, cv::Mat* out) {
  cv::boxFilter(in, *out, CV_32F, cv::Size(side, side), cv::Point(-1, -1), true,
                cv::BORDER_REFLECT_101);
}

// Mean of `image` where mask is 1, over `side`; where little is left, over a window 4 times as
// wide.
cv::Mat MaskedMean(const cv::Mat& image, const cv::Mat& mask, int side) {
  cv::Mat product, near_sum, near_weight, far_sum, far_weight;
  cv::multiply(image, mask, product);
  LocalMean(product, side, &near_sum);
  LocalMean(mask, side, &near_weight);
  const int wide = std::min(4 * side, 2 * (std::min(image.cols, image.rows) / 2) - 1) | 1;
  LocalMean(product, wide, &far_sum);
  LocalMean(mask, wide, &far_weight);
  cv::Mat mean = (near_sum + 0.02 * far_sum) / (near_weight + 0.02 * far_weight + 1e-6);
  return mean;
}

}  // namespace

double LocalBackground::Interpolate(const std::vector<float>& field, double x, double y) const {
  const double gx = std::clamp((x + 0.5) / step_x - 0.5, 0.0, width - 1.0);
  const double gy = std::clamp((y + 0.5) / step_y - 0.5, 0.0, height - 1.0);
  const int i = std::min(static_cast<int>(gx), std::max(width - 2, 0));
  const int j = std::min(static_cast<int>(gy), std::max(height - 2, 0));
  const double fx = gx - i, fy = gy - j;
  const int right = width > 1 ? 1 : 0;
  const std::size_t below = height > 1 ? static_cast<std::size_t>(width) : 0;
  const float* at = field.data() + static_cast<std::size_t>(j) * width + i;
  return (1 - fy) * ((1 - fx) * at[0] + fx * at[right]) +
         fy * ((1 - fx) * at[below] + fx * at[below + right]);
}

LocalBackground EstimateBackground(const GrayImage& image, double window, double least_noise) {
  FLOCKLIFT_DCHECK(image.width > 0 && image.height > 0);
  const cv::Mat full(image.height, image.width, CV_8UC1,
                     const_cast<std::uint8_t*>(image.pixels.data()));
  const int factor = std::max(1, static_cast<int>(std::lround(image.height / 180.0)));

  LocalBackground background;
  background.width = std::max(1, image.width / factor);
  background.height = std::max(1, image.height / factor);
  background.step_x = static_cast<double>(image.width) / background.width;
  background.step_y = static_cast<double>(image.height) / background.height;

  cv::Mat small, coarse;
  cv::resize(full, small, cv::Size(background.width, background.height), 0, 0, cv::INTER_AREA);
  small.convertTo(coarse, CV_32F);
  const int side = std::min(std::max(3, static_cast<int>(std::lround(window / factor))),
                            2 * (std::min(coarse.cols, coarse.rows) / 2) - 1) |
                   1;

  cv::Mat level;
  if (std::min(coarse.cols, coarse.rows) < 3) {
    level = cv::Mat(coarse.size(), CV_32F, cv::mean(coarse));
  } else {
    cv::Mat mask;
    LocalMean(coarse, side, &level);
    for (int pass = 0; pass < kPasses; ++pass) {
      const cv::Mat residual = coarse - level;
      const double limit = std::max(kMaskSds * RobustSd(residual), least_noise);
      cv::Mat far = cv::abs(residual) > limit;
      cv::dilate(far, far, cv::Mat());
      far.convertTo(mask, CV_32F, -1.0 / 255, 1.0);
      level = MaskedMean(coarse, mask, side);
    }
  }
  background.level.assign(level.ptr<float>(0), level.ptr<float>(0) + level.total());

  // Noise by tile of about 8 x 6, from one pixel in nine.
  const int tiles_x = std::max(1, std::min(8, image.width / 32));
  const int tiles_y = std::max(1, std::min(6, image.height / 32));
  std::vector<AbsoluteHistogram> histograms(static_cast<std::size_t>(tiles_x) * tiles_y);
  for (int v = 1; v < image.height; v += 3) {
    const std::uint8_t* row = image.Row(v);
    const int tile_y = v * tiles_y / image.height;
    const int j = std::min(static_cast<int>(v / background.step_y), background.height - 1);
    const float* levels = level.ptr<float>(j);
    for (int u = 1; u < image.width; u += 3) {
      const int i = std::min(static_cast<int>(u / background.step_x), background.width - 1);
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
  cv::resize(tiles, noise, coarse.size(), 0, 0, cv::INTER_LINEAR);
  background.noise.assign(noise.ptr<float>(0), noise.ptr<float>(0) + noise.total());
  return background;
}

}  // namespace flocklift
