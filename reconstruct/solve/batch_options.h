// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Options of the batch method: what is assumed of flight before anything is seen. Spreads marked
// "first guess" are then estimated from the data (unless `estimate` is off).

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_OPTIONS_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_OPTIONS_H_

namespace flocklift {

struct BatchOptions {
  double knot_interval = 0.1;
  double acceleration_sd = 3;
  double acceleration_time = 0.7;
  double speed_spread = 0.1;
  double speed_sd = 0.1;
  double speed_time = 0.8;
  double size_sd = 0.15;
  double size_time = 0.15;
  double size_ratio_sd = 0.05;
  double climb_sd = 0.12;
  double climb_time = 1;
  double depth_time = 15;
  double pixel_sd = 0.25;
  double jump = 12;
  bool level_flight = true;
  bool shared_depth = true;
  bool flock_turn = true;
  bool erratic_flight = true;
  bool estimate = true;
  double window = 12;
  double overlap = 3;
  int max_iterations = 60;
};

template <typename Visitor>
void Describe(Visitor& visit, BatchOptions& o) {
  visit("knot-interval", o.knot_interval, {.low = 0.01, .high = 2}, "s",
        "time between the knots of a path (at least one frame)");
  visit("acceleration-sd", o.acceleration_sd, {.low = 0.01, .high = 1000}, "m/s^2",
        "spread of accelerations, each component; first guess");
  visit("acceleration-time", o.acceleration_time, {.low = 0.01, .high = 100}, "s",
        "how long an acceleration lasts");
  visit("speed-spread", o.speed_spread, {.low = 0.001, .high = 2}, "",
        "relative spread of mean speed between animals; first guess");
  visit("speed-sd", o.speed_sd, {.low = 0.001, .high = 2}, "",
        "relative spread of one animal's speed over time; first guess");
  visit("speed-time", o.speed_time, {.low = 0.01, .high = 100}, "s",
        "how long an animal stays faster or slower than its mean");
  visit("size-sd", o.size_sd, {.low = 0.001, .high = 2}, "",
        "relative spread of apparent size by wingbeat and pose; first guess");
  visit("size-time", o.size_time, {.low = 0.001, .high = 100}, "s",
        "how long an error of apparent size lasts; first guess");
  visit("size-ratio-sd", o.size_ratio_sd, {.low = 0.001, .high = 2}, "",
        "how badly box sizes are known when pose, body length and wingbeat are (log)");
  visit("climb-sd", o.climb_sd, {.low = 0.001, .high = 2}, "",
        "spread of the sine of the climb angle; first guess");
  visit("climb-time", o.climb_time, {.low = 0.01, .high = 100}, "s", "how long a climb lasts");
  visit("depth-time", o.depth_time, {.low = 0.01, .high = 1000}, "s",
        "how long an animal stays in the front or the back of the flock");
  visit("pixel-sd", o.pixel_sd, {.low = 0.01, .high = 100}, "px",
        "least noise of an image position; the estimate from the tracks counts when larger");
  visit("jump", o.jump, {.low = 0, .high = 1e6}, "",
        "cut a track where its image motion jumps by so many robust sds; 0: never");
  visit("level-flight", o.level_flight, {}, "",
        "animals fly level on average (only where gravity is known)");
  visit("shared-depth", o.shared_depth, {}, "", "the flock is about as deep as it is wide");
  visit("flock-turn", o.flock_turn, {}, "",
        "the flock has an acceleration in common, of a strength that the data tell");
  visit("erratic-flight", o.erratic_flight, {}, "",
        "animals whose motion in the image is forgotten within half a second, as of insects in a "
        "swarm, are not taken to keep their speed");
  visit("estimate", o.estimate, {}, "", "estimate the spreads from the data");
  visit("solve-window", o.window, {.low = 1, .high = 1e6}, "s",
        "longer sequences are solved in windows of about this length");
  visit("solve-overlap", o.overlap, {.low = 0.1, .high = 1e6}, "s", "of neighbouring windows");
  visit("max-iterations", o.max_iterations, {.low = 1, .high = 100000}, "",
        "of the solver, at most");
}

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_BATCH_OPTIONS_H_
