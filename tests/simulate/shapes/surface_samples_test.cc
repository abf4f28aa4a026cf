// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/surface_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/shapes/animated_mesh.h"
#include "simulate/shapes/surface_walk.h"
#include "tests/simulate/shapes/solids.h"

namespace flocklift {
namespace {

std::vector<Vec3d> Points(const TriangleMesh& mesh, const std::vector<SurfaceSample>& samples) {
  std::vector<Vec3d> points;
  for (const SurfaceSample& s : samples) {
    points.push_back(SamplePoint(mesh.vertices, mesh.triangles, s));
  }
  return points;
}

// Independent random points, each triangle as often as its area says.
std::vector<SurfaceSample> RandomSamples(const TriangleMesh& mesh, int count) {
  std::vector<SurfaceSample> samples;
  Rng rng(99);
  const double area = SurfaceArea(mesh);
  for (int n = 0; n < count; ++n) {
    double at = rng.Uniform() * area;
    std::uint32_t t = 0;
    for (; t + 1 < mesh.triangles.size(); ++t) {
      const Vec3d& a = mesh.Corner(t, 0);
      at -= 0.5 * Norm(Cross(mesh.Corner(t, 1) - a, mesh.Corner(t, 2) - a));
      if (at < 0) break;
    }
    const double r = std::sqrt(rng.Uniform()), side = rng.Uniform();
    samples.push_back({t, r * (1 - side), r * side});
  }
  return samples;
}

// Relative variance of the number of points within two mean spacings of each point.
double DensityVariance(const TriangleMesh& mesh, const std::vector<SurfaceSample>& samples) {
  const std::vector<Vec3d> points = Points(mesh, samples);
  const auto n = static_cast<double>(points.size());
  const double radius = 2 * std::sqrt(SurfaceArea(mesh) / n);
  double sum = 0, squares = 0;
  for (const Vec3d& p : points) {
    double count = 0;
    for (const Vec3d& q : points) count += SquaredNorm(p - q) < radius * radius;
    sum += count;
    squares += count * count;
  }
  const double mean = sum / n;
  return (squares / n - mean * mean) / (mean * mean);
}

double NearestPair(const std::vector<Vec3d>& points) {
  double nearest = 1e300;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      nearest = std::min(nearest, SquaredNorm(points[i] - points[j]));
    }
  }
  return std::sqrt(nearest);
}

void ExpectOnTheSurface(const TriangleMesh& mesh, const std::vector<SurfaceSample>& samples) {
  for (const SurfaceSample& s : samples) {
    ASSERT_LT(s.triangle, mesh.triangles.size());
    EXPECT_GE(s.u, 0);
    EXPECT_GE(s.v, 0);
    EXPECT_LE(s.u + s.v, 1 + 1e-12);
  }
}

TEST(SurfaceArea, ByHand) {
  EXPECT_NEAR(SurfaceArea(Box(1, 2, 3)), 22, 1e-12);
  EXPECT_NEAR(SurfaceArea(Ball(4)), 4 * std::numbers::pi, 0.05);
}

TEST(StratifiedSamples, AreAsManyAsAskedFor) {
  for (const int count : {0, 1, 2, 11, 12, 13, 1000}) {
    const auto samples = StratifiedSamples(Box(1, 2, 3), count, 5);
    EXPECT_EQ(samples.size(), static_cast<std::size_t>(count));
    ExpectOnTheSurface(Box(1, 2, 3), samples);
  }
  EXPECT_THROW(StratifiedSamples(TriangleMesh{}, 5, 1), std::invalid_argument);
}

TEST(StratifiedSamples, GiveEachTriangleItsShareUpToOne) {
  const TriangleMesh mesh = Box(1, 2, 3);
  const int count = 2200;
  std::vector<int> in(mesh.triangles.size());
  for (const SurfaceSample& s : StratifiedSamples(mesh, count, 5)) ++in[s.triangle];
  for (std::uint32_t t = 0; t < in.size(); ++t) {
    const Vec3d& a = mesh.Corner(t, 0);
    const double area = 0.5 * Norm(Cross(mesh.Corner(t, 1) - a, mesh.Corner(t, 2) - a));
    EXPECT_NEAR(in[t], area / 22 * count, 2);  // at either end a stratum may lean out
  }
}

TEST(StratifiedSamples, AreMoreEvenThanRandomOnes) {
  const TriangleMesh mesh = Ball(3);
  EXPECT_LT(DensityVariance(mesh, StratifiedSamples(mesh, 1500, 1)),
            0.8 * DensityVariance(mesh, RandomSamples(mesh, 1500)));
}

TEST(RelaxSamples, ConvergesToEvenSamplesOnTheSurface) {
  for (const TriangleMesh& mesh : {Ball(3), Box(1, 2, 3)}) {
    const auto stratified = StratifiedSamples(mesh, 1500, 1);
    auto samples = stratified;
    const RelaxReport report = RelaxSamples(mesh, {}, &samples);
    EXPECT_TRUE(report.converged) << report.mean_move;
    EXPECT_EQ(samples.size(), stratified.size());
    ExpectOnTheSurface(mesh, samples);
    EXPECT_LT(DensityVariance(mesh, samples),
              0.25 * DensityVariance(mesh, RandomSamples(mesh, 1500)));
    EXPECT_LT(DensityVariance(mesh, samples), 0.7 * DensityVariance(mesh, stratified));
    const double spacing = std::sqrt(SurfaceArea(mesh) / 1500);
    EXPECT_GT(NearestPair(Points(mesh, samples)), 0.5 * spacing);
    EXPECT_LT(NearestPair(Points(mesh, stratified)), 0.2 * spacing);
  }
}

TEST(RelaxSamples, PushesTwoApart) {
  const TriangleMesh mesh = Box(1, 1, 1);
  std::vector<SurfaceSample> samples{{2, 0.3, 0.3}, {2, 0.35, 0.3}};
  const double before = NearestPair(Points(mesh, samples));
  RelaxSamples(mesh, {.max_rounds = 5}, &samples);
  EXPECT_GT(NearestPair(Points(mesh, samples)), before + 0.1);
}

TEST(RelaxSamples, SameAtAnyNumberOfThreads) {
  const TriangleMesh mesh = Ball(3);
  auto one = StratifiedSamples(mesh, 2000, 3), two = one;
  EXPECT_EQ(StratifiedSamples(mesh, 2000, 3), one);
  EXPECT_NE(StratifiedSamples(mesh, 2000, 4), one);
  RelaxSamples(mesh, {.max_rounds = 20, .threads = 1}, &one);
  RelaxSamples(mesh, {.max_rounds = 20, .threads = 2}, &two);
  EXPECT_EQ(one, two);
}

TEST(SurfaceSamples, MoveWithTheMesh) {
  const TriangleMesh small = Ball(2);
  AnimatedMesh mesh{small.triangles, {small.vertices, small.vertices}};
  for (Vec3d& p : mesh.key_frames[1]) p = 3 * p + Vec3d{1, 0, 0};
  const auto samples = StratifiedSamples(small, 50, 1);
  const auto half = VerticesAt(mesh, 0.5);
  for (const SurfaceSample& s : samples) {
    const Vec3d p = SamplePoint(mesh.key_frames[0], mesh.triangles, s);
    const Vec3d q = SamplePoint(half, mesh.triangles, s);
    EXPECT_NEAR(Norm(q - (2 * p + Vec3d{0.5, 0, 0})), 0, 1e-12);
  }
}

TEST(SurfaceWalk, GoesStraightOnAroundACorner) {
  // From the middle of the bottom face of a unit cube straight on in x: 0.5 to the edge, then up.
  const TriangleMesh mesh = Box(1, 1, 1);
  const internal::SurfaceWalk walk(mesh);
  const SurfaceSample start{0, 0.3, 0.35};  // (0, 2, 1): (v, u, 0)
  const auto at = [&](double way) {
    return SamplePoint(mesh.vertices, mesh.triangles, walk.Go(start, {way, 0, 0}));
  };
  EXPECT_NEAR(Norm(at(0.2) - Vec3d{0.55, 0.3, 0}), 0, 1e-12);
  EXPECT_NEAR(Norm(at(1.0) - Vec3d{1, 0.3, 0.35}), 0, 1e-12);
  EXPECT_NEAR(Norm(at(2.0) - Vec3d{0.65, 0.3, 1}), 0, 1e-12);
  EXPECT_NEAR(Norm(at(4.0) - at(0)), 0, 1e-9);  // once around
}

TEST(SurfaceWalk, AGreatCircleIsTheShortestWay) {
  const TriangleMesh mesh = Ball(5);
  const internal::SurfaceWalk walk(mesh);
  const SurfaceSample start{100, 0.3, 0.3};
  const Vec3d from = SamplePoint(mesh.vertices, mesh.triangles, start);
  const Vec3d way = 1.5 * Normalized(Cross(walk.Normal(100), Vec3d{0.3, 0.5, 0.7}));
  const SurfaceSample end = walk.Go(start, way);
  const Vec3d to = SamplePoint(mesh.vertices, mesh.triangles, end);
  EXPECT_NEAR(std::acos(Dot(Normalized(from), Normalized(to))), 1.5, 0.01);
}

TEST(SurfaceWalk, StopsWhereTheSurfaceEnds) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const internal::SurfaceWalk walk(mesh);
  const SurfaceSample end = walk.Go({0, 0.25, 0.25}, {5, 0, 3});
  const Vec3d to = SamplePoint(mesh.vertices, mesh.triangles, end);
  EXPECT_NEAR(Norm(to - Vec3d{0.75, 0.25, 0}), 0, 1e-12);
}

}  // namespace
}  // namespace flocklift
