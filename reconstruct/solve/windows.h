// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Long sequences in pieces: windows of equal length that overlap, solved one after the other, so
// that time and memory of the solver grow with the length of a window and not of the sequence. In
// an overlap the weight goes over linearly from one window to the next.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_WINDOWS_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_WINDOWS_H_

#include <cstddef>
#include <vector>

#include "reconstruct/initialize/segments.h"

namespace flocklift::internal {

// A stretch of time [s]; it counts fully between begin and end, and fades to zero half an overlap
// beyond them (but not at the ends of the sequence).
struct Window {
  double begin = 0, end = 0;
  double fade = 0;  // half an overlap
  bool first = false, last = false;

  double Weight(double time) const;  // of all windows together: 1
};

// One window when the sequence is no longer than one and a half of them.
std::vector<Window> CutIntoWindows(const Segments& segments, double length, double overlap);

// What a window holds of the segments. Times count from its own first frame.
struct WindowPart {
  Segments segments;
  int first_frame = 0;                // of the sequence's frames, where time is 0
  std::vector<std::size_t> segment;   // of each part: its place in the sequence's segments,
  std::vector<std::size_t> sighting;  // and its first sighting there
};
WindowPart PartOf(const Segments& segments, const Window& window, double fps, int first_frame);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_WINDOWS_H_
