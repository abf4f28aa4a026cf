// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tools/plot/markup.h"
#include "tools/plot/simplify.h"
#include "tools/report/sections.h"
#include "tools/report/video_frame.h"

namespace flocklift {
namespace {

constexpr int kWidestPicture = 1600;     // embedded [px]
constexpr std::size_t kMostLabels = 60;  // more ids in one picture cannot be read
constexpr std::size_t kMostTrailPoints = 40;
// Over footage, on a dark rim: the same in light and dark mode.
constexpr std::array kColors = {"#ffb000", "#56c2ff", "#2ee6a8", "#ff7ac8",
                                "#ffe14a", "#8f9bff", "#ff7043", "#c6f04e"};

// The first of the frames with the most rows; those of the first second only when nothing else is
// there, because their trails are short.
int FullestFrame(const Tracks& tracks, int frames_a_second) {
  std::map<int, int> counts;
  for (const Tracklet& tracklet : tracks.tracklets) {
    for (const Detection& detection : tracklet.detections) ++counts[detection.frame];
  }
  const int first = counts.begin()->first;
  const bool is_short = counts.rbegin()->first < first + frames_a_second;
  int best = first, most = 0;
  for (const auto& [frame, count] : counts) {
    if (count <= most || (!is_short && frame < first + frames_a_second)) continue;
    most = count;
    best = frame;
  }
  return best;
}

std::string PointsText(const std::vector<Vec2d>& points) {
  std::string text;
  for (const Vec2d& p : points) {
    text += fmt::format("{}{} {}", text.empty() ? "M" : "L", Coordinate(p.x), Coordinate(p.y));
  }
  return text;
}

}  // namespace

void AddPictureSection(const ReportData& data, Page* page, Missing* missing) {
  const RunFolder& run = data.run;
  if (!run.tracks || run.tracks->tracklets.empty()) {
    missing->push_back("Picture with tracks: the folder has no tracks.csv.");
    return;
  }
  if (!run.video) {
    missing->push_back(
        "Picture with tracks: the footage that summary.track.json names is not there.");
    return;
  }
  const int frames_a_second = std::max(1, static_cast<int>(std::lround(run.fps.value_or(30))));
  const int frame = FullestFrame(*run.tracks, frames_a_second);
  const auto picture = ReadVideoFrame(*run.video, frame, kWidestPicture);
  if (!picture) {
    missing->push_back(fmt::format("Picture with tracks: frame {} of {} cannot be read.", frame,
                                   run.video->string()));
    return;
  }

  std::string trails, rings, labels;
  const double unit = std::max(picture->width, picture->height) / 1600.0;
  const double rightmost = picture->width - 40 * unit;  // of a label that stays in the picture
  const double lowest = picture->height - 6 * unit;
  std::size_t animals = 0, interpolated = 0;
  for (const Tracklet& tracklet : run.tracks->tracklets) {
    const auto& rows = tracklet.detections;
    const auto end =
        std::upper_bound(rows.begin(), rows.end(), frame,
                         [](int wanted, const Detection& d) { return wanted < d.frame; });
    if (end == rows.begin() || std::prev(end)->frame != frame) continue;
    const Detection& now = *std::prev(end);
    std::vector<Vec2d> trail;
    for (auto row = rows.begin(); row != end; ++row) {
      if (row->frame > frame - frames_a_second) trail.push_back(row->box.Center());
    }
    trail = SimplifyLine(trail, 0.3 * unit, kMostTrailPoints);
    const char* color = kColors.at(static_cast<std::size_t>(tracklet.id) % kColors.size());
    const std::string path = PointsText(trail);
    trails += fmt::format(
        "<path d=\"{0}\" stroke=\"#000\" stroke-opacity=\".45\" stroke-width=\"{2:.2f}\"/>"
        "<path d=\"{0}\" stroke=\"{1}\" stroke-width=\"{3:.2f}\"/>",
        path, color, 3.6 * unit, 2 * unit);
    const Vec2d at = now.box.Center();
    const double radius = std::max(0.75 * std::max(now.box.width, now.box.height), 7 * unit);
    const bool is_measured = now.confidence >= kMeasuredConfidence;
    rings += fmt::format(
        "<circle cx=\"{0}\" cy=\"{1}\" r=\"{2}\" stroke=\"#000\" stroke-opacity=\".45\" "
        "stroke-width=\"{4:.2f}\"/><circle cx=\"{0}\" cy=\"{1}\" r=\"{2}\" stroke=\"{3}\" "
        "stroke-width=\"{5:.2f}\"{6}/>",
        Coordinate(at.x), Coordinate(at.y), Coordinate(radius), color, 3.4 * unit, 1.8 * unit,
        is_measured ? "" : " stroke-dasharray=\"4 3\"");
    labels +=
        fmt::format("<text x=\"{}\" y=\"{}\" fill=\"{}\" style=\"font-size:{:.0f}px\">{}</text>",
                    Coordinate(std::min(at.x + radius + 3 * unit, rightmost)),
                    Coordinate(std::clamp(at.y - 0.5 * radius, 16 * unit, lowest)), color,
                    15 * unit, tracklet.id);
    ++animals;
    if (!is_measured) ++interpolated;
  }
  // The centre of the top-left pixel is (0, 0): the picture starts half a pixel before.
  const std::string svg = fmt::format(
      "<svg class=\"picture\" viewBox=\"-0.5 -0.5 {0} {1}\" role=\"img\" "
      "aria-label=\"Frame {2} with tracks\"><image x=\"-0.5\" y=\"-0.5\" width=\"{0}\" "
      "height=\"{1}\" href=\"{3}\"/><g fill=\"none\" stroke-linejoin=\"round\" "
      "stroke-linecap=\"round\">{4}{5}</g>{6}</svg>\n",
      picture->width, picture->height, frame, picture->data_uri, trails, rings,
      animals <= kMostLabels ? labels : "");
  page->BeginSection("picture", "What the camera saw");
  std::string caption = fmt::format(
      "Frame {} of the footage, the fullest one: {} animals, each with its path of the last "
      "second",
      frame, animals);
  if (animals <= kMostLabels) caption += " and its identity";
  caption += ".";
  if (interpolated > 0) {
    caption +=
        fmt::format(" Dashed rings: {} interpolated where the animal was not seen.", interpolated);
  }
  page->AddFigure(svg, caption);
}

}  // namespace flocklift
