// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Gaussian noise of a sensor, independent from pixel to pixel, channel to channel and frame to
// frame as far as an eye or a tracker can tell: half a million normal numbers are drawn once, and
// each row of each frame reads them from a place of its own, keyed by (seed, row, frame).

#ifndef FLOCKLIFT_SIMULATE_RENDER_SENSOR_NOISE_H_
#define FLOCKLIFT_SIMULATE_RENDER_SENSOR_NOISE_H_

#include <cstdint>
#include <vector>

namespace flocklift {

class SensorNoise {
 public:
  // `sd` in the units of the values it is for; at most `row_length` values a row are asked for.
  SensorNoise(double sd, int row_length, std::uint64_t seed);

  // The noise of one row; null when sd is 0.
  const std::int16_t* Row(int v, int frame) const;

 private:
  std::uint64_t seed_;
  std::uint32_t places_ = 0;  // where a row may begin
  std::vector<std::int16_t> bank_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_SENSOR_NOISE_H_
