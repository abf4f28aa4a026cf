// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/pair_forces.h"

#include <algorithm>
#include <type_traits>

#include "simulate/core/check.h"
#include "simulate/core/scratch.h"
#include "simulate/flock/listed_sums.h"
#include "simulate/shapes/nearest.h"

namespace flocklift {
namespace {

constexpr std::int64_t kPairGrain = 512;  // animals a chunk of work
constexpr std::int64_t kRows = 8;         // of cells a chunk of work
constexpr double kFarSight = 1e9;         // [m]
constexpr double kReachMargin = 1.0001;   // of the kernels' boxes, against rounding

float F(double value) { return static_cast<float>(value); }

// Animal k, whose neighbours visit(fn) tells one after the other: fn(j).
template <typename T, typename Rules, typename Visit>
void SumOne(const Rules& rules, const PairTask<T>& task, std::size_t k, const Visit& visit) {
  const Bodies<T>& s = task.bodies;
  const Vec3<T> x = s.Position(k), v = s.Velocity(k);
  const auto own = rules.For(v);
  typename Rules::Sums sum;
  visit([&](std::uint32_t j) { sum += own.Pair(s.Position(j) - x, s.Velocity(j) - v); });
  const Vec3<T> acceleration = own.Finish(sum);
  task.ax[k] = acceleration.x;
  task.ay[k] = acceleration.y;
  task.az[k] = acceleration.z;
  task.neighbours[k] = sum.Neighbours();
}

// The same with the eight sums of the kernel that goes animal by animal (zones_kernel_inl.h):
// neighbours are those that are felt, and the n-th is added to sum n % 8.
// Where some are listed apart, either list has an n of its own.
template <typename T, typename Rules, typename Visit>
void SumOneOfEight(const Rules& rules, const PairTask<T>& task, std::size_t k, const Visit& visit) {
  const Bodies<T>& s = task.bodies;
  const Vec3<T> x = s.Position(k), v = s.Velocity(k);
  typename Rules::Sums eight[8];
  std::size_t counts[2] = {};
  visit([&](std::uint32_t j) {
    const Vec3<T> dx = s.Position(j) - x;
    if (!rules.Felt(dx)) return;
    bool apart = false;
    if constexpr (requires { rules.Apart(dx); }) apart = rules.Apart(dx);
    eight[counts[apart ? 1 : 0]++ % 8] += rules.Pair(dx, s.Velocity(j) - v);
  });
  for (std::size_t half = 4; half > 0; half /= 2) {
    for (std::size_t n = 0; n < half; ++n) eight[n] += eight[n + half];
  }
  const Vec3<T> acceleration = rules.Finish(eight[0]);
  task.ax[k] = acceleration.x;
  task.ay[k] = acceleration.y;
  task.az[k] = acceleration.z;
  task.neighbours[k] = eight[0].Neighbours();
}

template <typename T, typename Rules>
void SumLists(const Rules& rules, const PairTask<T>& task, ThreadPool* pool) {
  pool->For(0, static_cast<std::int64_t>(task.bodies.size()), kPairGrain,
            [&](std::int64_t first, std::int64_t last) {
              for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last);
                   ++k) {
                const auto visit = [&](const auto& neighbour) {
                  for (const std::uint32_t j : (*task.nearest)[k]) neighbour(j);
                };
                SumOne(rules, task, k, visit);
              }
            });
}

// fn(lists, first, last) for all animals whose neighbours are listed.
template <typename T, typename Function>
void ForEachList(const PairTask<T>& task, ThreadPool* pool, const Function& fn) {
  pool->For(0, static_cast<std::int64_t>(task.bodies.size()), kListGrain,
            [&](std::int64_t first, std::int64_t last) {
              fn(task.lists->chunk(static_cast<std::size_t>(first / kListGrain)),
                 static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
            });
}

template <typename T, typename Rules>
void SumScalar(const Rules& rules, const PairTask<T>& task, ThreadPool* pool) {
  if (task.nearest != nullptr) return SumLists(rules, task, pool);
  if (task.lists != nullptr) {
    return ForEachList(task, pool,
                       [&](const NearLists& lists, std::uint32_t first, std::uint32_t last) {
                         SumListedScalar(rules, task.lists->rows(), task, lists, first, last);
                       });
  }
  const auto g = task.grid.view();
  pool->For(0, g.RowCount(), kRows, [&](std::int64_t first_row, std::int64_t last_row) {
    for (auto row = static_cast<int>(first_row); row < last_row; ++row) {
      const int b = 1 + row % g.ny, c = 1 + row / g.ny;
      const RowSample sample =
          task.sample == nullptr ? RowSample{1, 0} : (*task.sample)[static_cast<std::size_t>(row)];
      for (std::uint32_t k = g.start[g.Cell(1, b, c)]; k < g.start[g.Cell(g.nx, b, c) + 1]; ++k) {
        const int a = g.CellX(task.bodies.x[k]);
        const auto visit = [&](const auto& neighbour) {
          CellGrid<T>::ForEachRun(g, a, a, b, c, [&](std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t j = first; j < last; ++j) {
              if (j != k && j % sample.stride == sample.phase) neighbour(j);
            }
          });
        };
        if constexpr (requires { Rules::ByAnimal(true); }) {
          if (Rules::ByAnimal(task.sample != nullptr)) {
            SumOneOfEight(rules, task, k, visit);
            continue;
          }
        }
        SumOne(rules, task, k, visit);
      }
    }
  });
}

template <typename Job>
void SumWith(void (*kernel)(const Job&, std::uint32_t, std::uint32_t, std::uint32_t*),
             const Job& job, const PairTask<float>& task, ThreadPool* pool) {
  const std::size_t n = task.bodies.size();
  if (task.lists != nullptr) {
    return ForEachList(
        task, pool, [&](const NearLists& lists, std::uint32_t first, std::uint32_t last) {
          Job listed = job;
          listed.pairs.listed = {&task.lists->rows()[0].x, lists.begin.data(), lists.places.data()};
          kernel(listed, first, last, nullptr);
        });
  }
  pool->For(0, static_cast<std::int64_t>(n), kPairGrain,
            [&](std::int64_t first, std::int64_t last) {
              thread_local Scratch<std::uint32_t> candidates;
              kernel(job, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last),
                     candidates.Reserve(n + 32));
            });
}

PairJob MakeJob(const PairTask<float>& task, double reach) {
  const auto g = task.grid.view();
  const Bodies<float>& s = task.bodies;
  return {.start = g.start,
          .low_x = g.low_x,
          .inverse_edge = g.inverse_edge,
          .nx = g.nx,
          .ny = g.ny,
          .nz = g.nz,
          .x = s.x.data(),
          .y = s.y.data(),
          .z = s.z.data(),
          .vx = s.vx.data(),
          .vy = s.vy.data(),
          .vz = s.vz.data(),
          .reach = F(kReachMargin * reach),
          .sample = task.sample == nullptr ? nullptr : task.sample->data(),
          .listed = {},
          .sums = SumsOf(task)};
}

}  // namespace

const KernelVariant* ChooseKernel(const std::string& name) {
  if (name == "scalar") return nullptr;
  const KernelVariant* best = nullptr;
  for (const KernelVariant* variant : kKernels) {
    if (variant->supported() && (name.empty() || name == variant->name)) best = variant;
  }
  Check(best != nullptr, "this machine has no kernel `" + name + "`");
  return best;
}

template <typename T>
void SumPairs(const BoidsParameters<double>& given, const KernelVariant* kernel,
              const PairTask<T>& task, ThreadPool* pool) {
  BoidsParameters<double> p = given;
  if (task.nearest != nullptr) p.d_v = kFarSight;
  const bool cone = p.blind > 0;
  const double cosine = SightCosine(p.blind);
  if constexpr (std::is_same_v<T, float>) {
    if (kernel != nullptr && task.nearest == nullptr) {
      const BoidsJob job{.pairs = MakeJob(task, Reach(p)),
                         .d_s = F(p.d_s),
                         .d_v = F(p.d_v),
                         .alpha_s = F(p.alpha_s),
                         .alpha_c = F(p.alpha_c),
                         .alpha_a = F(p.alpha_a),
                         .taper = F(p.taper),
                         .cone = cone,
                         .view_cosine = F(cosine),
                         .view_taper = F(p.blind_taper)};
      return SumWith(kernel->boids, job, task, pool);
    }
  }
  const auto t = [](double value) { return static_cast<T>(value); };
  const bool soft = p.taper > 0 || (cone && p.blind_taper > 0);
  if (soft && cone) {
    const ViewCone<T> view{{}, t(cosine), t(p.blind_taper)};
    SumScalar(MakeBoidsPairs<T>(p, t(p.taper), view), task, pool);
  } else if (soft) {
    SumScalar(MakeBoidsPairs<T>(p, t(p.taper)), task, pool);
  } else if (cone) {
    const ViewCone<T, HardEdge> view{{}, t(cosine), {}};
    SumScalar(MakeBoidsPairs<T>(p, HardEdge{}, view), task, pool);
  } else {
    SumScalar(MakeBoidsPairs<T>(p, HardEdge{}), task, pool);
  }
}

template <typename T>
void SumPairs(const ZoneParameters& p, const KernelVariant* kernel, const PairTask<T>& task,
              ThreadPool* pool) {
  if constexpr (std::is_same_v<T, float>) {
    if (kernel != nullptr && task.nearest == nullptr) {
      const ZonesJob job{.pairs = MakeJob(task, Reach(p)),
                         .r_rep = F(p.r_rep),
                         .r_ali = F(p.r_ali),
                         .r_att = F(p.r_att),
                         .w_rep = F(p.w_rep),
                         .w_ali = F(p.w_ali),
                         .w_att = F(p.w_att),
                         .taper = F(p.taper)};
      return SumWith(kernel->zones, job, task, pool);
    }
  }
  if (p.taper > 0) {
    SumScalar(MakeZonePairs<T>(p, static_cast<T>(p.taper)), task, pool);
  } else {
    SumScalar(MakeZonePairs<T>(p, HardEdge{}), task, pool);
  }
}

template <typename T>
void SumPairs(const SteerParameters& p, const KernelVariant* kernel, const PairTask<T>& task,
              ThreadPool* pool) {
  if constexpr (std::is_same_v<T, float>) {
    if (kernel != nullptr && task.nearest == nullptr) {
      const auto rule = [](const SteerRule& r) -> SteerJob::Rule {
        return {F(r.weight), F(r.radius), F(r.cosine)};
      };
      const SteerJob job{.pairs = MakeJob(task, Reach(p)),
                         .separation = rule(p.separation),
                         .alignment = rule(p.alignment),
                         .cohesion = rule(p.cohesion),
                         .near = F(p.near),
                         .taper = F(p.taper),
                         .view_taper = F(p.view_taper)};
      return SumWith(kernel->steer, job, task, pool);
    }
  }
  if (p.taper > 0 || p.view_taper > 0) {
    const auto taper = static_cast<T>(p.taper), view_taper = static_cast<T>(p.view_taper);
    SumScalar(MakeSteerPairs<T>(p, taper, view_taper), task, pool);
  } else {
    SumScalar(MakeSteerPairs<T>(p, HardEdge{}, HardEdge{}), task, pool);
  }
}

template <typename T>
void SampleRows(const CellGrid<T>& grid, std::uint32_t most, std::uint32_t step,
                std::vector<RowSample>* rows) {
  const auto g = grid.view();
  const double share = std::min(1.0, 3.0 / g.nx);  // of a row, that touches one of its cells
  rows->resize(static_cast<std::size_t>(g.RowCount()));
  for (int row = 0; row < g.RowCount(); ++row) {
    std::uint32_t candidates = 0;
    CellGrid<T>::ForEachRun(
        g, 1, g.nx, 1 + row % g.ny, 1 + row / g.ny,
        [&](std::uint32_t first, std::uint32_t last) { candidates += last - first; });
    const double wanted = share * candidates / static_cast<double>(most);
    const auto stride = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(wanted + 0.5));
    // Any mixing will do that visits all phases of a stride in turn.
    const std::uint32_t mixed = static_cast<std::uint32_t>(row) * 2654435761U + step * 40503U;
    (*rows)[static_cast<std::size_t>(row)] = {stride, (mixed >> 4) % stride};
  }
}

template <typename T>
NeighbourLists FindNearest(const Bodies<T>& bodies, int count, ThreadPool* pool) {
  std::vector<Vec3d> points(bodies.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3<T> x = bodies.Position(k);
    points[k] = {static_cast<double>(x.x), static_cast<double>(x.y), static_cast<double>(x.z)};
  }
  NeighbourLists lists = internal::NearestOthers(points, count, pool);
  for (std::vector<std::uint32_t>& list : lists) std::sort(list.begin(), list.end());
  return lists;
}

#define FLOCKLIFT_INSTANTIATE(T)                                                                   \
  template void SumPairs(const BoidsParameters<double>&, const KernelVariant*, const PairTask<T>&, \
                         ThreadPool*);                                                             \
  template void SumPairs(const ZoneParameters&, const KernelVariant*, const PairTask<T>&,          \
                         ThreadPool*);                                                             \
  template void SumPairs(const SteerParameters&, const KernelVariant*, const PairTask<T>&,         \
                         ThreadPool*);                                                             \
  template NeighbourLists FindNearest(const Bodies<T>&, int, ThreadPool*);                         \
  template void SampleRows(const CellGrid<T>&, std::uint32_t, std::uint32_t,                       \
                           std::vector<RowSample>*);
FLOCKLIFT_INSTANTIATE(float)
FLOCKLIFT_INSTANTIATE(double)
#undef FLOCKLIFT_INSTANTIATE

}  // namespace flocklift
