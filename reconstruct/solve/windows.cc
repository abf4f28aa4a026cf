// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/windows.h"

#include <algorithm>
#include <cmath>

namespace flocklift::internal {

double Window::Weight(double time) const {
  const double rise = first ? 1 : (time - (begin - fade)) / (2 * fade);
  const double fall = last ? 1 : ((end + fade) - time) / (2 * fade);
  return std::clamp(std::min(rise, fall), 0.0, 1.0);
}

std::vector<Window> CutIntoWindows(const Segments& segments, double length, double overlap) {
  double duration = 0;
  for (const Segment& segment : segments.segments) {
    duration = std::max(duration, segment.sightings.back().time);
  }
  const int count = duration <= 1.5 * length ? 1 : static_cast<int>(std::ceil(duration / length));
  std::vector<Window> windows;
  for (int k = 0; k < count; ++k) {
    windows.push_back({.begin = duration * k / count,
                       .end = duration * (k + 1) / count,
                       .fade = 0.5 * overlap,
                       .first = k == 0,
                       .last = k + 1 == count});
  }
  return windows;
}

WindowPart PartOf(const Segments& segments, const Window& window, double fps, int first_frame) {
  WindowPart part;
  const int skipped =
      window.first ? 0 : std::max(0, static_cast<int>((window.begin - window.fade) * fps));
  part.first_frame = first_frame + skipped;
  part.segments.pixel_sd = segments.pixel_sd;
  part.segments.has_shapes = segments.has_shapes;
  part.segments.camera_turns = segments.camera_turns;
  part.segments.form = segments.form;
  part.segments.persistence = segments.persistence;
  part.segments.fps = segments.fps;
  if (static_cast<std::size_t>(skipped) < segments.camera_places.size()) {
    part.segments.camera_places.assign(segments.camera_places.begin() + skipped,
                                       segments.camera_places.end());
    const double last_time = window.last ? 1e9 : window.end + window.fade;
    const double frames = (last_time - skipped / fps) * fps + 2;
    if (frames < static_cast<double>(part.segments.camera_places.size())) {
      part.segments.camera_places.resize(static_cast<std::size_t>(frames));
    }
  }
  for (std::size_t i = 0; i < segments.segments.size(); ++i) {
    const auto& sightings = segments.segments[i].sightings;
    const double first_time = window.begin - window.fade, last_time = window.end + window.fade;
    const auto begin = window.first ? sightings.begin()
                                    : std::partition_point(
                                          sightings.begin(), sightings.end(),
                                          [&](const Sighting& q) { return q.time <= first_time; });
    const auto end =
        window.last ? sightings.end()
                    : std::partition_point(begin, sightings.end(),
                                           [&](const Sighting& q) { return q.time < last_time; });
    if (begin >= end) continue;
    part.segment.push_back(i);
    part.sighting.push_back(static_cast<std::size_t>(begin - sightings.begin()));
    part.segments.segments.push_back({segments.segments[i].id, {begin, end}});
    for (Sighting& s : part.segments.segments.back().sightings) s.time -= skipped / fps;
    part.segments.rows += static_cast<int>(end - begin);
    Segment& segment = part.segments.segments.back();
    for (View view : segments.segments[i].views) {
      view.time -= skipped / fps;
      if (view.time < segment.sightings.front().time) continue;
      if (view.time > segment.sightings.back().time) break;
      segment.views.push_back(view);
    }
  }
  return part;
}

}  // namespace flocklift::internal
