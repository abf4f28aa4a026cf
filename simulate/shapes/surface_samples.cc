// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/core/rng.h"
#include "simulate/shapes/hilbert.h"
#include "simulate/shapes/nearest.h"
#include "simulate/shapes/surface_walk.h"

namespace flocklift {
namespace {

constexpr double kSkin = 0.5;         // neighbours are listed this much farther, in mean spacings
constexpr std::int64_t kGrain = 512;  // samples a chunk of work

double Area(const TriangleMesh& mesh, std::size_t t) {
  const Vec3d& a = mesh.Corner(t, 0);
  return 0.5 * Norm(Cross(mesh.Corner(t, 1) - a, mesh.Corner(t, 2) - a));
}

std::vector<Vec3d> Points(const TriangleMesh& mesh, const std::vector<SurfaceSample>& samples) {
  std::vector<Vec3d> points;
  points.reserve(samples.size());
  for (const SurfaceSample& s : samples) {
    points.push_back(SamplePoint(mesh.vertices, mesh.triangles, s));
  }
  return points;
}

struct ShapePush {
  double reach, inverse_two_sigma_squared;

  Vec3d On(std::size_t i, const std::vector<Vec3d>& points,
           const std::vector<std::uint32_t>& neighbours) const {
    Vec3d sum;
    int count = 0;
    for (const std::uint32_t j : neighbours) {
      const Vec3d away = points[i] - points[j];
      const double manhattan = std::abs(away.x) + std::abs(away.y) + std::abs(away.z);
      if (manhattan >= reach) continue;
      sum += std::exp(-manhattan * manhattan * inverse_two_sigma_squared) * Normalized(away);
      ++count;
    }
    return count > 0 ? sum / count : Vec3d{};
  }
};

}  // namespace

double SurfaceArea(const TriangleMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += Area(mesh, t);
  return area;
}

std::vector<SurfaceSample> StratifiedSamples(const TriangleMesh& mesh, int count,
                                             std::uint64_t seed) {
  const double area = SurfaceArea(mesh);
  Check(std::isfinite(area) && area > 0, "a mesh without area has no place for samples");
  Check(count >= 0, "the number of samples must not be negative");
  // Triangles along a curve that fills space, so that a stratum that spans several is one patch.
  std::vector<Vec3d> centers;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    centers.push_back((mesh.Corner(t, 0) + mesh.Corner(t, 1) + mesh.Corner(t, 2)) / 3);
  }
  const std::vector<std::uint32_t> order = internal::HilbertOrder(centers);
  std::vector<SurfaceSample> samples;
  samples.reserve(static_cast<std::size_t>(count));
  std::size_t k = 0;
  double before = 0, here = Area(mesh, order[0]);  // area up to and of triangle order[k]
  for (int n = 0; n < count; ++n) {
    Rng rng(seed, static_cast<std::uint64_t>(n));
    const double at = (n + rng.Uniform()) / count * area;
    while (at > before + here && k + 1 < order.size()) {
      before += here;
      here = Area(mesh, order[++k]);
    }
    // A strip across the triangle per stratum: r^2 is the share of the area nearer to corner a.
    const double r = std::sqrt(std::clamp((at - before) / std::max(here, 1e-300), 0.0, 1.0));
    const double side = rng.Uniform();
    samples.push_back({order[k], r * (1 - side), r * side});
  }
  return samples;
}

RelaxReport RelaxSamples(const TriangleMesh& mesh, const RelaxOptions& options,
                         std::vector<SurfaceSample>* samples) {
  CheckOptions(options);
  RelaxReport report;
  if (samples->size() < 2) return {.rounds = 0, .mean_move = 0, .converged = true};
  const double spacing = std::sqrt(SurfaceArea(mesh) / static_cast<double>(samples->size()));
  const double sigma = options.omega * spacing;
  const ShapePush push{options.k * spacing, 1 / (2 * sigma * sigma)};
  const internal::SurfaceWalk walk(mesh);
  ThreadPool pool(options.threads);
  std::vector<Vec3d> points = Points(mesh, *samples), listed_at;
  std::vector<std::vector<std::uint32_t>> neighbours;
  std::vector<double> moved(points.size()), strayed(points.size());
  double farthest = 1e300;  // from where the neighbours were listed
  while (report.rounds < options.max_rounds && !report.converged) {
    // A Manhattan distance is at most sqrt(3) times the Euclidean one, and both ends move.
    if (2 * std::sqrt(3.0) * farthest > kSkin * spacing) {
      neighbours = internal::ManhattanNeighbours(points, push.reach + kSkin * spacing, &pool);
      listed_at = points;
    }
    const double step = options.step * spacing / (1 + report.rounds / 20.0);
    std::vector<Vec3d> next(points.size());
    pool.For(0, static_cast<std::int64_t>(points.size()), kGrain,
             [&](std::int64_t first, std::int64_t last) {
               for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last);
                    ++i) {
                 const Vec3d way = step * push.On(i, points, neighbours[i]);
                 SurfaceSample& sample = (*samples)[i];
                 sample = walk.Go(sample, way);
                 next[i] = SamplePoint(mesh.vertices, mesh.triangles, sample);
                 moved[i] = Norm(next[i] - points[i]);
                 strayed[i] = Norm(next[i] - listed_at[i]);
               }
             });
    points.swap(next);
    double sum = 0;
    for (const double way : moved) sum += way;
    farthest = *std::max_element(strayed.begin(), strayed.end());
    report.mean_move = sum / static_cast<double>(points.size()) / spacing;
    report.converged = report.mean_move < options.tolerance;
    ++report.rounds;
  }
  return report;
}

}  // namespace flocklift
