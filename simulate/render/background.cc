// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/background.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"

namespace flocklift {
namespace {

using Bgr = std::array<double, 3>;

constexpr Bgr kPlain{196, 196, 196};
constexpr Bgr kZenith{206, 158, 104}, kHorizon{236, 219, 199};
constexpr Bgr kCloudLight{246, 243, 240}, kCloudDark{196, 190, 184};

constexpr int kOctaves = 6;
constexpr double kFirstCellShare = 0.45;  // size of the largest cells, of the image's height
constexpr double kFlatness = 1.7;         // clouds are wider than tall

double SmoothStep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Weights of the uniform cubic B-spline at t in [0, 1): smooth, without overshoot.
std::array<float, 4> SplineWeights(double t) {
  const double s = 1 - t;
  return {
      static_cast<float>(s * s * s / 6), static_cast<float>((3 * t * t * t - 6 * t * t + 4) / 6),
      static_cast<float>((3 * s * s * s - 6 * s * s + 4) / 6), static_cast<float>(t * t * t / 6)};
}

// One octave of noise: a lattice of normal numbers, periodic in u, under a cubic spline.
class Octave {
 public:
  Octave(int period, int height, int columns, double cell_height, std::uint64_t seed, int index)
      : columns_(columns),
        rows_(static_cast<int>(std::ceil(height / cell_height)) + 4),
        cell_height_(cell_height),
        lattice_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows_)),
        line_(static_cast<std::size_t>(columns) + 3),
        column_(static_cast<std::size_t>(period)),
        weights_(static_cast<std::size_t>(period)) {
    Rng rng(seed, 0x636c6f7564, static_cast<std::uint32_t>(index));
    for (float& value : lattice_) value = static_cast<float>(rng.Normal());
    for (int u = 0; u < period; ++u) {
      const double x = static_cast<double>(u) * columns / period;
      column_[static_cast<std::size_t>(u)] = static_cast<int>(x);
      weights_[static_cast<std::size_t>(u)] = SplineWeights(x - std::floor(x));
    }
  }

  // out[u] += amplitude * noise(u, v).
  void AddRow(int v, float amplitude, std::vector<float>* out) {
    const double y = v / cell_height_;
    const int row = static_cast<int>(y);
    const std::array<float, 4> w = SplineWeights(y - row);
    for (int c = 0; c < columns_ + 3; ++c) {
      float sum = 0;
      for (int k = 0; k < 4; ++k) sum += w[static_cast<std::size_t>(k)] * At(row + k, c % columns_);
      line_[static_cast<std::size_t>(c)] = amplitude * sum;
    }
    for (std::size_t u = 0; u < out->size(); ++u) {
      const float* p = line_.data() + column_[u];
      const std::array<float, 4>& x = weights_[u];
      (*out)[u] += x[0] * p[0] + x[1] * p[1] + x[2] * p[2] + x[3] * p[3];
    }
  }

 private:
  float At(int row, int column) const {
    return lattice_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(column)];
  }

  int columns_, rows_;
  double cell_height_;
  std::vector<float> lattice_;
  std::vector<float> line_;                    // the lattice blended to one row
  std::vector<int> column_;                    // of each u, the first of four lattice columns
  std::vector<std::array<float, 4>> weights_;  // of each u
};

std::int16_t ToUnits(double level) {
  return static_cast<std::int16_t>(std::lround(std::clamp(level, 0.0, 255.0) * Background::kUnit));
}

}  // namespace

Background::Background(const std::string& kind, int width, int height, double drift_px,
                       std::uint64_t seed)
    : width_(width), height_(height), drift_px_(drift_px) {
  Check(kind == "plain" || kind == "sky" || kind == "clouds",
        "background is " + kind + ", it may be plain, sky or clouds");
  for (int v = 0; v < height; ++v) {
    const double share = std::pow((v + 0.5) / height, 0.8);
    for (std::size_t c = 0; c < 3; ++c) {
      sky_.push_back(
          ToUnits(kind == "plain" ? kPlain[c] : kZenith[c] + share * (kHorizon[c] - kZenith[c])));
    }
  }
  if (kind == "clouds") MakeClouds(seed);
}

void Background::MakeClouds(std::uint64_t seed) {
  const double first_cell = std::max(4.0, kFirstCellShare * height_);
  const int columns =
      std::max(2, static_cast<int>(std::lround(2 * width_ / (kFlatness * first_cell))));
  period_ = 2 * width_;
  std::vector<Octave> octaves;
  for (int k = 0; k < kOctaves; ++k) {
    const int cells = columns << k;
    if (cells > period_) break;
    octaves.emplace_back(period_, height_, cells, first_cell / (1 << k), seed, k);
  }
  clouds_.resize(static_cast<std::size_t>(height_) * static_cast<std::size_t>(period_ + 1) * 3);
  std::vector<float> noise(static_cast<std::size_t>(period_));
  std::int16_t* out = clouds_.data();
  for (int v = 0; v < height_; ++v) {
    std::fill(noise.begin(), noise.end(), 0.0F);
    float amplitude = 1.9F;
    for (Octave& octave : octaves) {
      octave.AddRow(v, amplitude, &noise);
      amplitude *= 0.52F;
    }
    const std::int16_t* sky = sky_.data() + 3 * v;
    for (const float density : noise) {
      const double cover = 0.92 * SmoothStep(-0.35, 1.1, density);
      const double shade = SmoothStep(0.5, 2.4, density);
      for (std::size_t c = 0; c < 3; ++c) {
        const double cloud = kCloudLight[c] + shade * (kCloudDark[c] - kCloudLight[c]);
        const double below = static_cast<double>(sky[c]) / kUnit;
        *out++ = ToUnits(below + cover * (cloud - below));
      }
    }
    std::copy_n(out - 3 * period_, 3, out);
    out += 3;
  }
}

void Background::Row(int v, int frame, std::int16_t* out) const {
  if (period_ == 0) {
    const std::int16_t* sky = sky_.data() + 3 * v;
    for (int u = 0; u < width_; ++u) {
      for (int c = 0; c < 3; ++c) out[3 * u + c] = sky[c];
    }
    return;
  }
  const double way = -drift_px_ * (frame - 1);
  const double offset = way - std::floor(way / period_) * period_;
  const int whole = std::min(static_cast<int>(offset), period_ - 1);
  // Twice the difference of neighbours times a share in units of 2^-15, shifted by 16: fits SIMD.
  const auto share = static_cast<std::int16_t>(std::lround((offset - whole) * 32767));
  const std::int16_t* row =
      clouds_.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(period_ + 1) * 3;
  const auto copy = [&](int from, int count, std::int16_t* to) {
    const std::int16_t* p = row + 3 * from;
    for (int k = 0; k < 3 * count; ++k) {
      const auto rise = static_cast<std::int16_t>(2 * (p[k + 3] - p[k]));
      to[k] = static_cast<std::int16_t>(p[k] + ((rise * share) >> 16));
    }
  };
  const int first = std::min(width_, period_ - whole);
  copy(whole, first, out);
  copy(0, width_ - first, out + 3 * first);
}

}  // namespace flocklift
