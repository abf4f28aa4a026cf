// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Flock morphing (X. Wang, L. Zhou, Z. Deng, X. Jin, "Flock morphing animation", CAVW 2014;
// equations.md, section 7): a solid of tetrahedra flies apart, along a path, and together again as
// another. Tetrahedra leave in the order D1; the k-th to leave takes the k-th place in the order
// D2.
//   phase 1  V = omega1 V_g + omega2 V_l (+ back to the path beyond its width), V_oa near obstacles
//   phase 2  from the target region on: V = speed0 towards the place, and there exactly
// and after every move the minimum distance is enforced. In phase 2 distance and obstacles count as
// well (the paper has neither there): who is pushed aside flies from where it then is, and the
// distance that it keeps falls to 0 with the way that is left.
//
// The path's direction is that of the nearest key point, which is sought from the own last one on:
// a path may cross itself. Tetrahedra that miss the region turn to their places at the path's end.
//
// Held by rank in the order of departure, so that those in flight are neighbours in memory. Float,
// and the same bytes at any number of threads and with any kernel variant.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_FLOCK_MORPH_H_
#define FLOCKLIFT_SIMULATE_FLOCK_FLOCK_MORPH_H_

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/core/state_archive.h"
#include "simulate/fields/grid_field.h"
#include "simulate/flock/bodies.h"
#include "simulate/flock/kernels/morph_kernel.h"
#include "simulate/flock/minimum_distance.h"
#include "simulate/flock/morph_options.h"
#include "simulate/flock/morph_path.h"
#include "simulate/shapes/tetra_mesh.h"

namespace flocklift {

struct MorphScene {
  std::vector<Tetra> from, to;  // equally many (SubdivideTo), all positively oriented [m]
  std::vector<Vec3d> path;      // key points Q_0 .. Q_{m+1}, at least two, densely sampled [m]
  ScalarField obstacles;        // signed distance; without values: none
  MorphOptions options;
  std::uint64_t seed = 1;
  double dt = 1.0 / 60;  // [s]
};

class FlockMorph {
 public:
  static constexpr std::int64_t kGrain = 512;  // tetrahedra a chunk of work, a multiple of 16

  // `kernel` is a name of kMorphKernels; empty: the fastest there is. Throws std::invalid_argument
  // for what makes no sense.
  explicit FlockMorph(const MorphScene& scene, const std::string& kernel = {});

  void Step(ThreadPool* pool);
  void UpdateVertices(ThreadPool* pool);  // of who flies, for the time now
  void Rest();                            // a step in which nothing moves and no time passes

  // Other numbers from the next step on; shapes, orders and the target region stay as they are.
  void Retune(const MorphOptions& options);

  // What changes while it flies; Load into one made from the same scene.
  void Save(StateWriter* out) const;
  void Load(StateReader* in);

  std::size_t size() const { return count_; }
  bool Done() const { return first_ == count_; }  // all have arrived
  double time() const { return static_cast<double>(steps_) * dt_; }
  std::size_t InFlight() const { return departed_ - first_; }
  // Ranks below the first rest at their places, ranks from the second on have not left.
  std::size_t FirstInFlight() const { return first_; }
  std::size_t EndInFlight() const { return departed_; }
  std::int64_t touched() const { return touched_; }  // by the minimum distance, last step
  std::int64_t TouchedInAll() const { return touched_in_all_; }  // over all steps

  // By the index in MorphScene::from.
  std::uint32_t RankOf(std::size_t tetra) const { return rank_[tetra]; }
  std::uint32_t TargetOf(std::size_t tetra) const { return target_[rank_[tetra]]; }
  Vec3d Position(std::size_t tetra) const;
  Vec3d Velocity(std::size_t tetra) const;  // of the last step [m/s]
  // Of the ranks first .. last - 1, to the same places of columns of float or double.
  template <typename T>
  void CopyStates(std::size_t first, std::size_t last, Bodies<T>* to) const;
  float Progress(std::size_t tetra) const { return progress_[rank_[tetra]]; }
  Vec3<float> Vertex(std::size_t tetra, int corner) const;

 private:
  using Column = std::vector<float>;
  struct Columns3 {
    Column x, y, z;
    void Resize(std::size_t n);
    void Set(std::size_t k, const Vec3d& v);
    void Set(std::size_t k, const Vec3<float>& v);
    Vec3<float> As(std::size_t k) const { return {x[k], y[k], z[k]}; }
    Vec3d At(std::size_t k) const { return {x[k], y[k], z[k]}; }
  };

  void SetShapes(const MorphScene& scene);
  void SetSegment(std::size_t rank, std::uint32_t segment);
  void PassGates(std::size_t rank, bool may_be_there);
  void Depart();
  void BlowStyle(std::size_t first, std::size_t last);
  void Avoid(std::size_t first, std::size_t last);
  std::vector<CrowdBox<float>> Move(ThreadPool* pool);
  void KeepDistance(std::span<const CrowdBox<float>> boxes, ThreadPool* pool);
  void Settle();
  MorphMoveJob MoveJob();
  MorphShapeJob ShapeJob();

  MorphOptions options_;
  double dt_;
  std::uint64_t seed_;
  const MorphKernelVariant* kernel_ = nullptr;
  MorphPath path_;
  ScalarField obstacles_;
  TargetRegion region_;
  std::size_t count_ = 0, departed_ = 0, first_ = 0;  // ranks first_ .. departed_ - 1 fly
  std::int64_t steps_ = 0, touched_ = 0, touched_in_all_ = 0;

  std::vector<std::uint32_t> rank_, target_;  // by tetrahedron; by rank
  std::vector<Tetra> final_;                  // by rank, corners as matched
  std::vector<std::uint32_t> segment_;
  Columns3 position_, before_, way_, on_path_, style_, place_, axis_;
  Column progress_, gate_, departure_, half_angle_, radius_;
  std::array<Column, 9> corner_, stretched_;
  std::array<Column, 12> vertex_;

  MinimumDistance<float> minimum_distance_;
  Column room_;  // half of the distance that each keeps [m]
};

template <typename T>
void FlockMorph::CopyStates(std::size_t first, std::size_t last, Bodies<T>* to) const {
  const T rate = static_cast<T>(1 / dt_);
  const auto copy = [&](const Column& now, const Column& before, std::vector<T>* x,
                        std::vector<T>* v) {
    for (std::size_t k = first; k < last; ++k) {
      const T here = static_cast<T>(now[k]);
      (*x)[k] = here;
      (*v)[k] = (here - static_cast<T>(before[k])) * rate;
    }
  };
  copy(position_.x, before_.x, &to->x, &to->vx);
  copy(position_.y, before_.y, &to->y, &to->vy);
  copy(position_.z, before_.z, &to->z, &to->vz);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_FLOCK_MORPH_H_
