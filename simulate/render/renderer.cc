// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/core/rng.h"
#include "simulate/render/coverage.h"

namespace flocklift {
namespace {

constexpr std::array<double, 3> kPlumage{46, 45, 50};  // blue green red [grey levels]
constexpr double kPlumageSpread = 5;                   // sd between individuals [grey levels]
constexpr std::uint64_t kPlumageStream = 0x706c756d65;

constexpr double kStepPx = 3;  // way of body and wing tip together between two exposures [px]
constexpr int kMaxPairs = 4;   // of exposures before and after the frame's time

// One animal, ready to be laid over the background.
struct Sprite {
  CoverageMask mask;
  double depth;
  double contrast;                   // left by the haze, in [0, 1]
  std::array<std::int32_t, 3> tone;  // [1 / Background::kUnit grey levels]
};

// The animal at `offset` seconds from the frame's time, flying straight on.
std::optional<ProjectedBody> Expose(FlyingAnimal animal, double time, double offset,
                                    const Camera& camera, const Rigid3d& cam_from_world) {
  animal.position += offset * animal.velocity;
  return ProjectBody(animal, time + offset, camera, cam_from_world);
}

// How far the body and the wing tips move in the image while the shutter is open [px], about.
double MotionPx(const FlyingAnimal& animal, double depth, double shutter, const Camera& camera) {
  const double tip_speed =
      0.5 * animal.animal.wingspan * 2 * std::numbers::pi * animal.animal.wingbeat_hz;
  const double focal = std::max(camera.intrinsics.fx, camera.intrinsics.fy);
  return shutter * (Norm(animal.velocity) + 0.8 * tip_speed) * focal / depth;
}

std::optional<CoverageMask> ExposeMask(const FlyingAnimal& animal, double time, double shutter,
                                       const Camera& camera, const Rigid3d& cam_from_world,
                                       double* depth) {
  const auto middle = ProjectBody(animal, time, camera, cam_from_world);
  if (!middle) return std::nullopt;
  *depth = middle->depth;
  const double motion = MotionPx(animal, middle->depth, shutter, camera);
  // An odd number, so that one of them is the middle.
  const int pairs =
      static_cast<int>(std::clamp(std::ceil(0.5 * (motion / kStepPx - 1)), 0.0, double(kMaxPairs)));
  const int exposures = 2 * pairs + 1;
  std::vector<Silhouette> silhouettes{middle->silhouette};
  for (int k = -pairs; k <= pairs; ++k) {
    if (k == 0) continue;
    auto exposed = Expose(animal, time, shutter * k / exposures, camera, cam_from_world);
    if (exposed) silhouettes.push_back(std::move(exposed->silhouette));
  }
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  for (const Silhouette& silhouette : silhouettes) {
    const Box box = BoundsOf(silhouette);
    left = std::min(left, box.left);
    top = std::min(top, box.top);
    right = std::max(right, box.left + box.width);
    bottom = std::max(bottom, box.top + box.height);
  }
  if (!(right > left && bottom > top)) return std::nullopt;
  CoverageMask mask({left, top, right - left, bottom - top}, camera.width, camera.height);
  if (mask.empty()) return std::nullopt;
  for (const Silhouette& silhouette : silhouettes) mask.Add(silhouette, 1.0 / exposures);
  mask.Finish();
  return mask;
}

// Row v of the image: background and noise in `row`, then what a sprite covers of it.
void LayOver(const Sprite& sprite, int v, std::int16_t* row) {
  const float* cover = sprite.mask.Row(v - sprite.mask.top());
  std::int16_t* pixel = row + 3 * sprite.mask.left();
  for (int u = 0; u < sprite.mask.width(); ++u, pixel += 3) {
    if (cover[u] == 0) continue;
    const auto share = static_cast<std::int32_t>(std::lround(cover[u] * sprite.contrast * 32768));
    for (std::size_t c = 0; c < 3; ++c) {
      pixel[c] = static_cast<std::int16_t>(
          pixel[c] + (((sprite.tone[c] - pixel[c]) * share + (1 << 14)) >> 15));
    }
  }
}

// To whole grey levels, noise added; noise may be null.
void Develop(const std::int16_t* row, const std::int16_t* noise, int length, std::uint8_t* out) {
  constexpr int kShift = 6;
  static_assert(Background::kUnit == 1 << kShift);
  constexpr int kTop = 255 * Background::kUnit;
  constexpr int kHalf = Background::kUnit / 2;
  if (noise == nullptr) {
    for (int k = 0; k < length; ++k) {
      out[k] = static_cast<std::uint8_t>((row[k] + kHalf) >> kShift);
    }
    return;
  }
  for (int k = 0; k < length; ++k) {
    // |noise| <= 16000 and row <= 16320: the sum fits 16 bits.
    auto sum = static_cast<std::int16_t>(row[k] + noise[k]);
    sum = std::clamp<std::int16_t>(sum, 0, kTop);
    out[k] = static_cast<std::uint8_t>(static_cast<std::int16_t>(sum + kHalf) >> kShift);
  }
}

void CheckSpec(const Camera& camera, const RenderSpec& spec, double fps) {
  Check(camera.width > 0 && camera.height > 0, "a camera without a size cannot film");
  Check(fps > 0, "fps must be positive to film");
  Check(spec.noise >= 0 && spec.noise <= 255, "render noise must be in 0 to 255 grey levels");
  Check(spec.blur >= 0 && spec.blur <= 1, "render blur must be in 0 to 1 of the frame time");
  Check(spec.haze >= 0, "render haze must not be negative");
  Check(std::isfinite(spec.cloud_speed_px), "render cloud speed must be a number");
}

const Camera& Checked(const Camera& camera, const RenderSpec& spec, double fps) {
  CheckSpec(camera, spec, fps);
  return camera;
}

}  // namespace

FlockRenderer::FlockRenderer(const Camera& camera, const RenderSpec& spec, double fps,
                             std::uint64_t seed)
    : camera_(Checked(camera, spec, fps)),
      spec_(spec),
      shutter_(spec.blur / fps),
      seed_(seed),
      background_(spec.background, camera.width, camera.height, spec.cloud_speed_px, seed),
      noise_(spec.noise * Background::kUnit, 3 * camera.width, seed) {}

Image FlockRenderer::Render(int frame, double time, std::span<const FlyingAnimal> animals) const {
  const Rigid3d cam_from_world = camera_.CamFromWorld(frame);
  std::vector<Sprite> sprites;
  for (const FlyingAnimal& animal : animals) {
    double depth = 0;
    auto mask = ExposeMask(animal, time, shutter_, camera_, cam_from_world, &depth);
    if (!mask) continue;
    Rng rng(seed_, kPlumageStream ^ static_cast<std::uint64_t>(animal.animal.id));
    const double shade = kPlumageSpread * rng.Normal();
    Sprite& sprite = sprites.emplace_back(
        Sprite{*std::move(mask), depth, spec_.haze > 0 ? std::exp(-depth / spec_.haze) : 1, {}});
    for (std::size_t c = 0; c < 3; ++c) {
      sprite.tone[c] = static_cast<std::int32_t>(
          std::lround(std::max(0.0, kPlumage[c] + shade) * Background::kUnit));
    }
  }
  std::stable_sort(sprites.begin(), sprites.end(),
                   [](const Sprite& a, const Sprite& b) { return a.depth > b.depth; });

  Image image(camera_.width, camera_.height);
  std::vector<std::int16_t> row(3 * static_cast<std::size_t>(camera_.width));
  for (int v = 0; v < camera_.height; ++v) {
    background_.Row(v, frame, row.data());
    for (const Sprite& sprite : sprites) {
      if (v >= sprite.mask.top() && v < sprite.mask.top() + sprite.mask.height()) {
        LayOver(sprite, v, row.data());
      }
    }
    Develop(row.data(), noise_.Row(v, frame), 3 * camera_.width, image.Row(v));
  }
  return image;
}

}  // namespace flocklift
