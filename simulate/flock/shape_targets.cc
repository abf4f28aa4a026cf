// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/shape_targets.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"
#include "simulate/fields/mesh_distance.h"
#include "simulate/shapes/correspondence.h"

namespace flocklift {
namespace {

constexpr std::int64_t kGrain = 1024;  // samples a chunk of work

std::vector<SurfaceSample> EvenSamples(const TriangleMesh& mesh, std::size_t count,
                                       std::uint64_t seed, int threads) {
  std::vector<SurfaceSample> samples = StratifiedSamples(mesh, static_cast<int>(count), seed);
  RelaxSamples(mesh, {.threads = threads}, &samples);
  return samples;
}

void TakePoints(const TriangleMesh& mesh, const std::vector<SurfaceSample>& samples,
                ThreadPool* pool, std::vector<Vec3d>* points) {
  points->resize(samples.size());
  pool->For(0, static_cast<std::int64_t>(samples.size()), kGrain,
            [&](std::int64_t first, std::int64_t last) {
              for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last);
                   ++k) {
                (*points)[k] = SamplePoint(mesh.vertices, mesh.triangles, samples[k]);
              }
            });
}

}  // namespace

ShapeTargets::ShapeTargets(const ShapeInTime& shape, const PathSpec* path, double duration,
                           const std::vector<Vec3d>& start, double time, std::uint64_t seed,
                           int threads)
    : shape_(shape), start_time_(time) {
  Check(!shape.meshes.empty(), "a shape needs a mesh");
  if (path != nullptr) {
    path_.emplace(path->points, false);
    path_speed_ = path->speed > 0 ? path->speed : path_->length() / duration;
  }
  ThreadPool pool(threads);
  std::vector<Vec3d> here = start, points;
  const std::size_t shapes = shape.period > 0 ? 1 : shape.meshes.size();
  for (std::size_t k = 0; k < shapes; ++k) {
    const bool first = k == 0;
    // The first shape as it stands now; the others in the place of the one before.
    const TriangleMesh mesh = first ? MeshAt(time) : shape.meshes[k];
    const std::vector<SurfaceSample> samples = EvenSamples(mesh, start.size(), seed + k, threads);
    TakePoints(mesh, samples, &pool, &points);
    const std::vector<std::uint32_t> target_of = MatchTargets(here, points, {});
    std::vector<SurfaceSample>& by_agent = samples_.emplace_back();
    for (const std::uint32_t target : target_of) by_agent.push_back(samples[target]);
    spacing_.push_back(std::sqrt(SurfaceArea(mesh) / static_cast<double>(start.size())));
    TakePoints(shape.meshes[k], by_agent, &pool, &here);
  }
}

// The last one that has begun.
std::size_t ShapeTargets::ShapeAt(double time) const {
  if (shape_.period > 0) return 0;
  const auto after = std::upper_bound(shape_.times.begin() + 1, shape_.times.end(), time);
  return static_cast<std::size_t>(after - shape_.times.begin() - 1);
}

TriangleMesh ShapeTargets::MeshAt(double time) const {
  TriangleMesh mesh = shape_.meshes[ShapeAt(time)];
  if (shape_.period > 0 && shape_.meshes.size() > 1) {
    const std::size_t count = shape_.meshes.size();
    const double phase = time - shape_.period * std::floor(time / shape_.period);
    std::size_t k = static_cast<std::size_t>(
        std::upper_bound(shape_.times.begin(), shape_.times.end(), phase) - shape_.times.begin());
    k = (k + count - 1) % count;  // before the first key-frame is after the last
    const std::size_t next = (k + 1) % count;
    const double gap = shape_.times[next] - shape_.times[k] + (next == 0 ? shape_.period : 0);
    const double past = phase - shape_.times[k] + (phase < shape_.times[k] ? shape_.period : 0);
    const double share = gap > 0 ? past / gap : 0;
    const TriangleMesh& from = shape_.meshes[k];
    const TriangleMesh& to = shape_.meshes[next];
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      mesh.vertices[v] = (1 - share) * from.vertices[v] + share * to.vertices[v];
    }
  }
  if (path_) {
    const Rigid3d world_from_path = path_->WorldFromPath(path_speed_ * (time - start_time_));
    for (Vec3d& v : mesh.vertices) v = world_from_path * v;
  }
  return mesh;
}

const std::vector<Vec3d>& ShapeTargets::At(double time, ThreadPool* pool) {
  const bool animated = path_ || (shape_.period > 0 && shape_.meshes.size() > 1);
  const bool same = target_time_ && (*target_time_ == time ||
                                     (!animated && ShapeAt(*target_time_) == ShapeAt(time)));
  if (!same) {
    TakePoints(MeshAt(time), samples_[ShapeAt(time)], pool, &target_);
    ++version_;
  }
  target_time_ = time;
  return target_;
}

Vec3d ShapeTargets::Velocity(double time) const {
  if (!path_) return {};
  const double at = path_speed_ * (time - start_time_);
  return at < 0 || at > path_->length() ? Vec3d{} : path_speed_ * path_->Tangent(at);
}

double ShapeTargets::Spacing(double time) const { return spacing_[ShapeAt(time)]; }

double ShapeTargets::MeanDistanceToSurface(const std::vector<Vec3d>& points, double time) const {
  const MeshDistance distance(MeshAt(time));
  double sum = 0;
  std::uint32_t hint = 0;
  for (const Vec3d& p : points) {
    const SurfacePoint nearest = distance.Closest(p, hint);
    hint = nearest.triangle;
    sum += std::abs(nearest.distance);
  }
  return sum / static_cast<double>(points.size());
}

}  // namespace flocklift
