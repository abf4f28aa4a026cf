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
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
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
    Run({begin, end, grain, &fn, [](const void* of, std::int64_t first, std::int64_t last) {
           (*static_cast<const Function*>(of))(first, last);
         }});
  }

 private:
  struct Loop {
    std::int64_t begin, end, grain;
    const void* fn;
    void (*call)(const void* fn, std::int64_t first, std::int64_t last);
  };
  // What threads tell each other lies on few cache lines: each that another core has written is
  // waited for, longer than short loops take.
  struct alignas(64) Call {
    std::atomic<std::uint32_t> number{0};  // of the loop, odd; even once nobody may come any more
    Loop loop;
  };
  struct alignas(64) Share {                // of a thread
    std::atomic<std::uint64_t> taken{0};    // the loop's number, then how many of its chunks
    std::atomic<std::uint32_t> visited{0};  // number of the loop that the thread is in; then 1 more
  };
  struct alignas(64) Failure {
    std::atomic<std::int64_t> chunk{kNone};
    std::exception_ptr error;
    std::mutex mutex;
    static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
  };
  class Cores;

  // Does the loop on this thread, and on others that come before it is done; waits for these. A
  // thread that the system keeps from running, for somebody else or because it sleeps, is not
  // waited for: its share is the others' then.
  void Run(const Loop& loop);
  // The chunks of the thread's own share that nobody has taken, then of the others'.
  void Work(std::size_t thread, const Loop& loop, std::uint32_t number);
  bool Take(std::size_t share, std::uint32_t number, std::int64_t count, std::int64_t* chunk);
  void Do(const Loop& loop, std::int64_t chunk);
  void Serve(std::size_t thread);

  std::vector<std::thread> workers_;
  std::unique_ptr<Cores> cores_;
  std::atomic<bool> stop_{false};
  Call call_;
  std::vector<Share> shares_;
  Failure failure_;
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
