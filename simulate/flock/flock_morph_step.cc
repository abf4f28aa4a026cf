// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A step of a flock that morphs, and its corners afterwards.

#include <algorithm>
#include <array>
#include <limits>

#include "simulate/flock/flock_morph.h"
#include "simulate/flock/morph_style.h"
#include "simulate/flock/obstacle_avoidance.h"

namespace flocklift {
namespace {

constexpr double kNearPlace = 3;  // radii: so near its place nobody is led around anything
constexpr float kFar = std::numeric_limits<float>::max();

std::size_t FirstInPack(std::size_t rank) { return rank - rank % 16; }

}  // namespace

// ---- along the path ---------------------------------------------------------------------------

void FlockMorph::SetSegment(std::size_t rank, std::uint32_t segment) {
  const MorphPath::Segment& at = path_.At(segment);
  segment_[rank] = segment;
  way_.Set(rank, at.way);
  on_path_.Set(rank, at.from);
  gate_[rank] = at.gate;
}

// In the region, or at the path's end beside it, it turns to its place.
void FlockMorph::PassGates(std::size_t rank, bool may_be_there) {
  if (may_be_there && region_.Contains(position_.At(rank))) {
    progress_[rank] = 0;
    return;
  }
  const std::uint32_t before = segment_[rank], now = path_.Onwards(before, position_.As(rank));
  if (path_.AtEnd(now)) {
    progress_[rank] = 0;
  } else if (now != before) {
    SetSegment(rank, now);
  }
}

void FlockMorph::Depart() {
  const auto now = static_cast<float>(time());
  for (; departed_ < count_ && departure_[departed_] <= now; ++departed_) {
    progress_[departed_] = kFollows;
    SetSegment(departed_, 0);
    PassGates(departed_, true);
  }
}

// ---- style ------------------------------------------------------------------------------------

void FlockMorph::BlowStyle(std::size_t first, std::size_t last) {
  const MorphOptions& o = options_;
  if (o.omega2 == 0 || o.style == MorphStyle::kNone) return;
  if (o.style == MorphStyle::kCurl) {
    return CurlStyle(o, seed_, position_.x.data(), position_.y.data(), position_.z.data(),
                     static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last),
                     style_.x.data(), style_.y.data(), style_.z.data());
  }
  const MorphMoment now{seed_, static_cast<std::uint32_t>(steps_), dt_, time()};
  for (std::size_t k = first; k < last; ++k) {
    if (progress_[k] != kFollows) continue;
    const Vec3d before = style_.At(k);
    style_.Set(k, o.style == MorphStyle::kWind
                      ? WindStyle(o, now, k, before, segment_[k] == 0 && before == Vec3d{})
                      : GravityStyle(o, now.time - static_cast<double>(departure_[k])));
  }
}

// ---- obstacles --------------------------------------------------------------------------------

// Who would come nearer than its radius flies V_oa instead, and nobody ends inside.
void FlockMorph::Avoid(std::size_t first, std::size_t last) {
  for (std::size_t k = first; k < last; ++k) {
    const bool nears = progress_[k] >= 0;
    if (progress_[k] == 1 || progress_[k] == kWaits) continue;
    if (nears && !options_.avoid_near_target) continue;
    const Vec3d next = position_.At(k);
    const double radius = radius_[k];
    if (obstacles_.Sample(next) >= radius) continue;
    if (nears && Norm(place_.At(k) - next) < kNearPlace * radius) continue;
    const Vec3d here = before_.At(k);
    const FieldSample at = obstacles_.SampleLinear(here);
    const Vec3d outwards = Normalized(at.gradient), wanted = (next - here) / dt_;
    Vec3d to = next;
    if (Dot(outwards, wanted) < 0) {
      to = here + dt_ * AvoidObstacle(wanted, at.value, outwards, options_.k_a, options_.speed0);
    }
    const FieldSample there = obstacles_.SampleLinear(to);
    if (there.value < 0) to -= there.value * Normalized(there.gradient);
    position_.Set(k, to);
  }
}

// ---- minimum distance -------------------------------------------------------------------------

// Of the ranks that were moved: those among them that rest keep none.
void FlockMorph::KeepDistance(std::span<const CrowdBox<float>> boxes, ThreadPool* pool) {
  touched_ = 0;
  if (options_.d_min == 0) return;
  const std::size_t first = FirstInPack(first_);
  const Crowd<float> crowd{departed_ - first,
                           position_.x.data() + first,
                           position_.y.data() + first,
                           position_.z.data() + first,
                           0.0F,
                           room_.data() + first,
                           static_cast<float>(0.5 * options_.d_min)};
  if (obstacles_.values.empty()) {
    touched_ = minimum_distance_.Enforce({&crowd, 1}, boxes, pool);
  } else {
    touched_ = minimum_distance_.Enforce({&crowd, 1}, pool);  // it avoided them after it was boxed
  }
  touched_in_all_ += touched_;
}

// ---- a step -----------------------------------------------------------------------------------

void FlockMorph::Step(ThreadPool* pool) {
  Depart();
  KeepDistance(Move(pool), pool);
  ++steps_;
  Settle();
}

// Returns the boxes around each kGrain ranks before anybody avoids an obstacle.
std::vector<CrowdBox<float>> FlockMorph::Move(ThreadPool* pool) {
  static_assert(kGrain == kCrowdGrain);
  const auto first = static_cast<std::int64_t>(FirstInPack(first_));
  const auto last = static_cast<std::int64_t>(departed_);
  const MorphMoveJob job = MoveJob();
  const bool obstacles = !obstacles_.values.empty();
  std::vector<CrowdBox<float>> boxes(
      static_cast<std::size_t>((last - first + kGrain - 1) / kGrain));
  pool->For(first, last, kGrain, [&](std::int64_t begin, std::int64_t end) {
    std::array<std::uint32_t, kGrain + 8> events;
    const auto a = static_cast<std::size_t>(begin), b = static_cast<std::size_t>(end);
    BlowStyle(a, b);
    MorphBox box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
    const std::uint32_t count = kernel_->move(job, static_cast<std::uint32_t>(begin),
                                              static_cast<std::uint32_t>(end), events.data(), &box);
    boxes[static_cast<std::size_t>((begin - first) / kGrain)] = {
        {box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}};
    if (obstacles) Avoid(a, b);
    for (std::uint32_t e = 0; e < count; ++e) {
      PassGates(events[e] & ~kMorphInRegion, obstacles || (events[e] & kMorphInRegion) != 0);
    }
  });
  return boxes;
}

// Those of the lowest ranks that have arrived get their target's own corners, and rest.
void FlockMorph::Settle() {
  for (; first_ < departed_ && progress_[first_] == 1; ++first_) {
    before_.Set(first_, place_.At(first_));
    for (std::size_t c = 0; c < 4; ++c) {
      vertex_[3 * c][first_] = static_cast<float>(final_[first_][c].x);
      vertex_[3 * c + 1][first_] = static_cast<float>(final_[first_][c].y);
      vertex_[3 * c + 2][first_] = static_cast<float>(final_[first_][c].z);
    }
  }
}

void FlockMorph::UpdateVertices(ThreadPool* pool) {
  const MorphShapeJob job = ShapeJob();
  // From the first that flies on, not from a multiple of 16: those before it rest.
  pool->For(static_cast<std::int64_t>(first_), static_cast<std::int64_t>(departed_), kGrain,
            [&](std::int64_t begin, std::int64_t end) {
              kernel_->shape(job, static_cast<std::uint32_t>(begin),
                             static_cast<std::uint32_t>(end));
            });
}

MorphMoveJob FlockMorph::MoveJob() {
  const MorphOptions& o = options_;
  const bool styled = o.omega2 != 0 && o.style != MorphStyle::kNone, wide = o.width > 0;
  const auto f = [](double value) { return static_cast<float>(value); };
  return {.x = position_.x.data(),
          .y = position_.y.data(),
          .z = position_.z.data(),
          .before_x = before_.x.data(),
          .before_y = before_.y.data(),
          .before_z = before_.z.data(),
          .progress = progress_.data(),
          .room = o.d_min > 0 ? room_.data() : nullptr,
          .way_x = way_.x.data(),
          .way_y = way_.y.data(),
          .way_z = way_.z.data(),
          .gate = gate_.data(),
          .path_x = wide ? on_path_.x.data() : nullptr,
          .path_y = on_path_.y.data(),
          .path_z = on_path_.z.data(),
          .style_x = styled ? style_.x.data() : nullptr,
          .style_y = style_.y.data(),
          .style_z = style_.z.data(),
          .place_x = place_.x.data(),
          .place_y = place_.y.data(),
          .place_z = place_.z.data(),
          .path_speed = f(o.omega1 * o.speed0),
          .speed = f(o.speed0),
          .half_width = f(0.5 * o.width),
          .pull = f(o.pull),
          .dt = f(dt_),
          .most_room = f(0.5 * o.d_min),
          .spaced_until = o.space_near_target ? 1.0F : 0.0F,
          .region = region_.View()};
}

MorphShapeJob FlockMorph::ShapeJob() {
  MorphShapeJob job{};
  job.x = position_.x.data();
  job.y = position_.y.data();
  job.z = position_.z.data();
  job.progress = progress_.data();
  job.departure = departure_.data();
  for (std::size_t c = 0; c < 9; ++c) {
    job.corner[c] = corner_[c].data();
    job.stretched[c] = stretched_[c].data();
  }
  for (std::size_t c = 0; c < 12; ++c) job.vertex[c] = vertex_[c].data();
  job.axis_x = axis_.x.data();
  job.axis_y = axis_.y.data();
  job.axis_z = axis_.z.data();
  job.half_angle = half_angle_.data();
  job.now = static_cast<float>(time());
  job.shrink = static_cast<float>(options_.shrink);
  job.per_shrink_time = static_cast<float>(1 / options_.shrink_time);
  job.morph_share = static_cast<float>(options_.morph_share);
  job.shoemake = options_.kind == MorphKind::kShoemake;
  return job;
}

}  // namespace flocklift
