// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/flock_morph.h"

#include <limits>

#include "simulate/core/check.h"
#include "simulate/shapes/morph_order.h"

namespace flocklift {
namespace {

constexpr std::size_t kPadding = 32;

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

void FlockMorph::Columns3::Set(std::size_t k, const Vec3<float>& v) {
  x[k] = v.x;
  y[k] = v.y;
  z[k] = v.z;
}

FlockMorph::FlockMorph(const MorphScene& scene, const std::string& kernel)
    : options_(scene.options),
      dt_(scene.dt),
      seed_(scene.seed),
      kernel_(ChooseKernel(kernel)),
      path_(scene.path),
      obstacles_(scene.obstacles),
      count_(scene.from.size()) {
  const MorphOptions& o = options_;
  Check(count_ > 0 && scene.to.size() == count_, "source and target need equally many tetrahedra");
  Check(dt_ > 0 && o.speed0 > 0, "time step and speed must be positive");
  Check(o.shrink > 0 && o.shrink <= 1 && o.shrink_time > 0, "tetrahedra shrink to a part of 1");
  Check(o.morph_share > 0 && o.morph_share < 1, "the share of the morphing is between 0 and 1");
  Check(o.departure_time >= 0 && o.d_min >= 0 && o.k_a > 0, "times and lengths are positive");
  region_ = TargetRegion(o.region, scene.to, o.margin);
  SetShapes(scene);
  kernel_->shape(ShapeJob(), 0, static_cast<std::uint32_t>(count_));
}

void FlockMorph::SetShapes(const MorphScene& scene) {
  const std::size_t padded = count_ + kPadding;
  for (Columns3* columns : {&position_, &before_, &way_, &on_path_, &style_, &place_, &axis_}) {
    columns->Resize(padded);
  }
  progress_.assign(padded, kWaits);
  departure_.assign(padded, std::numeric_limits<float>::max());
  for (Column* column : {&gate_, &half_angle_, &radius_, &room_}) column->assign(padded, 0.0F);
  for (auto* columns : {&corner_, &stretched_}) {
    for (Column& column : *columns) column.assign(padded, 0.0F);
  }
  for (Column& column : vertex_) column.assign(padded, 0.0F);

  const std::vector<std::uint32_t> departure =
      DepartureOrder(path_.points(), Centroids(scene.from));
  target_ = ArrivalOrder(path_.points(), Centroids(scene.to));
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
    axis_.Set(k, Vec3d{morph.axis.x, morph.axis.y, morph.axis.z});
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
