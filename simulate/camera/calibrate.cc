// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/calibrate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <string>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

int FlagsFor(int distortion) {
  switch (distortion) {
    case 0:
      return cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_K1 | cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3;
    case 4:
      return cv::CALIB_FIX_K3;
    case 8:
      return cv::CALIB_RATIONAL_MODEL;
    case 12:
      return cv::CALIB_RATIONAL_MODEL | cv::CALIB_THIN_PRISM_MODEL;
    default:
      return 0;
  }
}

// The views that are kept, as OpenCV wants them.
struct Corners {
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> pixels;
  cv::Size size;

  Corners(const std::vector<BoardView>& views, const std::vector<bool>& kept, cv::Size image)
      : size(image) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (!kept[i]) continue;
      auto& points = on_board.emplace_back();
      auto& corners = pixels.emplace_back();
      for (std::size_t k = 0; k < views[i].pixels.size(); ++k) {
        const Vec3d& p = views[i].on_board[k];
        const Vec2d& q = views[i].pixels[k];
        points.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y),
                            static_cast<float>(p.z));
        corners.emplace_back(static_cast<float>(q.x), static_cast<float>(q.y));
      }
    }
  }
  double count() const {
    double sum = 0;
    for (const auto& view : pixels) sum += static_cast<double>(view.size());
    return sum;
  }
};

const cv::TermCriteria kUntil(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-10);

// Two residuals a corner, less four intrinsics, the distortion, and a pose per view.
double DegreesOfFreedom(const Corners& corners, int distortion) {
  const double parameters = 4.0 + distortion + 6.0 * static_cast<double>(corners.pixels.size());
  return std::max(2 * corners.count() - parameters, 1.0);
}

// Relative standard deviation of the focal length, from how fast the squared residuals grow when it
// is held off its best value and all else follows. (The covariance that OpenCV inverts looks small
// where the focal length is not determined at all.)
double ProfileFocalSd(const Corners& corners, const Calibration& best, int distortion) {
  constexpr double kOffset = 0.01;
  const Intrinsics& k = best.camera.intrinsics;
  const double n = corners.count();
  double least_growth = std::numeric_limits<double>::infinity();
  for (const double scale : {1 + kOffset, 1 - kOffset}) {
    cv::Mat matrix =
        (cv::Mat_<double>(3, 3) << scale * k.fx, 0, k.cx, 0, scale * k.fy, k.cy, 0, 0, 1);
    cv::Mat coefficients(1, std::max(distortion, 5), CV_64F);
    std::copy_n(k.distortion.begin(), coefficients.cols, coefficients.ptr<double>());
    std::vector<cv::Mat> rotations, translations;
    const double rms = cv::calibrateCamera(
        corners.on_board, corners.pixels, corners.size, matrix, coefficients, rotations,
        translations,
        FlagsFor(distortion) | cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_FOCAL_LENGTH, kUntil);
    const double rms_of_best = best.reprojection_rms;
    least_growth = std::min(least_growth, n * (rms * rms - rms_of_best * rms_of_best));
  }
  if (!(least_growth > 0)) return std::numeric_limits<double>::infinity();
  return kOffset * best.reprojection_rms * std::sqrt(n / DegreesOfFreedom(corners, distortion)) /
         std::sqrt(least_growth);
}

double Coverage(const Corners& corners) {
  constexpr int kColumns = 8, kRows = 6;
  std::vector<bool> held(kColumns * kRows, false);
  for (const auto& view : corners.pixels) {
    for (const cv::Point2f& p : view) {
      const int c = static_cast<int>(kColumns * (p.x + 0.5F) / corners.size.width);
      const int r = static_cast<int>(kRows * (p.y + 0.5F) / corners.size.height);
      held[std::clamp(r, 0, kRows - 1) * kColumns + std::clamp(c, 0, kColumns - 1)] = true;
    }
  }
  return static_cast<double>(std::count(held.begin(), held.end(), true)) / (kColumns * kRows);
}

// Fits the corners; nothing when OpenCV finds no finite, sensible camera. The errors of the views
// come in the order of the corners' views.
std::optional<Calibration> Fit(const Corners& corners, int distortion) {
  cv::Mat matrix, coefficients, sd, sd_poses, view_rms;
  std::vector<cv::Mat> rotations, translations;
  Calibration result;
  result.reprojection_rms = cv::calibrateCamera(corners.on_board, corners.pixels, corners.size,
                                                matrix, coefficients, rotations, translations, sd,
                                                sd_poses, view_rms, FlagsFor(distortion), kUntil);
  if (!cv::checkRange(matrix) || !cv::checkRange(coefficients) || !cv::checkRange(sd)) {
    return std::nullopt;
  }
  // OpenCV 4.6 counts one residual a corner where there are two, and its standard deviations are
  // too large by the factor that is taken off here.
  const double freedom = DegreesOfFreedom(corners, distortion);
  const double mend = std::sqrt(std::max(freedom - corners.count(), 1.0) / freedom);
  const auto m = [&matrix](int r, int c) { return matrix.at<double>(r, c); };
  const auto s = [&sd, mend](int k) { return mend * sd.at<double>(k); };
  result.camera.width = corners.size.width;
  result.camera.height = corners.size.height;
  result.camera.intrinsics = {m(0, 0), m(1, 1), m(0, 2), m(1, 2), {}};
  result.sd = {s(0), s(1), s(2), s(3), {}};
  for (int k = 0; k < distortion; ++k) {
    result.camera.intrinsics.distortion[k] = coefficients.at<double>(k);
    result.sd.distortion[k] = s(4 + k);
  }
  const auto [smaller, larger] =
      std::minmax(result.camera.intrinsics.fx, result.camera.intrinsics.fy);
  if (!(smaller > corners.size.width / 50.0 && larger < 1e6)) return std::nullopt;
  result.view_rms.assign(view_rms.begin<double>(), view_rms.end<double>());
  return result;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Fits, drops the views that stand out, and fits again until none does.
std::optional<Calibration> FitWithoutOutliers(const std::vector<BoardView>& views, cv::Size size,
                                              const CalibrateOptions& options) {
  constexpr int kRounds = 5;
  std::vector<bool> kept(views.size(), true);
  std::vector<double> rms(views.size(), 0);
  for (int round = 1;; ++round) {
    const Corners corners(views, kept, size);
    auto result = Fit(corners, options.distortion);
    if (!result) return std::nullopt;
    const double limit = options.outlier_factor * Median(result->view_rms);
    auto fewer = kept;
    for (std::size_t i = 0, used = 0; i < views.size(); ++i) {
      if (!kept[i]) continue;
      rms[i] = result->view_rms[used++];
      fewer[i] = rms[i] <= limit;
    }
    const auto left = std::count(fewer.begin(), fewer.end(), true);
    if (fewer != kept && left >= kFewestViews && round < kRounds) {
      kept = fewer;
      continue;
    }
    result->focal_sd = ProfileFocalSd(corners, *result, options.distortion);
    if (!(result->focal_sd <= kLargestFocalSd)) return std::nullopt;
    result->coverage = Coverage(corners);
    result->view_kept = kept;
    result->view_rms = rms;
    return result;
  }
}

}  // namespace

std::optional<Calibration> CalibrateCamera(const std::vector<BoardView>& views, int width,
                                           int height, const CalibrateOptions& options) {
  CheckOptions(options);
  const int count = options.distortion;
  Check(count == 0 || count == 4 || count == 5 || count == 8 || count == 12,
        "0, 4, 5, 8 or 12 distortion coefficients can be fitted");
  Check(static_cast<int>(views.size()) >= kFewestViews,
        "a calibration needs at least " + std::to_string(kFewestViews) + " views of the board");
  Check(std::all_of(views.begin(), views.end(), [](const BoardView& v) { return v.found(); }),
        "a view has no corners");

  try {
    return FitWithoutOutliers(views, {width, height}, options);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
}

}  // namespace flocklift
