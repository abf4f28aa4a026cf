// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/parallel_for.h"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace flocklift {
namespace {

constexpr int kLoopsBetweenSettling = 16;

// Looks for a while before it is worth falling asleep: waking takes longer than many a loop, and
// may bring two threads onto one core while another is free. The core is soon offered to others,
// who may be those that are waited for.
template <typename Condition>
void AwaitChange(const Condition& changed) {
  constexpr int kLooks = 2000;
  constexpr std::chrono::microseconds kAwake(1000);
  for (int look = 0; look < kLooks; ++look) {
    if (changed()) return;
    __builtin_ia32_pause();
  }
  const auto end = std::chrono::steady_clock::now() + kAwake;
  while (!changed() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
}

}  // namespace

// Keeps threads apart: schedulers may hold two that often wait for each other on one core while
// another is free, and bring back who was moved away.
class ThreadPool::Cores {
 public:
  explicit Cores(int threads) : of_(static_cast<std::size_t>(threads)) {
    for (std::atomic<int>& core : of_) core = -1;
    if (sched_getaffinity(0, sizeof allowed_, &allowed_) != 0) CPU_ZERO(&allowed_);
  }

  // Of the calling thread, whose number it is: if it is on the core of a thread before it, it is
  // confined to the cores that none of those has, where there are any.
  void Settle(int thread) {
    const int own = sched_getcpu();
    std::atomic<int>& last = of_[static_cast<std::size_t>(thread)];
    if (last != own) last = own;  // others read it from their caches while it stays
    cpu_set_t free = allowed_;
    for (int k = 0; k < thread; ++k) {
      const int core = of_[static_cast<std::size_t>(k)];
      if (core >= 0 && core < CPU_SETSIZE) CPU_CLR(core, &free);
    }
    if (own < 0 || own >= CPU_SETSIZE || CPU_ISSET(own, &free) || CPU_COUNT(&free) == 0) return;
    if (sched_setaffinity(0, sizeof free, &free) == 0) {
      last = sched_getcpu();
    }
  }

 private:
  cpu_set_t allowed_;
  std::vector<std::atomic<int>> of_;  // where each thread was last
};

ThreadPool::ThreadPool(int threads)
    : cores_(std::make_unique<Cores>(ResolveThreads(threads))),
      shares_(static_cast<std::size_t>(ResolveThreads(threads))) {
  for (std::size_t k = 1; k < shares_.size(); ++k) workers_.emplace_back([this, k] { Serve(k); });
}

ThreadPool::~ThreadPool() {
  stop_ = true;
  ++call_.number;
  call_.number.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::Run(const Loop& loop) {
  cores_->Settle(0);
  const std::uint32_t number = (call_.number + 1) | 1U;
  if (number == 1) {  // all over again: no share remembers a loop of this number
    for (Share& share : shares_) share.taken = 0;
  }
  call_.loop = loop;
  call_.number = number;
  call_.number.notify_all();
  Work(0, loop, number);
  const auto is_in = [number](const Share& share) { return share.visited == number; };
  const auto came = [&](const Share& share) { return is_in(share) || share.visited == number + 1; };
  // Who comes says so and then looks whether it still may; who forbids it looks afterwards who has.
  if (!std::all_of(shares_.begin() + 1, shares_.end(), came)) call_.number = number + 1;
  for (auto share = shares_.begin() + 1; share != shares_.end(); ++share) {
    AwaitChange([&] { return !is_in(*share); });
    share->visited.wait(number);
  }
  if (failure_.chunk == Failure::kNone) return;
  failure_.chunk = Failure::kNone;
  std::rethrow_exception(std::exchange(failure_.error, nullptr));
}

void ThreadPool::Work(std::size_t thread, const Loop& loop, std::uint32_t number) {
  const std::int64_t chunks = (loop.end - loop.begin + loop.grain - 1) / loop.grain;
  const auto shares = static_cast<std::int64_t>(shares_.size());
  for (std::int64_t k = 0; k < shares; ++k) {
    const std::int64_t share = (static_cast<std::int64_t>(thread) + k) % shares;
    const std::int64_t first = chunks * share / shares;
    const std::int64_t count = chunks * (share + 1) / shares - first;
    for (std::int64_t chunk; Take(static_cast<std::size_t>(share), number, count, &chunk);) {
      Do(loop, first + chunk);
    }
  }
}

bool ThreadPool::Take(std::size_t share, std::uint32_t number, std::int64_t count,
                      std::int64_t* chunk) {
  std::atomic<std::uint64_t>& taken = shares_[share].taken;
  const std::uint64_t none = std::uint64_t{number} << 32U;
  for (std::uint64_t now = taken;;) {
    const std::uint64_t so_far = now >> 32U == number ? now : none;
    *chunk = static_cast<std::int64_t>(so_far - none);
    if (*chunk >= count) return false;
    if (taken.compare_exchange_weak(now, so_far + 1)) return true;
  }
}

void ThreadPool::Do(const Loop& loop, std::int64_t chunk) {
  if (chunk > failure_.chunk) return;
  const std::int64_t first = loop.begin + chunk * loop.grain;
  try {
    loop.call(loop.fn, first, std::min(first + loop.grain, loop.end));
  } catch (...) {
    const std::lock_guard lock(failure_.mutex);
    if (chunk < failure_.chunk) {
      failure_.chunk = chunk;
      failure_.error = std::current_exception();
    }
  }
}

void ThreadPool::Serve(std::size_t thread) {
  std::atomic<std::uint32_t>& visited = shares_[thread].visited;
  int loops = 0;
  for (std::uint32_t seen = 0;;) {
    AwaitChange([&] { return call_.number != seen; });
    call_.number.wait(seen);
    seen = call_.number;
    if (stop_) return;
    if (seen % 2 == 0) continue;
    if (loops++ % kLoopsBetweenSettling == 0) cores_->Settle(static_cast<int>(thread));
    visited = seen;
    if (call_.number == seen) Work(thread, call_.loop, seen);
    visited = seen + 1;
    visited.notify_one();
  }
}

}  // namespace flocklift
