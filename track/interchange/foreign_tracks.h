// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Detections and tracks that other programs made. The layout is told by the columns:
//   MOTChallenge   no names; frame, id, left, top, width, height[, confidence, ...], frames from 1;
//                  id -1: detections; confidence 0: to be ignored. Also with names (bb_left or
//                  left)
//   TRex           frame, X and Y (of #wcentroid where it is there), missing, num_pixels, one file
//                  an animal; frames from 0. A folder of such files is a flock, in their order
//   idtracker.ai   time, x1, y1, x2, y2, ...: a row a frame; or tidy: frame, time, individual, x,
//   y,
//                  probability, frames and individuals from 0. Its session folder is read as well
//   trackpy        x, y, frame, and particle once linked; frames and particles from 0
//   DLTdv          pt1_cam1_X, pt1_cam1_Y, ...: a row a frame, nan where a point was not digitised,
//                  the first pixel's centre at (1, 1)
// Positions become those of simulate/core/observations.h, frames count from 1, ids are positive.

#ifndef FLOCKLIFT_TRACK_INTERCHANGE_FOREIGN_TRACKS_H_
#define FLOCKLIFT_TRACK_INTERCHANGE_FOREIGN_TRACKS_H_

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "simulate/core/observations.h"
#include "simulate/core/options.h"

namespace flocklift {

struct ForeignOptions {
  double box = 10;       // side of an animal's box where the file has positions only [px]
  double scale = 1;      // pixels per unit of the file's positions: TRex writes centimetres
  int camera = 1;        // of a DLTdv file of several cameras
  double up_height = 0;  // height of the picture when y counts up from its bottom [px]; 0: down
};

template <typename Visitor>
void Describe(Visitor& visit, ForeignOptions& o) {
  visit("box", o.box, {.low = 1, .high = 10000}, "px",
        "size of an animal where the file has positions only");
  visit("scale", o.scale, {.low = 1e-6, .high = 1e6}, "px",
        "pixels per unit of the file's positions (TRex writes centimetres)");
  visit("camera", o.camera, {.low = 1, .high = 1000}, "", "the camera of a DLTdv file");
  visit(
      "up-height", o.up_height, {.low = 0, .high = 1e6}, "px",
      "height of the picture where y counts up from its bottom (DLTdv 5 to 7); 0: it counts down");
}

struct ForeignTracks {
  std::string layout;                      // "trackpy" ..
  bool has_ids = false;                    // else `detections` holds all
  bool has_boxes = false;                  // else every box is a guess
  Tracks tracks;                           // fps where the file has times
  std::vector<DetectionFrame> detections;  // by frame
};

// Throws InputError for what is in no known layout, with the columns that were found.
ForeignTracks ReadForeignTracks(const std::filesystem::path& path, const ForeignOptions& options);
ForeignTracks ReadForeignTracks(std::istream& stream, const std::string& name,
                                const ForeignOptions& options);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_INTERCHANGE_FOREIGN_TRACKS_H_
