// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Loops on several threads whose result does not depend on how many there are: [begin, end) is cut
// into chunks of `grain` (the last may be shorter), and `fn(first, last)` is called once for each.
// The cut depends on nothing but begin, end and grain. Which thread does which chunk is left open,
// so `fn` must write only what belongs to its chunk; ordered sums add per-chunk results afterwards.
// Each thread begins with a share of its own, the same from loop to loop, and then helps the
// others: what a chunk has read and written before is mostly still in that core's cache.

#ifndef FLOCKLIFT_SIMULATE_CORE_PARALLEL_FOR_H_
#define FLOCKLIFT_SIMULATE_CORE_PARALLEL_FOR_H_

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "simulate/core/check.h"

namespace flocklift {

// `threads` as an option means it: 0 or less asks for all that the machine has.
inline int ResolveThreads(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// Threads that wait between loops; for code that runs many short ones. The caller's thread works
// too. One loop at a time, and no loop inside a loop of the same pool.
class ThreadPool {
 public:
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  // Rethrows the exception of the first chunk that threw; chunks after it may be left out.
  template <typename Function>
  void For(std::int64_t begin, std::int64_t end, std::int64_t grain, const Function& fn) {
    FLOCKLIFT_DCHECK(grain > 0);
    if (workers_.empty() || end - begin <= grain) {
      for (std::int64_t first = begin; first < end; first += grain) {
        fn(first, std::min(first + grain, end));
      }
      return;
    }
    const std::int64_t chunks = (end - begin + grain - 1) / grain;
    const int shares = threads();
    const auto begin_of = [&](int share) { return chunks * share / shares; };
    for (int k = 0; k < shares; ++k) next_[static_cast<std::size_t>(k)].chunk = begin_of(k);
    std::atomic<std::int64_t> failed{chunks};
    std::exception_ptr error;
    std::mutex error_mutex;
    Run([&](int thread) {
      for (int k = 0; k < shares; ++k) {
        const int share = (thread + k) % shares;
        auto& next = next_[static_cast<std::size_t>(share)].chunk;
        for (std::int64_t chunk; (chunk = next.fetch_add(1)) < begin_of(share + 1);) {
          if (chunk > failed) continue;
          const std::int64_t first = begin + chunk * grain;
          try {
            fn(first, std::min(first + grain, end));
          } catch (...) {
            const std::lock_guard lock(error_mutex);
            if (chunk < failed) {
              failed = chunk;
              error = std::current_exception();
            }
          }
        }
      }
    });
    if (error) std::rethrow_exception(error);
  }

 private:
  struct alignas(64) Next {  // a cache line each
    std::atomic<std::int64_t> chunk{0};
  };

  class Cores;

  // Calls job(thread) on this thread, and on others that come before it is done; waits for these. A
  // thread that the system keeps from running, for somebody else or because it sleeps, is not
  // waited for: its share is the others' then.
  void Run(std::function<void(int)> job);
  void Wake();
  bool Enter();
  void Work(int thread);

  std::vector<std::thread> workers_;
  std::function<void(int)> job_;  // one loop's work, by thread
  std::vector<Next> next_;        // of each thread's share
  std::unique_ptr<Cores> cores_;
  std::atomic<std::uint32_t> generation_{0};
  std::atomic<std::uint32_t> inside_{0};  // workers in the loop, and whether others may enter
  std::atomic<bool> stop_{false};
};

// One loop by itself, on threads of its own (0 or less: all that the machine has).
template <typename Function>
void ParallelFor(int threads, std::int64_t begin, std::int64_t end, std::int64_t grain,
                 const Function& fn) {
  if (begin >= end) return;
  const std::int64_t chunks = (end - begin + grain - 1) / grain;
  ThreadPool pool(static_cast<int>(std::min<std::int64_t>(ResolveThreads(threads), chunks)));
  pool.For(begin, end, grain, fn);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_PARALLEL_FOR_H_
