// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Trajectories as a regression needs them: positions by animal and frame with short gaps bridged,
// and two estimates of the flock's state, from positions alone (dt = 1 / fps, t in frames):
//   between   the cubic on [k, k + 1] through the positions, with slopes (x_{k+1} - x_{k-1}) / 2;
//             the velocity at t is the cubic's slope half an engine's step before t, because the
//             semi-implicit Euler engine has x_{n+1} = x_n + h v_{n+1}
//   foreseen  the parabola of least squares through frames k - span .. k, continued to a later one:
//             it knows nothing after frame k
// World frame, metres, seconds.

#ifndef FLOCKLIFT_RECONSTRUCT_FIT_OBSERVED_FLOCK_H_
#define FLOCKLIFT_RECONSTRUCT_FIT_OBSERVED_FLOCK_H_

#include <cstdint>
#include <vector>

#include "simulate/core/trajectory.h"

namespace flocklift {

class ObservedFlock {
 public:
  // Gaps of up to `bridged_gap` missing frames are filled with a cubic through the frames beside
  // them; longer ones stay gaps.
  ObservedFlock(const Trajectories& trajectories, double fps, int bridged_gap);

  struct State {
    std::vector<int> animal;  // index into the trajectories, increasing
    std::vector<Vec3d> position, velocity;

    // Index k with animal[k] == wanted, or -1.
    int Find(int wanted) const;
  };

  FrameSpan span() const { return span_; }
  int animals() const { return static_cast<int>(tracks_.size()); }
  double dt() const { return dt_; }
  FrameSpan Life(int animal) const;  // its first and last frame; {0, -1} when it has none
  int Count(int frame) const { return static_cast<int>(Alive(frame).size()); }
  // Animals whose tracks have the frame, increasing.
  const std::vector<int>& Alive(int frame) const;

  // Is there a position (Has), and was it in the file, not bridged (Measured)?
  bool Has(int animal, int frame) const { return Flag(animal, frame) != 0; }
  bool Measured(int animal, int frame) const { return Flag(animal, frame) == kMeasured; }
  const Vec3d& Position(int animal, int frame) const;
  double SdDepth(int animal, int frame) const;  // 0 where bridged

  // At frame + part / parts, 0 <= part < parts; `engine_step` in frames. At the end of a run of
  // frames slopes are one-sided; an animal alone in its run is left out.
  State Between(int frame, int part, int parts, double engine_step) const;
  // With two frames of the span there, the straight line through them.
  State Foreseen(int frame, int span, int ahead) const;

 private:
  static constexpr std::uint8_t kBridged = 1, kMeasured = 2;
  struct Track {
    int first = 0;
    std::vector<Vec3d> position;
    std::vector<std::uint8_t> flag;
    std::vector<double> sd_depth;  // empty when the file has none
  };
  std::uint8_t Flag(int animal, int frame) const;
  Vec3d Slope(int animal, int frame) const;  // [m/frame]; 0 without a neighbouring frame

  double dt_;
  FrameSpan span_;
  std::vector<Track> tracks_;
  std::vector<std::vector<int>> alive_;  // per frame of the span
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_FIT_OBSERVED_FLOCK_H_
