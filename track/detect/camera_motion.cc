// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr double kWorkingHeight = 540;  // [px]: larger pictures are halved until they are below
constexpr int kMostCorners = 150;
constexpr double kLeastQuality = 0.03;  // of a corner, to the best one
constexpr double kCornerDistance = 16;  // [px]
constexpr double kMargin = 4;           // around an animal [px]
constexpr std::size_t kLeastCorners = 12;
constexpr double kLeastAgreement = 0.6;  // of the corners that were followed
constexpr double kInlier = 0.5;          // [px]
constexpr double kMostZoom = 0.03;       // between two frames
constexpr double kLeastSpread = 0.15;    // of the picture's diagonal that the corners span
constexpr int kProbeInterval = 8;        // frames,
constexpr int kMostProbeInterval = 64;   // twice as many each time, after
constexpr int kQuietProbes = 4;          // in a row without motion
constexpr int kProbesThatTell = 2;
constexpr double kMoves = 0.35;  // [px] between two frames

cv::Mat Smaller(const GrayImage& image, int* factor) {
  const cv::Mat full(image.height, image.width, CV_8UC1,
                     const_cast<std::uint8_t*>(image.pixels.data()));
  *factor = 1;
  while (image.height / *factor > kWorkingHeight) *factor *= 2;
  if (*factor == 1) return full;
  cv::Mat small;
  cv::resize(full, small, cv::Size(image.width / *factor, image.height / *factor), 0, 0,
             cv::INTER_AREA);
  return small;
}

// The animals and what is near them, as 0.
cv::Mat MaskOf(const BlobFrame& found, const cv::Size& size, int factor) {
  cv::Mat mask(size, CV_8UC1, cv::Scalar(255));
  for (const Blob& blob : found.blobs) {
    const cv::Point low(static_cast<int>((blob.box.left - kMargin) / factor) - 1,
                        static_cast<int>((blob.box.top - kMargin) / factor) - 1);
    const cv::Point high(static_cast<int>((blob.box.left + blob.box.width + kMargin) / factor) + 1,
                         static_cast<int>((blob.box.top + blob.box.height + kMargin) / factor) + 1);
    cv::rectangle(mask, low, high, cv::Scalar(0), cv::FILLED);
  }
  return mask;
}

double SpreadOf(const std::vector<cv::Point2f>& points) {
  const cv::Rect2f box = cv::boundingRect(points);
  return std::hypot(box.width, box.height);
}

// How far a point of the picture moves at most [px].
double LargestShift(const Similarity& motion, int width, int height) {
  double most = 0;
  for (const double x : {0.0, width - 1.0}) {
    for (const double y : {0.0, height - 1.0}) {
      const Vec2d p = motion * Vec2d{x, y};
      most = std::max(most, std::hypot(p.x - x, p.y - y));
    }
  }
  return most;
}

}  // namespace

std::optional<Similarity> MotionBetween(const GrayImage& before, const BlobFrame& found,
                                        const GrayImage& now) {
  int factor = 1;
  const cv::Mat a = Smaller(before, &factor), b = Smaller(now, &factor);
  std::vector<cv::Point2f> corners, followed;
  cv::goodFeaturesToTrack(a, corners, kMostCorners, kLeastQuality, kCornerDistance,
                          MaskOf(found, a.size(), factor));
  if (corners.size() < kLeastCorners) return std::nullopt;
  std::vector<std::uint8_t> is_found;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(a, b, corners, followed, is_found, error, cv::Size(15, 15), 3);
  std::vector<cv::Point2f> from, to;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (is_found[k] == 0) continue;
    from.push_back(corners[k]);
    to.push_back(followed[k]);
  }
  if (from.size() < kLeastCorners) return std::nullopt;
  std::vector<std::uint8_t> agrees;
  const cv::Mat m = cv::estimateAffinePartial2D(from, to, agrees, cv::RANSAC, kInlier, 500, 0.995);
  if (m.empty()) return std::nullopt;
  std::vector<cv::Point2f> inliers;
  for (std::size_t k = 0; k < agrees.size(); ++k) {
    if (agrees[k] != 0) inliers.push_back(from[k]);
  }
  const double diagonal = std::hypot(a.cols, a.rows);
  if (inliers.size() < kLeastCorners ||
      static_cast<double>(inliers.size()) < kLeastAgreement * static_cast<double>(from.size()) ||
      SpreadOf(inliers) < kLeastSpread * diagonal) {
    return std::nullopt;
  }
  Similarity motion{m.at<double>(0, 0), m.at<double>(1, 0), m.at<double>(0, 2), m.at<double>(1, 2)};
  if (std::abs(std::hypot(motion.a, motion.b) - 1) > kMostZoom) return std::nullopt;
  // Pixel u of the small picture is pixels f u .. f u + f - 1 of the large one.
  const double f = factor, c = 0.5 * (f - 1);
  const Vec2d t{f * motion.tx + c - (motion.a - motion.b) * c,
                f * motion.ty + c - (motion.b + motion.a) * c};
  motion.tx = t.x;
  motion.ty = t.y;
  return motion;
}

CameraMotion::CameraMotion(const CameraMotionOptions& options) {
  Check(options.camera == "auto" || options.camera == "rests" || options.camera == "moves",
        "option camera-motion is " + options.camera + ", allowed are rests, moves and auto");
  is_auto_ = options.camera == "auto";
  moves_ = options.camera == "moves";
  interval_ = kProbeInterval;
  until_probe_ = interval_ - 1;
}

Similarity CameraMotion::Next(const GrayImage& image, const BlobFrame& found) {
  if (!is_auto_ && !moves_) return {};
  if (has_before_) {
    const auto motion = MotionBetween(before_, before_found_, image);
    if (moves_) {
      if (motion) world_from_image_ = world_from_image_ * motion->Inverse();
    } else {
      Probe(motion && LargestShift(*motion, image.width, image.height) > kMoves);
    }
  }
  has_before_ = moves_ || --until_probe_ == 0;
  if (has_before_) {
    before_ = image;
    before_found_.blobs = found.blobs;
  }
  return world_from_image_;
}

void CameraMotion::Probe(bool is_moving) {
  if (is_moving) {
    moves_ = ++seen_moving_ == kProbesThatTell;
    quiet_ = 0;
    interval_ = kProbeInterval;
  } else if (++quiet_ >= kQuietProbes) {
    interval_ = std::min(2 * interval_, kMostProbeInterval);
  }
  until_probe_ = interval_;
}

void CameraMotion::Save(StateWriter* state) const {
  state->Put(moves_);
  for (const int value : {until_probe_, interval_, seen_moving_, quiet_}) state->Put(value);
  state->Put(world_from_image_);
  state->Put(has_before_);
  if (!has_before_) return;
  state->Put(before_.width);
  state->Put(before_.height);
  state->Put(before_.pixels);
  state->Put(static_cast<std::uint64_t>(before_found_.blobs.size()));
  for (const Blob& blob : before_found_.blobs) state->Put(blob.box);
}

void CameraMotion::Load(StateReader* state) {
  state->Take(&moves_);
  for (int* value : {&until_probe_, &interval_, &seen_moving_, &quiet_}) state->Take(value);
  state->Take(&world_from_image_);
  state->Take(&has_before_);
  if (!has_before_) return;
  int width = 0, height = 0;
  state->Take(&width);
  state->Take(&height);
  before_ = GrayImage(width, height);
  state->Take(&before_.pixels);
  std::uint64_t count = 0;
  state->Take(&count);
  before_found_.blobs.assign(count, {});
  for (Blob& blob : before_found_.blobs) state->Take(&blob.box);
}

}  // namespace flocklift
