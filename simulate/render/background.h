// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is behind the animals: a plain grey, a sky that pales towards the horizon, or that sky with
// clouds (fractal noise, six octaves) that drift to the right. The picture is made once, periodic
// in u, and each frame reads it at a sub-pixel offset.

#ifndef FLOCKLIFT_SIMULATE_RENDER_BACKGROUND_H_
#define FLOCKLIFT_SIMULATE_RENDER_BACKGROUND_H_

#include <cstdint>
#include <string>
#include <vector>

namespace flocklift {

class Background {
 public:
  // Grey levels are kept as 1/64 of a level.
  static constexpr int kUnit = 64;

  // `kind` is plain, sky or clouds; `drift_px` is the clouds' way in one frame [px].
  Background(const std::string& kind, int width, int height, double drift_px, std::uint64_t seed);

  // Writes 3 x width values (blue green red) of row v in `frame` to `out`.
  void Row(int v, int frame, std::int16_t* out) const;

 private:
  void MakeClouds(std::uint64_t seed);

  int width_, height_;
  int period_ = 0;  // of the cloud picture [px]; 0: no clouds
  double drift_px_;
  std::vector<std::int16_t> sky_;  // height x 3
  std::vector<std::int16_t>
      clouds_;  // height x (period + 1) x 3, the last column repeats the first
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_BACKGROUND_H_
