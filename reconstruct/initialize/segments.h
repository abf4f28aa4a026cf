// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tracks as the solvers see them: rays instead of pixels, one segment per stretch that certainly
// shows one animal. Rays are normalised coordinates (x/z, y/z) in the reference axes
// (reference_axes.h), lens distortion taken out; sizes are angles, so that neither needs the focal
// length again.

#ifndef FLOCKLIFT_RECONSTRUCT_INITIALIZE_SEGMENTS_H_
#define FLOCKLIFT_RECONSTRUCT_INITIALIZE_SEGMENTS_H_

#include <optional>
#include <vector>

#include "reconstruct/initialize/box_form.h"
#include "simulate/camera/camera.h"
#include "simulate/core/observations.h"
#include "simulate/core/rigid3.h"
#include "simulate/core/vec3.h"

namespace flocklift {

// One detection. A point at depth z on the ray is (z x, z y, z) away from the camera.
struct Sighting {
  int frame = 0;
  double time = 0;                 // since the first frame of the sequence [s]
  Vec2d ray;                       // (x/z, y/z)
  double ray_sd = 1;               // of either coordinate
  std::optional<double> log_size;  // log of the angular size; absent on interpolated rows
  // ((a - c), 2 b) / (a + c) of the second moments (a b; b c) of a shape, reference axes, lens
  // distortion taken out; of a box, where the camera does not turn, its squared sides count as
  // moments. Absent with the size.
  std::optional<Vec2d> ellipticity;
};

// What a second camera sees of the animal (second_camera.h).
struct View {
  double time = 0;        // as of sightings [s]
  Rigid3d view_from_ref;  // to axes of the second camera, from the first one's place at that time
  Vec2d ray;              // (x/z, y/z) in those axes
  double ray_sd = 1;      // of either coordinate
};

// One animal without a cut, by increasing frame. Several segments may carry the same id.
struct Segment {
  Id id = 0;
  std::vector<Sighting> sightings;
  std::vector<View> views = {};  // by time
};

struct SegmentOptions {
  double min_pixel_sd = 0.25;   // floor of the noise of an image position [px]
  double jump = 12;             // cut where the motion jumps by so many robust sds; 0: never
  double glitch_pixel_sd = 10;  // noise of the sightings between the two sides of a glitch [px]
  double interpolated_sd = 5;   // sd of interpolated rows over that of measured ones
  bool use_size = true;
};

struct Segments {
  std::vector<Segment> segments;  // by id, then by time
  double pixel_sd = 0;            // estimated noise of an image position [px]
  int cuts = 0;                   // where the image motion jumped
  int rows = 0;                   // detections in all segments
  int unusable = 0;               // detections without a ray (beyond the fold of the distortion,
                                  // or far beside where the camera looks on average)
  bool has_shapes = false;        // sizes come from shapes
  bool camera_turns = false;
  BoxForm form;            // of the boxes, also where sizes come from shapes
  double persistence = 1;  // of the velocity of rays (persistence.h)
  // Places of a moving camera in every frame from the first on, reference axes [m]; empty: at rest.
  std::vector<Vec3d> camera_places;
  double fps = 0;  // frames per second of the places
};

// Every detection comes into exactly one segment. A jump of the motion that is over after a few
// sightings (two animals in one blob) is no cut: those sightings lose their size and most of their
// weight. So do boxes that the edge of the picture cuts off. The noise is estimated from third
// differences of the image positions (white noise of sd s gives them sqrt(20) s, a smooth flight
// next to nothing). The size is sqrt(width^2 + height^2) of the box or, where there is a shape,
// that of its axes times the flock's median ratio of the two: the same for any direction of a
// stretched body. The axes are ReferenceAxes over the frames of the tracks.
Segments MakeSegments(const SegmentOptions& options, const Tracks& tracks, const Camera& camera,
                      double fps);

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_INITIALIZE_SEGMENTS_H_
