// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Trajectories and tracks as columns by frame, and windows of them as the bytes that a page reads
// straight into typed arrays. A window is, little-endian:
//   u32  magic "FLKW", kind (0 trajectories, 1 boxes), first frame, frames F, rows R, 3 x unused
//   u32  start[F + 1]    rows of frame first + k are start[k] .. start[k+1] - 1
//   u32  animal[R]       place in the list of animals
//   kind 0   f32 position[3R] [m, world], f32 velocity[3R] [m/s], f32 sd_depth[R] [m; 0: unknown],
//            i16 orientation[4R]  world_from_body as w, x, y, z in units of 1/32767
//   kind 1   f32 box[4R]  left, top, width, height [px], f32 confidence[R]

#ifndef FLOCKLIFT_TOOLS_VIEW_FRAME_TABLE_H_
#define FLOCKLIFT_TOOLS_VIEW_FRAME_TABLE_H_

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "simulate/core/observations.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

// The animals that a page knows, in the order in which they were first heard of: tables name them
// by their place, which never changes.
class AnimalList {
 public:
  void Add(Id id);  // once or again
  void Add(const Tracks& tracks);
  void Add(const Trajectories& trajectories);
  std::uint32_t IndexOf(Id id) const;  // must be there
  const std::vector<Id>& ids() const { return ids_; }

 private:
  std::vector<Id> ids_;
  std::unordered_map<Id, std::uint32_t> places_;
};

// The rows of all frames in a span of frames, as counted.
struct FrameRows {
  int first_frame = 1;
  std::vector<std::uint32_t> start = {0};  // F + 1
  std::vector<std::uint32_t> animal;       // R

  int frame_count() const { return static_cast<int>(start.size()) - 1; }
  int last_frame() const { return first_frame + frame_count() - 1; }
};

struct TrajectoryTable {
  FrameRows rows;
  std::vector<float> position, velocity, sd_depth;  // 3R, 3R, R
  std::vector<std::int16_t> orientation;            // 4R
};

struct BoxTable {
  FrameRows rows;
  std::vector<float> box, confidence;  // 4R, R
};

// Every animal must be in the list. Without orientations a bird flies level along its velocity.
TrajectoryTable TableOf(const Trajectories& trajectories, const AnimalList& animals);
BoxTable TableOf(const Tracks& tracks, const AnimalList& animals);

// The frames `first` to `last` that the table has; an empty window when it has none of them.
std::string PackWindow(const TrajectoryTable& table, int first, int last);
std::string PackWindow(const BoxTable& table, int first, int last);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_FRAME_TABLE_H_
