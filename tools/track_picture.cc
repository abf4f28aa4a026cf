// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/track_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "simulate/core/check.h"
#include "simulate/core/image.h"
#include "simulate/core/text.h"
#include "simulate/media/draw.h"
#include "simulate/media/image_codec.h"
#include "tools/track_overlay.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

constexpr int kMostPanels = 12, kColumns = 4;
constexpr int kPanelWidth = 480, kPanelHeight = 360;  // [px]
constexpr double kLeastCut = 60;                      // side of what is cut out [px]
constexpr double kAround = 25;                        // of it beside the animals [px]
constexpr int kTrail = 8;                             // frames

// What the panels show, of the panels' proportions.
Box CutOut(const Tracks& tracks, const PictureSpan& span, int width, int height) {
  if (span.ids.empty()) return {0, 0, static_cast<double>(width), static_cast<double>(height)};
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  for (const Tracklet& t : tracks.tracklets) {
    if (std::find(span.ids.begin(), span.ids.end(), t.id) == span.ids.end()) continue;
    for (const Detection& d : t.detections) {
      if (d.frame < span.first || d.frame > span.last) continue;
      left = std::min(left, d.box.left);
      top = std::min(top, d.box.top);
      right = std::max(right, d.box.left + d.box.width);
      bottom = std::max(bottom, d.box.top + d.box.height);
    }
  }
  if (right < left) {
    throw InputError("--picture", 0,
                     fmt::format("tracks {} have no row in frames {} to {}",
                                 fmt::join(span.ids, ", "), span.first, span.last),
                     "name tracks of tracks.csv that are there");
  }
  double w = std::max(right - left + 2 * kAround, kLeastCut);
  double h = std::max(bottom - top + 2 * kAround, kLeastCut);
  w = std::max(w, h * kPanelWidth / kPanelHeight);
  h = w * kPanelHeight / kPanelWidth;
  return Box::Around({0.5 * (left + right), 0.5 * (top + bottom)}, w, h);
}

// The tracks as they stand in a panel.
Tracks Scaled(const Tracks& tracks, const Box& cut, double scale, int frame) {
  Tracks scaled;
  for (const Tracklet& t : tracks.tracklets) {
    Tracklet s{t.id, {}};
    for (const Detection& d : t.detections) {
      if (d.frame < frame - kTrail || d.frame > frame) continue;
      s.detections.push_back(d);
      Box& box = s.detections.back().box;
      // A pixel's centre is a whole number before and after.
      box = {scale * (box.left - cut.left + 0.5) - 0.5, scale * (box.top - cut.top + 0.5) - 0.5,
             scale * box.width, scale * box.height};
    }
    if (!s.detections.empty()) scaled.tracklets.push_back(std::move(s));
  }
  return scaled;
}

Image Panel(const Image& picture, const Tracks& tracks, const Box& cut, int frame) {
  const double scale = std::min(kPanelWidth / cut.width, kPanelHeight / cut.height);
  Image panel(kPanelWidth, kPanelHeight);
  const cv::Mat from(picture.height, picture.width, CV_8UC3,
                     const_cast<std::uint8_t*>(picture.bgr.data()));
  cv::Mat to(kPanelHeight, kPanelWidth, CV_8UC3, panel.bgr.data());
  const double shift_x = scale * (0.5 - cut.left) - 0.5, shift_y = scale * (0.5 - cut.top) - 0.5;
  const cv::Matx23d m(scale, 0, shift_x, 0, scale, shift_y);
  cv::warpAffine(from, to, m, to.size(), scale >= 2 ? cv::INTER_NEAREST : cv::INTER_LINEAR);
  DrawTracks(Scaled(tracks, cut, scale, frame), frame, kTrail, &panel);
  DrawText({8, kPanelHeight - 8.0}, fmt::format("frame {}", frame), {255, 255, 255}, 13, &panel);
  return panel;
}

}  // namespace

PictureSpan ParsePictureSpan(const std::string& text, const std::string& flag) {
  const auto fail = [&]() -> PictureSpan {
    throw CLI::ValidationError(flag, "give FIRST:LAST or FIRST:LAST:ID,ID, not " + text);
  };
  std::vector<std::int64_t> numbers;
  std::string rest = text;
  std::size_t colons = 0;
  while (true) {
    const std::size_t end = rest.find_first_of(":,");
    const auto number = ParseInteger(rest.substr(0, end));
    if (!number || *number < 1) return fail();
    numbers.push_back(*number);
    if (end == std::string::npos) break;
    const bool is_colon = rest[end] == ':';
    colons += is_colon ? 1 : 0;
    if (is_colon != (numbers.size() <= 2)) return fail();
    rest = rest.substr(end + 1);
  }
  if (numbers.size() < 2 || colons < 1 || numbers[0] > numbers[1] || numbers[1] > 100'000'000) {
    return fail();
  }
  PictureSpan span{static_cast<int>(numbers[0]), static_cast<int>(numbers[1]), {}};
  span.ids.assign(numbers.begin() + 2, numbers.end());
  return span;
}

std::string NameOfPicture(const PictureSpan& span) {
  std::string name = fmt::format("picture_{}_{}", span.first, span.last);
  for (const Id id : span.ids) name += fmt::format("_{}", id);
  return name + ".png";
}

void WriteTrackPicture(const std::filesystem::path& footage, const TracksBetween& tracks_between,
                       const PictureSpan& span, const std::filesystem::path& picture) {
  VideoSource source(footage);
  const Tracks tracks = tracks_between(span.first - kTrail, span.last);
  const Box cut = CutOut(tracks, span, source.width(), source.height());
  const int panels = std::min(kMostPanels, span.last - span.first + 1);
  std::vector<Image> shown;
  Image image;
  for (int frame = 1; frame <= span.last && source.Read(&image); ++frame) {
    const int k = static_cast<int>(shown.size());
    const int wanted =
        panels == 1
            ? span.first
            : span.first +
                  static_cast<int>(std::lround(1.0 * k * (span.last - span.first) / (panels - 1)));
    if (k < panels && frame == wanted) shown.push_back(Panel(image, tracks, cut, frame));
  }
  if (shown.empty()) {
    throw InputError(footage.string(), 0, fmt::format("there is no frame {}", span.first),
                     "give frames of the footage to --picture");
  }
  const int columns = std::min<int>(kColumns, static_cast<int>(shown.size()));
  const int rows = (static_cast<int>(shown.size()) + columns - 1) / columns;
  Image sheet(columns * kPanelWidth, rows * kPanelHeight);
  cv::Mat whole(sheet.height, sheet.width, CV_8UC3, sheet.bgr.data());
  whole.setTo(cv::Scalar(0, 0, 0));
  for (int k = 0; k < static_cast<int>(shown.size()); ++k) {
    cv::Mat(kPanelHeight, kPanelWidth, CV_8UC3, shown[k].bgr.data())
        .copyTo(whole(cv::Rect(k % columns * kPanelWidth, k / columns * kPanelHeight, kPanelWidth,
                               kPanelHeight)));
  }
  WritePng(picture, sheet);
}

}  // namespace flocklift
