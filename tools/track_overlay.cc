// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/track_overlay.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "simulate/media/draw.h"
#include "simulate/media/video_writer.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

constexpr int kTrailFrames = 20;
constexpr int kTogether = 100;  // frames whose tracks are fetched at once

}  // namespace

void DrawTracks(const Tracks& tracks, int frame, int trail, Image* image) {
  for (const Tracklet& tracklet : tracks.tracklets) {
    const auto& rows = tracklet.detections;
    const auto here =
        std::lower_bound(rows.begin(), rows.end(), frame,
                         [](const Detection& d, int wanted) { return d.frame < wanted; });
    if (here == rows.end() || here->frame != frame) continue;
    const Color color = ColorOfId(tracklet.id);
    std::vector<Vec2d> points;
    for (auto it = here;; --it) {
      if (it->frame < frame - trail) break;
      points.push_back(it->box.Center());
      if (it == rows.begin()) break;
    }
    std::reverse(points.begin(), points.end());
    DrawTrail(points, color, 1.5, image);
    Box box = here->box;
    box.left -= 2;
    box.top -= 2;
    box.width += 4;
    box.height += 4;
    DrawBox(box, color, here->confidence >= kMeasuredConfidence ? 1.5 : 0.6, image);
    DrawText({box.left + box.width + 2, box.top}, std::to_string(tracklet.id), color, 9, image);
  }
}

void WriteTrackOverlay(const std::filesystem::path& footage, const TracksBetween& tracks,
                       std::optional<double> fps, const std::filesystem::path& video,
                       const Progress& progress) {
  VideoSource source(footage);
  VideoWriter writer(video, source.width(), source.height(),
                     fps.value_or(source.fps().value_or(30)));
  Image image;
  Tracks some;
  for (int frame = 1; source.Read(&image); ++frame) {
    if (frame % kTogether == 1) some = tracks(frame - kTrailFrames, frame + kTogether - 1);
    DrawTracks(some, frame, kTrailFrames, &image);
    writer.Write(std::move(image));
    image = Image();
    Report(progress, frame, source.frame_count().value_or(0));
  }
  writer.Finish();
}

}  // namespace flocklift
