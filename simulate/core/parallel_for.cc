// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/parallel_for.h"

#include <sched.h>

#include <chrono>
#include <utility>

namespace flocklift {
namespace {

constexpr int kLoopsBetweenSettling = 16;
constexpr std::uint32_t kOpen = std::uint32_t{1} << 31U;  // of a loop that may be entered

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
    of_[static_cast<std::size_t>(thread)] = own;
    cpu_set_t free = allowed_;
    for (int k = 0; k < thread; ++k) {
      const int core = of_[static_cast<std::size_t>(k)];
      if (core >= 0 && core < CPU_SETSIZE) CPU_CLR(core, &free);
    }
    if (own < 0 || own >= CPU_SETSIZE || CPU_ISSET(own, &free) || CPU_COUNT(&free) == 0) return;
    if (sched_setaffinity(0, sizeof free, &free) == 0) {
      of_[static_cast<std::size_t>(thread)] = sched_getcpu();
    }
  }

 private:
  cpu_set_t allowed_;
  std::vector<std::atomic<int>> of_;  // where each thread was last
};

ThreadPool::ThreadPool(int threads)
    : next_(static_cast<std::size_t>(ResolveThreads(threads))),
      cores_(std::make_unique<Cores>(ResolveThreads(threads))) {
  for (int k = 1; k < ResolveThreads(threads); ++k) workers_.emplace_back([this, k] { Work(k); });
}

ThreadPool::~ThreadPool() {
  stop_ = true;
  Wake();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::Run(std::function<void(int)> job) {
  job_ = std::move(job);
  cores_->Settle(0);
  inside_ = kOpen;
  Wake();
  job_(0);
  inside_ &= ~kOpen;
  AwaitChange([this] { return inside_ == 0; });
  for (std::uint32_t inside; (inside = inside_) != 0;) inside_.wait(inside);
}

bool ThreadPool::Enter() {
  std::uint32_t now = inside_;
  while ((now & kOpen) != 0) {
    if (inside_.compare_exchange_weak(now, now + 1)) return true;
  }
  return false;
}

void ThreadPool::Wake() {
  ++generation_;
  generation_.notify_all();
}

void ThreadPool::Work(int thread) {
  int loops = 0;
  for (std::uint32_t seen = 0;;) {
    AwaitChange([&] { return generation_ != seen; });
    generation_.wait(seen);
    seen = generation_;
    if (stop_) return;
    if (loops++ % kLoopsBetweenSettling == 0) cores_->Settle(thread);
    if (!Enter()) continue;
    job_(thread);
    if (--inside_ == 0) inside_.notify_one();
  }
}

}  // namespace flocklift
