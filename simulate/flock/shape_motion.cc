// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/shape_motion.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>
#include <xsimd/xsimd.hpp>

#include "simulate/core/check.h"
#include "simulate/fields/curl_noise.h"
#include "simulate/flock/force_passes.h"
#include "simulate/flock/integrator.h"
#include "simulate/flock/kernels/swarm_kernel.h"
#include "simulate/flock/obstacle_field.h"
#include "simulate/flock/pair_forces.h"
#include "simulate/flock/shape_pairs.h"
#include "simulate/flock/shape_sums.h"
#include "simulate/flock/shape_targets.h"
#include "simulate/flock/streams.h"
#include "simulate/flock/verlet_lists.h"
#include "simulate/forces/drag.h"
#include "simulate/forces/shape_distance.h"

namespace flocklift {
namespace {

constexpr double kRangeGain = 0.3;    // of the way to the wanted number of neighbours, a step
constexpr double kRangeChange = 0.1;  // at most, of the range, a step
constexpr double kSkin = 0.18;        // of the reach, that lists of neighbours hold beyond it

const ShapeInTime& FindShape(const MotionContext& context) {
  for (const ShapeInTime& shape : context.world->shapes) {
    if (shape.name == context.shape) return shape;
  }
  RefuseModel(context, "the model shape of the species " + context.species + " has no shape",
              "name a [[shape]]: shape = \"NAME\"");
}

const PathSpec* FindPath(const MotionContext& context, const ShapeInTime& shape) {
  const std::string& name = context.path.empty() ? shape.path : context.path;
  for (const PathSpec& path : context.world->paths) {
    if (path.name == name) return &path;
  }
  return nullptr;
}

template <typename T>
std::vector<Vec3d> ByAgent(const Herd<T>& herd) {
  std::vector<Vec3d> positions(herd.size());
  for (std::size_t k = 0; k < herd.size(); ++k) {
    positions[herd.now.agent[k]] = ToDouble(herd.now.Position(k));
  }
  return positions;
}

template <typename T>
ShapeTargets MakeTargets(const MotionContext& context, const Herd<T>& herd) {
  const ShapeInTime& shape = FindShape(context);
  const bool anew = context.settled == nullptr || context.settled->position.empty();
  const std::vector<Vec3d> start = anew ? ByAgent(herd) : context.settled->position;
  Check(start.size() == herd.size(), "everybody on a shape was somewhere when places were settled");
  return ShapeTargets(shape, FindPath(context, shape), context.world->duration, start,
                      anew ? context.world->time : context.settled->time, context.world->seed,
                      context.pool->threads());
}

template <typename T>
class ShapeMotion final : public Motion<T> {
 public:
  ShapeMotion(const ShapeParameters& p, const MotionContext& context, const Herd<T>& herd)
      : p_(p),
        kernel_(std::is_same_v<T, float> ? ChooseKernel(context.kernel) : nullptr),
        targets_(MakeTargets(context, herd)),
        obstacles_(context.world->obstacles, p.obstacle_range, context.pool->threads()),
        forces_(context, herd.size()),
        noise_seed_(StreamOf(Stream::kNoise, context.world->seed, herd.first_agent).Bits()),
        range_(StartRange(context.world->time)) {
    for (std::vector<T>* column :
         {&curl_x_, &curl_y_, &curl_z_, &target_x_, &target_y_, &target_z_}) {
      column->resize(herd.size() + Bodies<T>::kPadding);
    }
  }

  void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    const double spacing = targets_.Spacing(around.time);
    const ShapePairNumbers numbers = MakeShapePairNumbers(p_, spacing, range_);
    SumNeighbours(numbers, pool, herd);
    AdaptRange(spacing, *herd, pool);
    forces_.Add(around, pool, herd);
    TakeTargets(around.time, *herd, pool);
    const Vec3<T> carried = Cast<T>(targets_.Velocity(around.time));
    pool->For(0, static_cast<std::int64_t>(herd->size()), kAgentGrain,
              [&](std::int64_t first, std::int64_t last) {
                Move(around, carried, static_cast<std::size_t>(first),
                     static_cast<std::size_t>(last), herd);
              });
  }
  void Retune(const ModelParameters& parameters) override {
    const auto& p = std::get<ShapeParameters>(parameters);
    if (p.neighbours == 0 || p_.neighbours == 0) range_ = World::kFar;
    p_ = p;
  }
  void Save(StateWriter* out) const override {
    out->Put(range_);
    lists_.Save(out);
    forces_.Save(out);
  }
  void Load(StateReader* in) override {
    in->Take(&range_);
    lists_.Load(in);
    forces_.Load(in);
  }
  Room room() const override { return {0.5 * p_.d_min, 0}; }

 private:
  // What a surface of samples would need.
  double StartRange(double time) const {
    return p_.neighbours > 0 ? std::sqrt(p_.neighbours / 3.14159) * targets_.Spacing(time)
                             : World::kFar;
  }

  // With a cap, lists of neighbours are kept; without, they would be nearly all pairs. Other terms
  // may need the order of cells at every step.
  void SumNeighbours(const ShapePairNumbers& numbers, ThreadPool* pool, Herd<T>* herd) {
    const bool keep = p_.neighbours > 0 && forces_.Reach() <= 0;
    if (keep) {
      lists_.Update(ReachOf<T>(numbers), kernel_, pool, herd);
    } else {
      herd->SortBy(std::max(Reach(numbers), forces_.Reach()), pool);
    }
    SumPairs<T>(numbers, kernel_, TaskOf(herd), keep ? &lists_ : nullptr, pool, &rows_);
  }

  // Towards the range at which animals have p_.neighbours on average; never less than what
  // repulsion and the spreading over the shape need.
  void AdaptRange(double spacing, const Herd<T>& herd, ThreadPool* pool) {
    if (p_.neighbours <= 0) return;
    const double mean =
        std::max(SumOfNeighbours(herd, pool) / static_cast<double>(herd.size()), 0.1);
    const double factor = std::pow(p_.neighbours / mean, kRangeGain);
    range_ *= std::clamp(factor, 1 - kRangeChange, 1 + kRangeChange);
    const double least = std::min(p_.r_att, std::max(p_.r_rep, 0.5 * spacing));
    range_ = std::clamp(range_, least, p_.r_att);
  }

  // The samples in the order of the herd; most steps change neither.
  void TakeTargets(double time, const Herd<T>& herd, ThreadPool* pool) {
    const std::vector<std::uint32_t>& order = herd.now.agent;
    const std::vector<Vec3d>& target = targets_.At(time, pool);
    if (taken_ == targets_.version() && taken_order_ == order) return;
    ForEachAnimal(herd, pool, [&](std::size_t k) {
      const Vec3<T> own = Cast<T>(target[order[k]]);
      target_x_[k] = own.x;
      target_y_[k] = own.y;
      target_z_[k] = own.z;
    });
    taken_ = targets_.version();
    taken_order_ = order;
  }

  // The curl noise where the animals first .. last - 1 are.
  void FillNoise(std::size_t first, std::size_t last, const Bodies<T>& s) {
    if constexpr (std::is_same_v<T, float>) {
      const SwarmNoise noise{static_cast<float>(p_.gain), static_cast<float>(p_.scale),
                             noise_seed_};
      SwarmJob job{};
      job.x = s.x.data();
      job.y = s.y.data();
      job.z = s.z.data();
      job.noise = &noise;
      job.noise_count = 1;
      job.curl = true;
      job.vx = curl_x_.data();
      job.vy = curl_y_.data();
      job.vz = curl_z_.data();
      const SwarmKernel kernel =
          kernel_ != nullptr ? FastestSwarmKernel().kernel : SwarmKernelScalar;
      kernel(job, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
    } else {
      const NoiseTerm<T> noise{static_cast<T>(p_.gain), static_cast<T>(p_.scale), noise_seed_};
      for (std::size_t k = first; k < last; ++k) {
        const Vec3<T> curl = CurlNoise(noise, s.Position(k));
        curl_x_[k] = curl.x;
        curl_y_[k] = curl.y;
        curl_z_[k] = curl.z;
      }
    }
  }

  // The numbers of the move at one step, for any scalar or pack of them.
  template <typename U>
  struct MoveNumbers {
    U dt, own, shape;
    Vec3<U> carried;
    SpeedLimit::Params<U> limit;
    Drag::Params<U> drag;
    ShapeDistance::Params<U> pull;
  };
  template <typename U>
  MoveNumbers<U> NumbersOf(double dt, const Vec3<T>& carried) const {
    const auto number = [](double value) { return U(static_cast<T>(value)); };
    const Vec3<U> wind{U(carried.x), U(carried.y), U(carried.z)};
    return {number(dt),
            number(p_.alpha),
            number(1 - p_.alpha),
            wind,
            {number(0), number(p_.s_max), number(0)},
            {number(p_.drag), wind},
            {number(p_.w_dis), number(p_.dis_range), {}}};
  }

  // The acceleration, from that of the neighbours on, and the new velocity.
  template <typename U>
  static void Drive(MoveNumbers<U> n, bool flat, const Vec3<U>& curl, const Vec3<U>& target,
                    const Vec3<U>& x, Vec3<U>* v, Vec3<U>* a) {
    n.pull.target = target;
    *a = *a + n.own * curl + n.shape * ShapeDistance::At(n.pull, x, *v) + Drag::At(n.drag, x, *v);
    if (flat) a->z = U(T(0));
    *v = n.carried + SpeedLimit::Limit(n.limit, *v + n.dt * *a - n.carried);
  }

  void Move(const Surroundings& around, const Vec3<T>& carried, std::size_t first, std::size_t last,
            Herd<T>* herd) {
    FillNoise(first, last, herd->now);
    Bodies<T>& s = herd->now;
    const bool free = obstacles_.empty();
    const auto drive = [&]<typename U>(const MoveNumbers<U>& n, std::size_t k, const auto& load,
                                       const auto& store) {
      const auto vector = [&](const std::vector<T>& a, const std::vector<T>& b,
                              const std::vector<T>& c) -> Vec3<U> {
        return {load(a.data() + k), load(b.data() + k), load(c.data() + k)};
      };
      Vec3<U> x = vector(s.x, s.y, s.z);
      Vec3<U> v = vector(s.vx, s.vy, s.vz), a = vector(herd->ax, herd->ay, herd->az);
      Drive(n, around.flat(), vector(curl_x_, curl_y_, curl_z_),
            vector(target_x_, target_y_, target_z_), x, &v, &a);
      store(a.x, herd->ax.data() + k);
      store(a.y, herd->ay.data() + k);
      store(a.z, herd->az.data() + k);
      store(v.x, s.vx.data() + k);
      store(v.y, s.vy.data() + k);
      store(v.z, s.vz.data() + k);
      if (!free) return;
      x += n.dt * v;
      store(x.x, s.x.data() + k);
      store(x.y, s.y.data() + k);
      store(x.z, s.z.data() + k);
    };
    std::size_t k = first;
    if constexpr (std::is_same_v<T, float>) {  // four at a time, rounded as one at a time
      using Pack = xsimd::batch<float, xsimd::sse2>;
      const auto n = NumbersOf<Pack>(around.dt(), carried);
      for (; k + Pack::size <= last; k += Pack::size) {
        drive(
            n, k, [](const float* from) { return Pack::load_unaligned(from); },
            [](const Pack& value, float* to) { value.store_unaligned(to); });
      }
    }
    const auto n = NumbersOf<T>(around.dt(), carried);
    for (; k < last; ++k) {
      drive(
          n, k, [](const T* from) { return *from; }, [](const T& value, T* to) { *to = value; });
    }
    for (k = first; k < last && !free; ++k) {
      const Vec3<T> v = Cast<T>(obstacles_.Turn(ToDouble(s.Position(k)), ToDouble(s.Velocity(k))));
      s.Set(k, s.Position(k) + n.dt * v, v);
    }
  }

  ShapeParameters p_;
  const KernelVariant* kernel_;  // null: scalar
  ShapeTargets targets_;
  ObstacleField obstacles_;
  ForcePasses<T> forces_;
  std::uint32_t noise_seed_;
  double range_;  // of the zones [m]
  VerletLists<T> lists_{kSkin};
  std::vector<BodyRow<T>> rows_;
  std::vector<T> curl_x_, curl_y_, curl_z_;        // curl noise, in the order of the herd
  std::vector<T> target_x_, target_y_, target_z_;  // samples, likewise [m]
  int taken_ = -1;                                 // version of the targets that these are of
  std::vector<std::uint32_t> taken_order_;
};

}  // namespace

template <typename T>
std::unique_ptr<Motion<T>> MakeShapeMotion(const ShapeParameters& parameters,
                                           const MotionContext& context, const Herd<T>& herd) {
  return std::make_unique<ShapeMotion<T>>(parameters, context, herd);
}

template std::unique_ptr<Motion<float>> MakeShapeMotion(const ShapeParameters&,
                                                        const MotionContext&, const Herd<float>&);
template std::unique_ptr<Motion<double>> MakeShapeMotion(const ShapeParameters&,
                                                         const MotionContext&, const Herd<double>&);

}  // namespace flocklift
