// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/density_flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

constexpr std::size_t kLearnImages = 12;
constexpr int kCell = 64;  // [px]: enough animals for a correlation
constexpr double kLeastResponse = 0.05;
constexpr double kLeastCount = 0.5;  // of a cell
constexpr double kMostShift = 0.4;   // of a cell: a larger one is chance

double MedianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The mass of one animal: the lowest peak of the masses of patches that is half as high as the
// highest, as in a dense flock two together may be as common as one. Quarter octaves, three bins
// together.
class MassMode {
 public:
  void Add(double mass) {
    const double bin = 4 * std::log2(std::max(mass, 1.0)) + 0.5;
    ++counts_[std::min(static_cast<std::size_t>(bin), kBins - 1)];
  }
  double Mode() const {
    std::array<long, kBins> sums{};
    for (std::size_t k = 1; k + 1 < kBins; ++k) {
      sums[k] = counts_[k - 1] + counts_[k] + counts_[k + 1];
    }
    const long most = *std::max_element(sums.begin(), sums.end());
    std::size_t k = 1;
    while (k + 2 < kBins && (2 * sums[k] < most || sums[k + 1] > sums[k])) ++k;
    return std::exp2(0.25 * static_cast<double>(k));
  }

 private:
  static constexpr std::size_t kBins = 100;
  std::array<long, kBins> counts_{};
};

class Meter {
 public:
  Meter(int width, int height, DensityFlow* flow)
      : columns_(width / kCell), rows_(height / kCell), flow_(flow) {
    Check(columns_ > 0 && rows_ > 0, "the picture is smaller than a cell");
    cv::createHanningWindow(hann_, cv::Size(kCell, kCell), CV_32F);
    left_ = (width - columns_ * kCell) / 2;
    top_ = (height - rows_ * kCell) / 2;
  }

  // Two consecutive frames. Masses are in grey levels until Finish.
  void Add(int frame, const cv::Mat& now, const cv::Mat& next) {
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < columns_; ++i) {
        const cv::Rect where(left_ + i * kCell, top_ + j * kCell, kCell, kCell);
        FlowCell cell;
        cell.frame = frame;
        cell.center = {where.x + 0.5 * (kCell - 1), where.y + 0.5 * (kCell - 1)};
        cell.count = cv::sum(now(where))[0];
        if (cell.count <= 0) continue;
        double response = 0;
        // Copies: the transform must not read beyond the cell.
        const cv::Point2d shift =
            cv::phaseCorrelate(now(where).clone(), next(where).clone(), hann_, &response);
        if (response >= kLeastResponse && std::hypot(shift.x, shift.y) <= kMostShift * kCell) {
          cell.velocity = Vec2d{shift.x, shift.y};
        }
        flow_->cells.push_back(cell);
      }
    }
  }

  void Finish(double unit) {
    for (FlowCell& cell : flow_->cells) cell.count /= unit;
    std::erase_if(flow_->cells, [](const FlowCell& c) { return c.count < kLeastCount; });
    std::vector<double> counts, densities, speeds, orders;
    for (std::size_t first = 0; first < flow_->cells.size();) {
      double count = 0, moving = 0;
      Vec2d sum{};
      std::size_t k = first;
      for (; k < flow_->cells.size() && flow_->cells[k].frame == flow_->cells[first].frame; ++k) {
        const FlowCell& cell = flow_->cells[k];
        count += cell.count;
        densities.push_back(cell.count / (kCell * kCell));
        if (!cell.velocity) continue;
        const double speed = std::hypot(cell.velocity->x, cell.velocity->y);
        speeds.push_back(speed);
        if (speed <= 0) continue;
        moving += cell.count;
        sum.x += cell.count * cell.velocity->x / speed;
        sum.y += cell.count * cell.velocity->y / speed;
      }
      counts.push_back(count);
      if (moving > 0) orders.push_back(std::hypot(sum.x, sum.y) / moving);
      first = k;
    }
    flow_->cell = kCell;
    flow_->median_count = MedianOf(counts);
    flow_->median_density = MedianOf(densities);
    flow_->median_speed = MedianOf(speeds);
    double total = 0;
    for (const double order : orders) total += order;
    if (!orders.empty()) flow_->polarisation = total / static_cast<double>(orders.size());
  }

 private:
  int columns_, rows_, left_ = 0, top_ = 0;
  cv::Mat hann_;
  DensityFlow* flow_;
};

}  // namespace

DensityFlow MeasureDensityFlow(const DetectorOptions& options, const std::filesystem::path& path,
                               const Progress& progress, int stride) {
  Check(stride >= 2, "pairs of frames need a stride of 2 at least");
  DetectorOptions all = options;
  all.min_area = 1;
  if (all.window <= 0) all.window = kCell;  // amid a dense flock, sky is only farther away
  Detector detector(all);
  {
    VideoSource start(path);
    std::vector<GrayImage> some;
    for (GrayImage image; some.size() < kLearnImages && start.Read(&image);) some.push_back(image);
    ThreadPool pool(0);
    detector.Learn(some, &pool);
  }
  VideoSource video(path);
  DensityFlow flow;
  flow.stride = stride;
  Meter meter(video.width(), video.height(), &flow);
  MassMode masses;
  GrayImage image;
  cv::Mat now;
  for (int frame = 1; video.Read(&image); ++frame) {
    const int phase = (frame - 1) % stride;
    if (phase <= 1) {
      const BlobFrame found = detector.Detect(frame, image);
      for (const Blob& blob : found.blobs) masses.Add(blob.mass);
      // Not that of the blobs: where a flock is dense, patches are larger than an animal can be.
      std::vector<float> values = detector.ContrastOf(image);
      const cv::Mat contrast = cv::Mat(image.height, image.width, CV_32F, values.data()).clone();
      if (phase == 1) meter.Add(frame - 1, now, contrast);
      now = contrast;
    }
    Report(progress, frame, video.frame_count().value_or(0));
  }
  meter.Finish(masses.Mode());
  return flow;
}

void WriteDensityFlow(const std::filesystem::path& path, const DensityFlow& flow) {
  std::string text = "frame,x,y,count,u,v\n";
  for (const FlowCell& c : flow.cells) {
    text += fmt::format("{},{:.1f},{:.1f},{:.2f},", c.frame, c.center.x, c.center.y, c.count);
    text += c.velocity ? fmt::format("{:.3f},{:.3f}\n", c.velocity->x, c.velocity->y) : ",\n";
  }
  WriteTextFile(path, text);
}

}  // namespace flocklift
