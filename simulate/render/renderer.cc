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
#include "simulate/render/canvas.h"
#include "simulate/render/coverage.h"

namespace flocklift {
namespace {

constexpr std::array<double, 3> kPlumage{46, 45, 50};  // blue green red [grey levels]
constexpr double kPlumageSpread = 5;                   // sd between individuals [grey levels]
constexpr std::uint64_t kPlumageStream = 0x706c756d65;

constexpr double kStepPx = 3;       // way of body and wing tip together between two exposures [px]
constexpr int kMaxPairs = 4;        // of exposures before and after the frame's time
constexpr double kMostDabs = 4000;  // of one speck's streak
static_assert(Canvas::kUnit == Background::kUnit);

// Plumage differs a little between individuals.
Paint PlumageOf(Id id, std::uint64_t seed) {
  Rng rng(seed, kPlumageStream ^ static_cast<std::uint64_t>(id));
  const double shade = kPlumageSpread * rng.Normal();
  Paint paint;
  for (std::size_t c = 0; c < 3; ++c) {
    paint.tone[c] =
        static_cast<std::int32_t>(std::lround(std::max(0.0, kPlumage[c] + shade) * Canvas::kUnit));
  }
  return paint;
}

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

// A streak of equal dabs, at most half a pixel apart.
void Draw(const Speck& speck, const Paint& paint, std::uint32_t grain, Canvas* canvas) {
  const Vec2d way{speck.to.x - speck.from.x, speck.to.y - speck.from.y};
  const int dabs = 1 + static_cast<int>(std::min(kMostDabs, 2 * std::hypot(way.x, way.y)));
  for (int k = 0; k < dabs; ++k) {
    const double share = (k + 0.5) / dabs;
    canvas->Dab({speck.from.x + share * way.x, speck.from.y + share * way.y}, speck.area / dabs,
                paint, grain + 4 * static_cast<std::uint32_t>(k));
  }
}

}  // namespace

struct FlockRenderer::Bench {
  // A layer is a speck or a patch.
  struct Layer {
    double depth;
    std::uint32_t index;
    bool is_speck;
  };
  struct PaintedSpeck {
    Speck speck;
    Paint paint;
    std::uint32_t grain;
  };

  Canvas canvas;
  std::unique_ptr<DepthBuffer> surfaces;  // made when there is a surface
  LineCover line_cover;                   // made when there is a line
  std::vector<PaintedSpeck> specks;
  std::vector<Layer> layers;

  Bench(int width, int height) : canvas(width, height) {}
};

FlockRenderer::FlockRenderer(const Camera& camera, const RenderSpec& spec, double fps,
                             std::uint64_t seed)
    : camera_(Checked(camera, spec, fps)),
      spec_(spec),
      shutter_(spec.blur / fps),
      seed_(seed),
      background_(spec.background, camera.width, camera.height, spec.cloud_speed_px, seed),
      noise_(spec.noise * Background::kUnit, 3 * camera.width, seed),
      surface_painter_(camera) {}

FlockRenderer::~FlockRenderer() = default;

std::unique_ptr<FlockRenderer::Bench> FlockRenderer::TakeBench() const {
  {
    const std::lock_guard lock(idle_mutex_);
    if (!idle_.empty()) {
      auto bench = std::move(idle_.back());
      idle_.pop_back();
      return bench;
    }
  }
  return std::make_unique<Bench>(camera_.width, camera_.height);
}

void FlockRenderer::Sketch(std::span<const FlyingAnimal> animals, int frame, double time,
                           const Rigid3d& cam_from_world, std::vector<Patch>* patches,
                           Bench* bench) const {
  bench->specks.clear();
  for (const FlyingAnimal& animal : animals) {
    const double depth = (cam_from_world * animal.position).z;
    Paint paint = PlumageOf(animal.animal.id, seed_);
    const auto at_depth = [&](double z) {
      paint.depth = z;
      paint.opacity = spec_.haze > 0 ? std::exp(-z / spec_.haze) : 1;
      return paint;
    };
    if (depth > 0 && SizePx(animal.animal, depth, camera_) < kSpeckPx) {
      const auto speck =
          ProjectSpeck(animal, time, shutter_, speck_areas_, camera_, cam_from_world);
      if (!speck) continue;
      bench->specks.push_back({*speck, at_depth(depth),
                               static_cast<std::uint32_t>(animal.animal.id * 977 + frame * 7919)});
      continue;
    }
    double middle_depth = 0;
    auto mask = ExposeMask(animal, time, shutter_, camera_, cam_from_world, &middle_depth);
    if (mask) patches->push_back({*std::move(mask), at_depth(middle_depth)});
  }
}

Image FlockRenderer::Render(int frame, double time, std::span<const FlyingAnimal> animals,
                            const Setting& setting) const {
  const Rigid3d cam_from_world = camera_.CamFromWorld(frame);
  std::unique_ptr<Bench> bench = TakeBench();
  Canvas& canvas = bench->canvas;
  for (int v = 0; v < camera_.height; ++v) background_.Row(v, frame, canvas.Row(v));

  if (!setting.surfaces.empty() && !bench->surfaces) {
    bench->surfaces = std::make_unique<DepthBuffer>(camera_.width, camera_.height);
  }
  for (const Surface& surface : setting.surfaces) {
    surface_painter_.Draw(surface, cam_from_world, shutter_, bench->surfaces.get());
  }
  canvas.Place(bench->surfaces.get(), spec_.haze);

  std::vector<Patch> patches;
  if (!setting.strokes.empty()) {
    bench->line_cover.resize(static_cast<std::size_t>(camera_.width) *
                             static_cast<std::size_t>(camera_.height));
  }
  for (const Stroke& stroke : setting.strokes) {
    AddStroke(stroke, camera_, cam_from_world, spec_.haze, &bench->line_cover, &patches);
  }
  for (const TintedBall& ball : setting.balls) {
    AddBall(ball, camera_, cam_from_world, spec_.haze, &patches);
  }
  Sketch(animals, frame, time, cam_from_world, &patches, bench.get());

  std::vector<Bench::Layer>& layers = bench->layers;
  layers.clear();
  for (std::uint32_t k = 0; k < patches.size(); ++k) {
    layers.push_back({patches[k].paint.depth, k, false});
  }
  for (std::uint32_t k = 0; k < bench->specks.size(); ++k) {
    layers.push_back({bench->specks[k].paint.depth, k, true});
  }
  std::stable_sort(layers.begin(), layers.end(),
                   [](const Bench::Layer& a, const Bench::Layer& b) { return a.depth > b.depth; });
  for (const Bench::Layer& layer : layers) {
    if (layer.is_speck) {
      const Bench::PaintedSpeck& s = bench->specks[layer.index];
      Draw(s.speck, s.paint, s.grain, &canvas);
    } else {
      canvas.LayOver(patches[layer.index].mask, patches[layer.index].paint);
    }
  }

  Image image(camera_.width, camera_.height);
  for (int v = 0; v < camera_.height; ++v) canvas.Develop(v, noise_.Row(v, frame), image.Row(v));
  if (bench->surfaces) bench->surfaces->Clear();
  const std::lock_guard lock(idle_mutex_);
  idle_.push_back(std::move(bench));
  return image;
}

}  // namespace flocklift
