// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Triangles to samples: a z-buffer of four samples a pixel, on a rotated grid, so that an edge of
// any direction has five steps of grey. A sample keeps the nearest surface by 1 / z, which is
// linear in the image. Neighbours that share an edge leave no gap between them and no sample to
// both.

#ifndef FLOCKLIFT_SIMULATE_RENDER_DEPTH_BUFFER_H_
#define FLOCKLIFT_SIMULATE_RENDER_DEPTH_BUFFER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulate/core/vec3.h"

namespace flocklift {

// A corner of a triangle in the image.
struct ImageCorner {
  Vec2d pixel;
  double nearness = 0;  // 1 / camera-frame z, above 0 [1/m]
  double shade = 1;     // factor on the tone
};

class DepthBuffer {
 public:
  static constexpr int kSamples = 4;
  // Where in the pixel they lie [px].
  static constexpr std::array<Vec2d, kSamples> kPlace{
      {{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}}};
  static constexpr unsigned kAllSamples = (1U << kSamples) - 1;

  DepthBuffer(int width, int height);

  // `tone` is blue green red [grey levels]. Only the samples of the bit mask are drawn: one moment
  // of a moving surface, say.
  void Draw(const std::array<ImageCorner, 3>& corner, const std::array<std::uint8_t, 3>& tone,
            unsigned samples = kAllSamples);

  // As new.
  void Clear();

  int width() const { return width_; }
  int height() const { return height_; }

  // The pixels [first, last) of row v that may hold a surface.
  struct Range {
    int first, last;
  };
  Range Touched(int v) const { return touched_[static_cast<std::size_t>(v)]; }
  bool empty() const { return top_ >= bottom_; }

  // 0 where there is nothing.
  float Nearness(int u, int v, int sample) const { return nearness_[Index(u, v, sample)]; }
  // How many samples of a pixel are covered, and how many of them by something farther away than
  // 1 / nearness.
  int Covered(int u, int v) const {
    const float* here = nearness_.data() + Index(u, v, 0);
    return (here[0] > 0) + (here[1] > 0) + (here[2] > 0) + (here[3] > 0);
  }
  int Behind(int u, int v, float nearness) const {
    const float* here = nearness_.data() + Index(u, v, 0);
    int count = 0;
    for (int s = 0; s < kSamples; ++s) count += here[s] > 0 && here[s] < nearness ? 1 : 0;
    return count;
  }
  // Blue green red of one sample [grey levels].
  std::array<std::uint8_t, 3> Tone(int u, int v, int sample) const;

 private:
  std::size_t Index(int u, int v, int sample) const {
    return (static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(u)) *
               kSamples +
           static_cast<std::size_t>(sample);
  }

  int width_, height_;
  int top_, bottom_;             // rows that were touched
  std::vector<float> nearness_;  // height x width x kSamples
  std::vector<std::uint32_t> tone_;
  std::vector<Range> touched_;  // of each row
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_RENDER_DEPTH_BUFFER_H_
