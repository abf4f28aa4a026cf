// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/hilbert.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace flocklift::internal {
namespace {

constexpr int kBits = 21;

}  // namespace

std::uint64_t HilbertIndex(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t axis[3] = {x, y, z};
  // Undo the rotations and reflections of the curve, the coarsest bit first.
  for (std::uint32_t bit = 1U << (kBits - 1); bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& a : axis) {
      if ((a & bit) != 0) {
        axis[0] ^= below;
      } else {
        const std::uint32_t swapped = (axis[0] ^ a) & below;
        axis[0] ^= swapped;
        a ^= swapped;
      }
    }
  }
  // Gray code.
  axis[1] ^= axis[0];
  axis[2] ^= axis[1];
  std::uint32_t flip = 0;
  for (std::uint32_t bit = 1U << (kBits - 1); bit > 1; bit >>= 1) {
    if ((axis[2] & bit) != 0) flip ^= bit - 1;
  }
  std::uint64_t index = 0;
  for (int bit = kBits - 1; bit >= 0; --bit) {
    for (const std::uint32_t a : axis) index = index << 1 | (((a ^ flip) >> bit) & 1U);
  }
  return index;
}

std::vector<std::uint32_t> HilbertOrder(const std::vector<Vec3d>& points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  if (points.empty()) return order;
  Vec3d low = points[0], high = points[0];
  for (const Vec3d& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3d size = high - low;
  const double edge = std::max({size.x, size.y, size.z, 1e-300});
  const auto cell = [edge](double offset) {
    return static_cast<std::uint32_t>(offset / edge * ((1 << kBits) - 1));
  };
  std::vector<std::uint64_t> key(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3d p = points[k] - low;
    key[k] = HilbertIndex(cell(p.x), cell(p.y), cell(p.z));
  }
  std::stable_sort(order.begin(), order.end(),
                   [&key](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });
  return order;
}

}  // namespace flocklift::internal
