// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/shape_sums.h"

#include <algorithm>
#include <type_traits>

#include "simulate/core/check.h"
#include "simulate/flock/listed_sums.h"

namespace flocklift {
namespace {

float F(double value) { return static_cast<float>(value); }

template <typename T>
void SumListed(const ShapePairNumbers& n, const KernelVariant* kernel, const PairTask<T>& task,
               const std::vector<BodyRow<T>>& rows, const NearLists& lists, std::uint32_t first,
               std::uint32_t last) {
  if constexpr (std::is_same_v<T, float>) {
    if (kernel != nullptr) {
      const ShapeJob job{.listed = {&rows[0].x, lists.begin.data(), lists.places.data()},
                         .r_rep = F(n.r_rep),
                         .r_ali = F(n.r_ali),
                         .r_att = F(n.r_att),
                         .w_rep = F(n.w_rep),
                         .w_ali = F(n.w_ali),
                         .w_att = F(n.w_att),
                         .w_con = F(n.w_con),
                         .reach = F(n.reach),
                         .sigma = F(n.sigma),
                         .sums = SumsOf(task)};
      return kernel->shape(job, first, last);
    }
  }
  SumListedScalar(MakeShapePairs<T>(n), rows, task, lists, first, last);
}

}  // namespace

template <typename T>
void SumPairs(const ShapePairNumbers& n, const KernelVariant* kernel, const PairTask<T>& task,
              const VerletLists<T>* kept, ThreadPool* pool, std::vector<BodyRow<T>>* rows) {
  FLOCKLIFT_DCHECK(task.sample == nullptr && task.nearest == nullptr);
  if (kept == nullptr) FillRows(task.bodies, pool, rows);
  pool->For(0, static_cast<std::int64_t>(task.bodies.size()), kListGrain,
            [&](std::int64_t begin, std::int64_t end) {
              const auto first = static_cast<std::uint32_t>(begin);
              const auto last = static_cast<std::uint32_t>(end);
              if (kept != nullptr) {
                const NearLists& lists = kept->chunk(static_cast<std::size_t>(begin / kListGrain));
                SumListed(n, kernel, task, kept->rows(), lists, first, last);
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
