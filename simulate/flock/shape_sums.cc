// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/shape_sums.h"

#include <algorithm>
#include <type_traits>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

// Animal k, whose neighbours are places[begin .. end - 1]. As the kernels do it: the n-th is added
// to sum n % 8.
template <typename T>
void SumOne(const ShapePairs<T>& rules, const std::vector<BodyRow<T>>& rows,
            const PairTask<T>& task, std::uint32_t k, const std::uint32_t* begin,
            const std::uint32_t* end) {
  const Vec3<T> x = rows[k].Position(), v = rows[k].Velocity();
  typename ShapePairs<T>::ByTerm counts;
  for (const std::uint32_t* j = begin; j < end; ++j) {
    rules.Count(rules.LookAt(rows[*j].Position() - x), &counts);
  }
  const auto gains = rules.Gains(counts);
  Vec3<T> eight[8] = {};
  for (const std::uint32_t* j = begin; j < end; ++j) {
    const auto look = rules.LookAt(rows[*j].Position() - x);
    eight[(j - begin) % 8] +=
        rules.Pair(gains, look.direction, look.squared, look.fall, rows[*j].Velocity() - v);
  }
  for (std::size_t half = 4; half > 0; half /= 2) {
    for (std::size_t m = 0; m < half; ++m) eight[m] += eight[m + half];
  }
  task.ax[k] = eight[0].x;
  task.ay[k] = eight[0].y;
  task.az[k] = eight[0].z;
  task.neighbours[k] = rules.Neighbours(counts);
}

// What the kernels keep of eight neighbours.
struct alignas(32) Looks {
  float numbers[5 * 8];
};

float F(double value) { return static_cast<float>(value); }

// The animals first .. last - 1, whose lists they are.
template <typename T>
void SumListed(const ShapePairNumbers& n, const KernelVariant* kernel, const PairTask<T>& task,
               const std::vector<BodyRow<T>>& rows, const NearLists& lists, std::uint32_t first,
               std::uint32_t last) {
  if constexpr (std::is_same_v<T, float>) {
    if (kernel != nullptr) {
      static_assert(sizeof(Looks) == 5 * 8 * sizeof(float));
      thread_local std::vector<Looks> looks;
      looks.resize(std::max(looks.size(), rows.size() / 8 + 125));
      const ShapeJob job{.rows = &rows[0].x,
                         .begin = lists.begin.data(),
                         .places = lists.places.data(),
                         .owner = lists.owner.data(),
                         .looks = looks[0].numbers,
                         .r_rep = F(n.r_rep),
                         .r_ali = F(n.r_ali),
                         .r_att = F(n.r_att),
                         .w_rep = F(n.w_rep),
                         .w_ali = F(n.w_ali),
                         .w_att = F(n.w_att),
                         .w_con = F(n.w_con),
                         .reach = F(n.reach),
                         .sigma = F(n.sigma),
                         .ax = task.ax.data(),
                         .ay = task.ay.data(),
                         .az = task.az.data(),
                         .neighbours = task.neighbours.data()};
      return kernel->shape(job, first, last);
    }
  }
  const ShapePairs<T> rules = MakeShapePairs<T>(n);
  for (std::uint32_t k = first; k < last; ++k) {
    SumOne(rules, rows, task, k, lists.places.data() + lists.begin[k - first],
           lists.places.data() + lists.begin[k - first + 1]);
  }
}

}  // namespace

template <typename T>
void SumPairs(const ShapePairNumbers& n, const KernelVariant* kernel, const PairTask<T>& task,
              const VerletLists<T>* kept, ThreadPool* pool, std::vector<BodyRow<T>>* rows) {
  FLOCKLIFT_DCHECK(task.sample == nullptr && task.nearest == nullptr);
  FillRows(task.bodies, pool, rows);
  pool->For(0, static_cast<std::int64_t>(task.bodies.size()), kListGrain,
            [&](std::int64_t begin, std::int64_t end) {
              const auto first = static_cast<std::uint32_t>(begin);
              const auto last = static_cast<std::uint32_t>(end);
              if (kept != nullptr) {
                const NearLists& lists = kept->chunk(static_cast<std::size_t>(begin / kListGrain));
                SumListed(n, kernel, task, *rows, lists, first, last);
                return;
              }
              thread_local NearLists lists;
              for (std::uint32_t from = first; from < last;) {
                lists.Clear();
                const std::uint32_t to =
                    ListNear(task.grid, task.bodies, ReachOf<T>(n), kernel, from, last, &lists);
                SumListed(n, kernel, task, *rows, lists, from, to);
                from = to;
              }
            });
}

template void SumPairs(const ShapePairNumbers&, const KernelVariant*, const PairTask<float>&,
                       const VerletLists<float>*, ThreadPool*, std::vector<BodyRow<float>>*);
template void SumPairs(const ShapePairNumbers&, const KernelVariant*, const PairTask<double>&,
                       const VerletLists<double>*, ThreadPool*, std::vector<BodyRow<double>>*);

}  // namespace flocklift
