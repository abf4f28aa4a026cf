// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/track_from.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/size_text.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

struct PictureSize {
  double width = 0, height = 0;
};

// The video's, what the flag says, or that of a picture which holds all the boxes.
PictureSize SizeOf(const TrackCommand& command, const ForeignTracks& foreign) {
  if (!command.video.empty()) {
    const VideoSource video(command.video);
    return {static_cast<double>(video.width()), static_cast<double>(video.height())};
  }
  if (!command.size.empty()) {
    const auto [width, height] = ParseSize(command.size, "--size");
    return {static_cast<double>(width), static_cast<double>(height)};
  }
  PictureSize size{1, 1};
  const auto hold = [&size](const Detection& d) {
    size.width = std::max(size.width, d.box.left + d.box.width);
    size.height = std::max(size.height, d.box.top + d.box.height);
  };
  for (const Tracklet& t : foreign.tracks.tracklets) {
    std::for_each(t.detections.begin(), t.detections.end(), hold);
  }
  for (const DetectionFrame& f : foreign.detections) {
    std::for_each(f.detections.begin(), f.detections.end(), hold);
  }
  return size;
}

}  // namespace

TrackerResult TrackFrom(const TrackCommand& command, const CommonOptions& common, Stage* stage) {
  ForeignTracks foreign = ReadForeignTracks(command.from, command.foreign);
  const PictureSize size = SizeOf(command, foreign);
  std::optional<double> fps = common.fps ? common.fps : foreign.tracks.fps;
  if (!fps && !command.video.empty()) fps = VideoSource(command.video).fps();
  foreign.tracks.fps = fps;
  TrackerResult result =
      foreign.has_ids
          ? ContinueTracks(command.tracker, foreign.tracks, size.width, size.height)
          : TrackDetections(command.tracker, foreign.detections, size.width, size.height, fps);
  if (!foreign.has_boxes) {
    for (Tracklet& t : result.tracks.tracklets) {
      for (Detection& d : t.detections) d.shape.reset();
    }
    stage->Warn(
        fmt::format("the {} file has positions only: all boxes are {:g} px wide; use "
                    "--no-size when you reconstruct",
                    foreign.layout, command.foreign.box));
  }
  stage->figures()["layout"] = foreign.layout;
  return result;
}

}  // namespace flocklift
