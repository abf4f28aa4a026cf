// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/flock_morph.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulate/core/check.h"
#include "simulate/fields/curl_noise.h"
#include "simulate/flock/obstacle_avoidance.h"
#include "simulate/flock/streams.h"
#include "simulate/shapes/morph_order.h"

namespace flocklift {
namespace {

constexpr std::size_t kPadding = 32;
constexpr std::int64_t kGrain = 2048;  // tetrahedra a chunk of work, a multiple of 16
constexpr double kNearPlace = 3;       // radii: so near its place nobody is led around anything

const MorphKernelVariant* ChooseKernel(const std::string& name) {
  const MorphKernelVariant* best = nullptr;
  for (const MorphKernelVariant& variant : kMorphKernels) {
    if (variant.supported() && (name.empty() || name == variant.name)) best = &variant;
  }
  Check(best != nullptr, "this machine has no kernel `" + name + "`");
  return best;
}

std::vector<Vec3d> Centroids(std::span<const Tetra> tetrahedra) {
  std::vector<Vec3d> centroids;
  centroids.reserve(tetrahedra.size());
  for (const Tetra& t : tetrahedra) centroids.push_back(Centroid(t));
  return centroids;
}

}  // namespace

void FlockMorph::Columns3::Resize(std::size_t n) {
  for (Column* column : {&x, &y, &z}) column->assign(n, 0.0F);
}

void FlockMorph::Columns3::Set(std::size_t k, const Vec3d& v) {
  x[k] = static_cast<float>(v.x);
  y[k] = static_cast<float>(v.y);
  z[k] = static_cast<float>(v.z);
}

FlockMorph::FlockMorph(const MorphScene& scene, const std::string& kernel)
    : options_(scene.options),
      dt_(scene.dt),
      seed_(scene.seed),
      kernel_(ChooseKernel(kernel)),
      obstacles_(scene.obstacles),
      count_(scene.from.size()) {
  const MorphOptions& o = options_;
  Check(count_ > 0 && scene.to.size() == count_, "source and target need equally many tetrahedra");
  Check(dt_ > 0 && o.speed0 > 0, "time step and speed must be positive");
  Check(o.shrink > 0 && o.shrink <= 1 && o.shrink_time > 0, "tetrahedra shrink to a part of 1");
  Check(o.morph_share > 0 && o.morph_share < 1, "the share of the morphing is between 0 and 1");
  Check(o.departure_time >= 0 && o.d_min >= 0 && o.k_a > 0, "times and lengths are positive");
  for (const Vec3d& q : scene.path) {
    if (path_.empty() || Norm(q - path_.back()) > 1e-9) path_.push_back(q);
  }
  Check(path_.size() >= 2, "a path needs two points");
  region_ = TargetRegion(o.region, scene.to, o.margin);
  SetShapes(scene);
  ThreadPool alone(1);
  kernel_->shape(ShapeJob(), 0, static_cast<std::uint32_t>(count_));
}

void FlockMorph::SetShapes(const MorphScene& scene) {
  const std::size_t padded = count_ + kPadding;
  for (Columns3* columns :
       {&position_, &before_, &way_, &on_path_, &style_, &place_, &axis_, &crowd_position_}) {
    columns->Resize(padded);
  }
  progress_.assign(padded, kWaits);
  departure_.assign(padded, std::numeric_limits<float>::max());
  for (Column* column : {&gate_, &half_angle_, &radius_, &crowd_room_})
    column->assign(padded, 0.0F);
  for (auto* columns : {&corner_, &stretched_}) {
    for (Column& column : *columns) column.assign(padded, 0.0F);
  }
  for (Column& column : vertex_) column.assign(padded, 0.0F);

  const std::vector<std::uint32_t> departure = DepartureOrder(path_, Centroids(scene.from));
  target_ = ArrivalOrder(path_, Centroids(scene.to));
  rank_.resize(count_);
  segment_.assign(count_, 0);
  final_.resize(count_);
  for (std::size_t k = 0; k < count_; ++k) {
    rank_[departure[k]] = static_cast<std::uint32_t>(k);
    const Tetra& from = scene.from[departure[k]];
    Tetra to = scene.to[target_[k]];
    if (options_.match_corners) to = MatchCorners(from, to);
    final_[k] = to;
    const TetraMorph morph(from, to);
    const Vec3d centroid = Centroid(from);
    position_.Set(k, centroid);
    place_.Set(k, Centroid(to));
    axis_.Set(k, {morph.axis.x, morph.axis.y, morph.axis.z});
    half_angle_[k] = static_cast<float>(0.5 * morph.angle);
    radius_[k] = static_cast<float>(options_.shrink * BoundingRadius(from));
    departure_[k] = static_cast<float>(options_.departure_time * static_cast<double>(k) /
                                       static_cast<double>(count_));
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::dvec3 offset{from[c].x - centroid.x, from[c].y - centroid.y,
                              from[c].z - centroid.z};
      const glm::dvec3 stretched = morph.stretch * offset;
      for (int axis = 0; axis < 3; ++axis) {
        corner_[3 * c + axis][k] = static_cast<float>(offset[axis]);
        stretched_[3 * c + axis][k] = static_cast<float>(stretched[axis]);
      }
    }
  }
  before_ = position_;
}

// ---- along the path ---------------------------------------------------------------------------

// The plane between key points i and i + 1, nearer to the second beyond, is the gate to segment
// i + 1; the last segment's gate is the path's end.
void FlockMorph::SetSegment(std::size_t rank, std::uint32_t segment) {
  const bool last = segment + 2 >= path_.size();
  const Vec3d &from = path_[segment], &to = path_[segment + 1];
  const Vec3d way = Normalized(to - from);
  segment_[rank] = segment;
  way_.Set(rank, way);
  on_path_.Set(rank, from);
  gate_[rank] = static_cast<float>(Dot(way, last ? to : 0.5 * (from + to)));
}

void FlockMorph::PassGates(std::size_t rank) {
  const Vec3d p = position_.At(rank);
  if (region_.Contains(p)) {
    progress_[rank] = 0;
    return;
  }
  while (Dot(way_.At(rank), p) > static_cast<double>(gate_[rank])) {
    if (segment_[rank] + 2 >= path_.size()) {
      progress_[rank] = 0;  // the end of the path, beside the region
      return;
    }
    SetSegment(rank, segment_[rank] + 1);
  }
}

void FlockMorph::Depart() {
  const auto now = static_cast<float>(time());
  for (; departed_ < count_ && departure_[departed_] <= now; ++departed_) {
    progress_[departed_] = kFollows;
    SetSegment(departed_, 0);
    PassGates(departed_);
  }
}

// ---- style ------------------------------------------------------------------------------------

void FlockMorph::BlowStyle(ThreadPool* pool) {
  if (options_.omega2 == 0 || options_.style == MorphStyle::kNone) return;
  pool->For(static_cast<std::int64_t>(first_), static_cast<std::int64_t>(departed_), kGrain,
            [&](std::int64_t first, std::int64_t last) {
              for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last);
                   ++k) {
                if (progress_[k] == kFollows) style_.Set(k, StyleVelocity(k));
              }
            });
}

// omega2 V_l.
Vec3d FlockMorph::StyleVelocity(std::size_t rank) {
  const MorphOptions& o = options_;
  switch (o.style) {
    case MorphStyle::kCurl: {
      const NoiseTerm<float> term{static_cast<float>(o.gain), static_cast<float>(o.scale),
                                  static_cast<std::uint32_t>(seed_)};
      const Vec3<float> v =
          CurlNoise(term, Vec3<float>{position_.x[rank], position_.y[rank], position_.z[rank]});
      return o.omega2 * Vec3d{v.x, v.y, v.z};
    }
    case MorphStyle::kWind: {  // turbulence as an Ornstein-Uhlenbeck process of each tetrahedron
      const Vec3d mean = o.omega2 * o.wind_speed * Normalized(o.wind);
      const bool fresh = segment_[rank] == 0 && style_.At(rank) == Vec3d{};
      const double kept = fresh ? 0 : std::exp(-dt_ / o.wind_time);
      Rng rng = StreamOf(Stream::kNoise, seed_, rank, static_cast<std::uint32_t>(steps_));
      const Vec3d draw{rng.Normal(), rng.Normal(), rng.Normal()};
      return mean + kept * (fresh ? Vec3d{} : style_.At(rank) - mean) +
             o.omega2 * o.wind_speed * std::sqrt(1 - kept * kept) * draw;
    }
    case MorphStyle::kGravity: {
      const double age = time() - static_cast<double>(departure_[rank]);
      return {0, 0, -o.omega2 * std::min(o.gravity * age, o.fall_speed)};
    }
    case MorphStyle::kNone:
      break;
  }
  return {};
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

void FlockMorph::KeepDistance(ThreadPool* pool) {
  touched_ = 0;
  if (options_.d_min == 0) return;
  const auto room = static_cast<float>(0.5 * options_.d_min);
  const bool near_target = options_.space_near_target;
  crowd_.resize(departed_ - first_);
  std::size_t n = 0;
  for (std::size_t k = first_; k < departed_; ++k) {
    const float progress = progress_[k];
    crowd_[n] = static_cast<std::uint32_t>(k);
    crowd_position_.x[n] = position_.x[k];
    crowd_position_.y[n] = position_.y[k];
    crowd_position_.z[n] = position_.z[k];
    crowd_room_[n] = room * (1 - std::max(progress, 0.0F));
    n += progress < (near_target ? 1.0F : 0.0F) ? 1 : 0;
  }
  const Crowd<float> crowd{
      n,    crowd_position_.x.data(), crowd_position_.y.data(), crowd_position_.z.data(),
      0.0F, crowd_room_.data()};
  touched_ = minimum_distance_.Enforce({&crowd, 1}, pool);
  touched_in_all_ += touched_;
  if (touched_ == 0) return;
  for (std::size_t j = 0; j < n; ++j) {
    position_.x[crowd_[j]] = crowd_position_.x[j];
    position_.y[crowd_[j]] = crowd_position_.y[j];
    position_.z[crowd_[j]] = crowd_position_.z[j];
  }
}

// ---- a step -----------------------------------------------------------------------------------

void FlockMorph::Step(ThreadPool* pool) {
  Depart();
  const auto first = static_cast<std::int64_t>(first_ - first_ % 16);
  const auto last = static_cast<std::int64_t>(departed_);
  BlowStyle(pool);
  const MorphMoveJob job = MoveJob();
  const bool obstacles = !obstacles_.values.empty();
  pool->For(first, last, kGrain, [&](std::int64_t begin, std::int64_t end) {
    std::array<std::uint32_t, kGrain> events;
    const auto a = static_cast<std::size_t>(begin), b = static_cast<std::size_t>(end);
    const auto copy = [&](const Column& from, Column* to) {
      std::copy(from.begin() + begin, from.begin() + end, to->begin() + begin);
    };
    copy(position_.x, &before_.x);
    copy(position_.y, &before_.y);
    copy(position_.z, &before_.z);
    const std::uint32_t count = kernel_->move(job, static_cast<std::uint32_t>(begin),
                                              static_cast<std::uint32_t>(end), events.data());
    if (obstacles) Avoid(a, b);
    for (std::uint32_t e = 0; e < count; ++e) PassGates(events[e]);
  });
  KeepDistance(pool);
  ++steps_;
  Settle();
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
  const BoundingSphere& sphere = region_.sphere();
  return {.x = position_.x.data(),
          .y = position_.y.data(),
          .z = position_.z.data(),
          .progress = progress_.data(),
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
          .region_x = f(sphere.centre.x),
          .region_y = f(sphere.centre.y),
          .region_z = f(sphere.centre.z),
          .squared_reach = f(sphere.radius * sphere.radius * (1 + 1e-5))};
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

void FlockMorph::Rest() { touched_ = 0; }

void FlockMorph::Retune(const MorphOptions& options) {
  Check(options.speed0 > 0 && options.d_min >= 0 && options.k_a > 0,
        "speeds and lengths are positive");
  MorphOptions next = options;
  // Baked into the arrays.
  next.region = options_.region;
  next.margin = options_.margin;
  next.shrink = options_.shrink;
  next.departure_time = options_.departure_time;
  next.match_corners = options_.match_corners;
  options_ = next;
}

void FlockMorph::Save(StateWriter* out) const {
  out->Put(steps_);
  out->Put(touched_in_all_);
  out->Put(static_cast<std::uint64_t>(departed_));
  for (const Columns3* columns : {&position_, &before_, &way_, &on_path_, &style_}) {
    for (const Column* column : {&columns->x, &columns->y, &columns->z}) out->Put(*column);
  }
  out->Put(progress_);
  out->Put(gate_);
  out->Put(segment_);
}

void FlockMorph::Load(StateReader* in) {
  in->Take(&steps_);
  in->Take(&touched_in_all_);
  std::uint64_t departed = 0;
  in->Take(&departed);
  for (Columns3* columns : {&position_, &before_, &way_, &on_path_, &style_}) {
    for (Column* column : {&columns->x, &columns->y, &columns->z}) in->Take(column);
  }
  in->Take(&progress_);
  in->Take(&gate_);
  in->Take(&segment_);
  departed_ = departed;
  first_ = 0;
  Settle();
}

Vec3d FlockMorph::Position(std::size_t tetra) const { return position_.At(rank_[tetra]); }

Vec3d FlockMorph::Velocity(std::size_t tetra) const {
  const std::uint32_t rank = rank_[tetra];
  return (position_.At(rank) - before_.At(rank)) / dt_;
}

Vec3<float> FlockMorph::Vertex(std::size_t tetra, int corner) const {
  const std::uint32_t rank = rank_[tetra];
  const auto c = 3 * static_cast<std::size_t>(corner);
  return {vertex_[c][rank], vertex_[c + 1][rank], vertex_[c + 2][rank]};
}

}  // namespace flocklift
