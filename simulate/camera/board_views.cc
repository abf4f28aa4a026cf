// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/board_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <utility>

namespace flocklift {
namespace {

// Where the board is (centre), how large (log), and how it lies: the affine map from the board to
// the picture without its scale, and the change of scale across it, which is perspective.
using Descriptor = std::array<double, 9>;
Descriptor Describe(const BoardView& view, double image_scale) {
  std::vector<cv::Point2d> from, to;
  for (std::size_t k = 0; k < view.pixels.size(); ++k) {
    from.emplace_back(view.on_board[k].x, view.on_board[k].y);
    to.emplace_back(view.pixels[k].x, view.pixels[k].y);
  }
  const cv::Mat h = cv::findHomography(from, to);
  if (h.empty()) return {};
  const auto at = [&h](int r, int c) { return h.at<double>(r, c); };
  cv::Point2d board_center, center;
  double extent = 0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    board_center += from[k] / static_cast<double>(from.size());
    center += to[k] / static_cast<double>(to.size());
  }
  for (const auto& p : from) extent = std::max(extent, cv::norm(p - board_center));
  const double w = at(2, 0) * board_center.x + at(2, 1) * board_center.y + at(2, 2);
  const double ax = (at(0, 0) - center.x * at(2, 0)) / w, ay = (at(0, 1) - center.x * at(2, 1)) / w;
  const double bx = (at(1, 0) - center.y * at(2, 0)) / w, by = (at(1, 1) - center.y * at(2, 1)) / w;
  const double scale = std::max(std::sqrt(std::abs(ax * by - ay * bx)), 1e-12);
  return {center.x / image_scale, center.y / image_scale,    std::log(scale),
          0.5 * ax / scale,       0.5 * ay / scale,          0.5 * bx / scale,
          0.5 * by / scale,       2 * extent * at(2, 0) / w, 2 * extent * at(2, 1) / w};
}

double SquaredDistance(const Descriptor& a, const Descriptor& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

}  // namespace

std::vector<BoardView> DropRepeats(std::vector<BoardView> views) {
  constexpr double kSame = 2;  // [px]
  const auto repeats = [](const BoardView& a, const BoardView& b) {
    if (a.on_board != b.on_board) return false;
    double sum = 0;
    for (std::size_t k = 0; k < a.pixels.size(); ++k) {
      const double du = a.pixels[k].x - b.pixels[k].x, dv = a.pixels[k].y - b.pixels[k].y;
      sum += du * du + dv * dv;
    }
    return sum < kSame * kSame * static_cast<double>(a.pixels.size());
  };
  std::vector<std::size_t> by_sharpness(views.size());
  std::iota(by_sharpness.begin(), by_sharpness.end(), std::size_t{0});
  std::stable_sort(by_sharpness.begin(), by_sharpness.end(), [&](std::size_t a, std::size_t b) {
    return views[a].sharpness > views[b].sharpness;
  });
  std::vector<std::size_t> kept;
  for (const std::size_t i : by_sharpness) {
    if (std::none_of(kept.begin(), kept.end(),
                     [&](std::size_t k) { return repeats(views[i], views[k]); })) {
      kept.push_back(i);
    }
  }
  std::sort(kept.begin(), kept.end());
  std::vector<BoardView> different;
  for (const std::size_t i : kept) different.push_back(std::move(views[i]));
  return different;
}

std::vector<BoardView> SelectViews(const std::vector<BoardView>& views, int count) {
  if (static_cast<int>(views.size()) <= count) return views;
  double image_scale = 1;
  for (const BoardView& view : views) {
    for (const Vec2d& p : view.pixels) image_scale = std::max({image_scale, p.x, p.y});
  }
  std::vector<Descriptor> descriptors;
  for (const BoardView& view : views) descriptors.push_back(Describe(view, image_scale));

  std::vector<double> nearest(views.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> chosen(views.size(), false);
  auto next = static_cast<std::size_t>(
      std::max_element(descriptors.begin(), descriptors.end(),
                       [](const Descriptor& a, const Descriptor& b) { return a[2] < b[2]; }) -
      descriptors.begin());
  for (int k = 0; k < count; ++k) {
    chosen[next] = true;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const double distance = SquaredDistance(descriptors[i], descriptors[next]);
      nearest[i] = chosen[i] ? -1 : std::min(nearest[i], distance);
    }
    next = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) -
                                    nearest.begin());
  }
  std::vector<BoardView> selected;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (chosen[i]) selected.push_back(views[i]);
  }
  return selected;
}

}  // namespace flocklift
