// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The body of every variant of the morph kernels. Everything lives in an anonymous namespace
// (kernels.h says why).

#ifndef FLOCKLIFT_SIMULATE_FLOCK_KERNELS_MORPH_KERNEL_INL_H_
#define FLOCKLIFT_SIMULATE_FLOCK_KERNELS_MORPH_KERNEL_INL_H_

#include <cstdint>
#include <limits>
#include <xsimd/xsimd.hpp>

#include "simulate/core/vec3.h"
#include "simulate/flock/kernels/morph_kernel.h"

namespace flocklift {
namespace {

template <typename Pack>
Vec3<Pack> Load(const float* x, const float* y, const float* z, std::uint32_t k) {
  return {Pack::load_unaligned(x + k), Pack::load_unaligned(y + k), Pack::load_unaligned(z + k)};
}

template <typename Pack>
void Store(const Vec3<Pack>& p, float* x, float* y, float* z, std::uint32_t k) {
  p.x.store_unaligned(x + k);
  p.y.store_unaligned(y + k);
  p.z.store_unaligned(z + k);
}

template <typename Mask, typename Pack>
Vec3<Pack> Choose(const Mask& mask, const Vec3<Pack>& a, const Vec3<Pack>& b) {
  return {xsimd::select(mask, a.x, b.x), xsimd::select(mask, a.y, b.y),
          xsimd::select(mask, a.z, b.z)};
}

inline bool InRegion(const MorphRegion& region, float x, float y, float z) {
  if (region.cells == nullptr) return true;
  const float u = (x - region.low_x) * region.per_cell, v = (y - region.low_y) * region.per_cell,
              w = (z - region.low_z) * region.per_cell;
  if (!(u >= 0 && v >= 0 && w >= 0)) return false;
  const auto i = static_cast<std::int32_t>(u), j = static_cast<std::int32_t>(v),
             l = static_cast<std::int32_t>(w);
  if (i >= region.nx || j >= region.ny || l >= region.nz) return false;
  const std::int32_t cell = (l * region.ny + j) * region.nx + i;
  return (region.cells[cell >> 3] >> (cell & 7) & 1) != 0;
}

// Box around packs, a box a lane.
template <typename Pack>
struct LaneBoxes {
  Vec3<Pack> low, high;

  explicit LaneBoxes(const MorphBox& box)
      : low{Pack(box.low[0]), Pack(box.low[1]), Pack(box.low[2])},
        high{Pack(box.high[0]), Pack(box.high[1]), Pack(box.high[2])} {}

  void Add(const Vec3<Pack>& p) {  // in this order what is not a number does not count
    low = {xsimd::min(p.x, low.x), xsimd::min(p.y, low.y), xsimd::min(p.z, low.z)};
    high = {xsimd::max(p.x, high.x), xsimd::max(p.y, high.y), xsimd::max(p.z, high.z)};
  }
  void Add(const Vec3<Pack>& p, std::uint32_t lanes) {
    alignas(64) float some[Pack::size];
    const auto first = [&](const Pack& from, const Pack& rest) {
      alignas(64) float kept[Pack::size];
      from.store_aligned(some);
      rest.store_aligned(kept);
      for (std::uint32_t lane = lanes; lane < Pack::size; ++lane) some[lane] = kept[lane];
      return Pack::load_aligned(some);
    };
    Add({first(p.x, low.x), first(p.y, low.y), first(p.z, low.z)});
  }

  void Store(MorphBox* box) const {
    const auto all = [](const Pack& lanes, float start, auto better) {
      alignas(64) float each[Pack::size];
      lanes.store_aligned(each);
      for (const float v : each) start = better(v, start) ? v : start;
      return start;
    };
    const auto less = [](float a, float b) { return a < b; };
    const auto more = [](float a, float b) { return a > b; };
    const Pack lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    for (int axis = 0; axis < 3; ++axis) {
      box->low[axis] = all(lows[axis], box->low[axis], less);
      box->high[axis] = all(highs[axis], box->high[axis], more);
    }
  }
};

// Where those that follow the path are after a step.
template <typename Pack>
Vec3<Pack> Follow(const MorphMoveJob& job, std::uint32_t k, const Vec3<Pack>& x,
                  const Vec3<Pack>& way) {
  Vec3<Pack> velocity = way * Pack(job.path_speed);
  if (job.style_x != nullptr) velocity += Load<Pack>(job.style_x, job.style_y, job.style_z, k);
  if (job.path_x != nullptr) {  // back to the path where it is farther than half the width
    const Vec3<Pack> from_path = x - Load<Pack>(job.path_x, job.path_y, job.path_z, k);
    const Vec3<Pack> aside = from_path - way * Dot(from_path, way);
    const Pack distance = xsimd::sqrt(Dot(aside, aside));
    const Pack beyond = xsimd::max(Pack(0.0f), distance - Pack(job.half_width));
    velocity -= aside * (Pack(job.pull) * beyond / xsimd::max(distance, Pack(1e-20f)));
  }
  return x + velocity * Pack(job.dt);
}

template <typename Pack>
std::uint32_t MorphMove(const MorphMoveJob& job, std::uint32_t first, std::uint32_t last,
                        std::uint32_t* events, MorphBox* box) {
  constexpr auto kLanes = static_cast<std::uint32_t>(Pack::size);
  const Pack zero(0.0f), one(1.0f), step(job.speed * job.dt), tiny(1e-20f);
  const MorphRegion& region = job.region;
  const Vec3<Pack> middle{Pack(region.sphere_x), Pack(region.sphere_y), Pack(region.sphere_z)};
  LaneBoxes<Pack> boxes(*box);
  std::uint32_t count = 0;
  for (std::uint32_t k = first; k < last; k += kLanes) {
    const Pack progress = Pack::load_unaligned(job.progress + k);
    const auto nears = progress >= zero, follows = progress == Pack(kFollows);
    const Vec3<Pack> x = Load<Pack>(job.x, job.y, job.z, k);
    Vec3<Pack> next = x;
    Pack next_progress = progress;
    if (xsimd::any(follows)) {
      const Vec3<Pack> way = Load<Pack>(job.way_x, job.way_y, job.way_z, k);
      next = Choose(follows, Follow(job, k, x, way), x);
      const Vec3<Pack> from_middle = next - middle;
      const auto gate = follows && Dot(next, way) > Pack::load_unaligned(job.gate + k);
      const auto near = follows && Dot(from_middle, from_middle) < Pack(region.squared_reach);
      const unsigned gates = LaneMask(gate);
      for (unsigned left = gates | LaneMask(near); left != 0; left &= left - 1) {
        const auto lane = static_cast<std::uint32_t>(__builtin_ctz(left));
        const bool inside = (LaneMask(near) >> lane & 1U) != 0 &&
                            InRegion(region, next.x.get(lane), next.y.get(lane), next.z.get(lane));
        events[count] = (k + lane) | (inside ? kMorphInRegion : 0);
        count += (inside || (gates >> lane & 1U) != 0) && k + lane < last ? 1 : 0;
      }
    }
    if (xsimd::any(nears)) {
      const Vec3<Pack> place = Load<Pack>(job.place_x, job.place_y, job.place_z, k);
      const Vec3<Pack> left = place - x;
      const Pack distance = xsimd::sqrt(Dot(left, left));
      const auto arrives = distance <= step;
      const Pack share = step / xsimd::max(distance, tiny);
      next = Choose(nears, Choose(arrives, place, x + left * share), next);
      next_progress = xsimd::select(
          nears, xsimd::select(arrives, one, one - (one - progress) * (one - share)), progress);
    }
    if (last - k >= kLanes) {
      boxes.Add(next);
    } else {
      boxes.Add(next, last - k);
    }
    Store(x, job.before_x, job.before_y, job.before_z, k);
    Store(next, job.x, job.y, job.z, k);
    next_progress.store_unaligned(job.progress + k);
    if (job.room != nullptr) {
      const Pack room = Pack(job.most_room) * (one - xsimd::max(zero, next_progress));
      const Pack none(std::numeric_limits<float>::quiet_NaN());
      xsimd::select(next_progress < Pack(job.spaced_until), room, none)
          .store_unaligned(job.room + k);
    }
  }
  boxes.Store(box);
  return count;
}

// 3 s^2 - 2 s^3 of s held in [0, 1].
template <typename Pack>
Pack Eased(const Pack& s) {
  const Pack held = xsimd::min(xsimd::max(s, Pack(0.0f)), Pack(1.0f));
  return held * held * (Pack(3.0f) - (held + held));
}

// Taylor sums, good to 6e-8 for 0 <= x <= pi / 2.
template <typename Pack>
Pack SineTo90(const Pack& x) {
  const Pack q = x * x;
  Pack sum(-1.0f / 39916800);
  sum = sum * q + Pack(1.0f / 362880);
  sum = sum * q - Pack(1.0f / 5040);
  sum = sum * q + Pack(1.0f / 120);
  sum = sum * q - Pack(1.0f / 6);
  return x + x * (sum * q);
}
template <typename Pack>
Pack CosineTo90(const Pack& x) {
  const Pack q = x * x;
  Pack sum(1.0f / 479001600);
  sum = sum * q - Pack(1.0f / 3628800);
  sum = sum * q + Pack(1.0f / 40320);
  sum = sum * q - Pack(1.0f / 720);
  sum = sum * q + Pack(1.0f / 24);
  sum = sum * q - Pack(0.5f);
  return sum * q + Pack(1.0f);
}

template <typename Pack>
void StoreCorner(const MorphShapeJob& job, int corner, std::uint32_t k, const Vec3<Pack>& p) {
  Store(p, job.vertex[3 * corner], job.vertex[3 * corner + 1], job.vertex[3 * corner + 2], k);
}

template <typename Pack, bool kShoemakes>
void MorphShapeAs(const MorphShapeJob& job, std::uint32_t first, std::uint32_t last) {
  const Pack zero(0.0f), one(1.0f), two(2.0f), shrink(job.shrink);
  const Pack per_morph(1 / job.morph_share), per_growth(1 / (1 - job.morph_share));
  for (std::uint32_t k = first; k < last; k += static_cast<std::uint32_t>(Pack::size)) {
    const Pack progress = Pack::load_unaligned(job.progress + k);
    const Vec3<Pack> x = Load<Pack>(job.x, job.y, job.z, k);
    const Pack age = Pack(job.now) - Pack::load_unaligned(job.departure + k);
    Pack size = one - (one - shrink) * Eased<Pack>(age * Pack(job.per_shrink_time));
    Vec3<Pack> corner[3];
    for (int c = 0; c < 3; ++c) {
      corner[c] = Load<Pack>(job.corner[3 * c], job.corner[3 * c + 1], job.corner[3 * c + 2], k);
    }
    if (xsimd::any(progress >= zero)) {
      const Pack t = Eased<Pack>(progress * per_morph);
      const Pack growth = Eased<Pack>((progress - Pack(job.morph_share)) * per_growth);
      size = xsimd::max(size, shrink + (one - shrink) * growth);
      const Pack half = t * Pack::load_unaligned(job.half_angle + k);
      const Pack w = CosineTo90(half);
      const Vec3<Pack> q = Load<Pack>(job.axis_x, job.axis_y, job.axis_z, k) * SineTo90(half);
      const auto turn = [&](const Vec3<Pack>& v) {  // by the unit quaternion (w, q)
        const Vec3<Pack> across = Cross(q, v) * two;
        return v + across * w + Cross(q, across);
      };
      for (int c = 0; c < 3; ++c) {
        const Vec3<Pack> stretched =
            Load<Pack>(job.stretched[3 * c], job.stretched[3 * c + 1], job.stretched[3 * c + 2], k);
        if constexpr (kShoemakes) {
          corner[c] = turn(corner[c] * (one - t) + stretched * t);
        } else {
          corner[c] = corner[c] * (one - t) + turn(stretched) * t;
        }
      }
    }
    for (Vec3<Pack>& c : corner) c *= size;
    StoreCorner(job, 3, k, x - (corner[0] + corner[1] + corner[2]));
    for (int c = 0; c < 3; ++c) StoreCorner(job, c, k, x + corner[c]);
  }
}

template <typename Pack>
void MorphShape(const MorphShapeJob& job, std::uint32_t first, std::uint32_t last) {
  if (job.shoemake) {
    MorphShapeAs<Pack, true>(job, first, last);
  } else {
    MorphShapeAs<Pack, false>(job, first, last);
  }
}

}  // namespace
}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_KERNELS_MORPH_KERNEL_INL_H_
