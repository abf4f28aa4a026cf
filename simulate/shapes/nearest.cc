// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/nearest.h"

#include <algorithm>
#include <cstddef>

// FLANN's templates convert between integers as they please.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#include <flann/flann.hpp>
#pragma GCC diagnostic pop

namespace flocklift::internal {
namespace {

constexpr std::int64_t kGrain = 512;  // points a chunk of work

// Calls search(index, queries, indices, distances, settings) for chunks of the points, and keeps
// what it found without the point itself.
template <typename Distance, typename Search>
std::vector<std::vector<std::uint32_t>> OthersNear(const std::vector<Vec3d>& points,
                                                   ThreadPool* pool, const Search& search) {
  std::vector<std::vector<std::uint32_t>> others(points.size());
  if (points.empty()) return others;
  std::vector<Vec3d> copy = points;  // FLANN wants to be able to write
  const flann::Matrix<double> rows(&copy[0].x, points.size(), 3);
  flann::KDTreeSingleIndex<Distance> index(rows, flann::KDTreeSingleIndexParams(12));
  index.buildIndex();
  pool->For(0, static_cast<std::int64_t>(points.size()), kGrain,
            [&](std::int64_t first, std::int64_t last) {
              const auto begin = static_cast<std::size_t>(first);
              const flann::Matrix<double> queries(&copy[begin].x,
                                                  static_cast<std::size_t>(last - first), 3);
              std::vector<std::vector<std::size_t>> found;
              std::vector<std::vector<double>> distances;
              search(index, queries, &found, &distances);
              for (std::size_t q = 0; q < found.size(); ++q) {
                for (const std::size_t j : found[q]) {
                  if (j != begin + q) others[begin + q].push_back(static_cast<std::uint32_t>(j));
                }
              }
            });
  return others;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> NearestOthers(const std::vector<Vec3d>& points, int count,
                                                      ThreadPool* pool) {
  const std::size_t wanted = std::min(points.size(), static_cast<std::size_t>(count) + 1);
  auto others = OthersNear<flann::L2_Simple<double>>(
      points, pool, [&](auto& index, const auto& queries, auto* found, auto* distances) {
        index.knnSearch(queries, *found, *distances, wanted,
                        flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
      });
  // Where many points coincide, a point may not be among its own nearest.
  for (auto& list : others) list.resize(std::min(list.size(), wanted - 1));
  return others;
}

std::vector<std::vector<std::uint32_t>> ManhattanNeighbours(const std::vector<Vec3d>& points,
                                                            double radius, ThreadPool* pool) {
  return OthersNear<flann::L1<double>>(
      points, pool, [&](auto& index, const auto& queries, auto* found, auto* distances) {
        flann::SearchParams all(flann::FLANN_CHECKS_UNLIMITED);
        all.sorted = false;
        index.radiusSearch(queries, *found, *distances, static_cast<float>(radius), all);
      });
}

}  // namespace flocklift::internal
