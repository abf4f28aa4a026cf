// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/solver.h"

#include <chrono>
#include <exception>
#include <utility>

namespace flocklift {
namespace {

struct Cancelled {};

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kBetweenReports(40);

}  // namespace

Solver::Solver(Listener listener) : listener_(std::move(listener)), thread_([this] { Work(); }) {}

Solver::~Solver() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
    wanted_ = 0;
  }
  changed_.notify_all();
  thread_.join();
}

std::int64_t Solver::Start(Job job) {
  std::int64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    number = ++last_;
    listener_.accepted(number);
    next_ = std::move(job);
    wanted_ = number;
  }
  changed_.notify_all();
  return number;
}

void Solver::Cancel() {
  const std::lock_guard lock(mutex_);
  next_.reset();
  wanted_ = 0;
}

void Solver::Work() {
  while (true) {
    Job job;
    std::int64_t number = 0;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stops_ || next_; });
      if (stops_) return;
      job = std::move(*next_);
      next_.reset();
      number = wanted_;
    }
    const auto start = Clock::now();
    auto reported = start - kBetweenReports;
    const Progress progress = [&](std::int64_t done, std::int64_t total) {
      if (wanted_ != number) throw Cancelled();
      if (Clock::now() - reported < kBetweenReports) return;
      reported = Clock::now();
      listener_.progress(number, done, total);
    };
    try {
      progress(0, 0);
      ReconstructResult result = job(progress);
      if (wanted_ != number) continue;
      listener_.finished(number, std::move(result),
                         std::chrono::duration<double>(Clock::now() - start).count());
    } catch (const Cancelled&) {
      continue;
    } catch (const std::exception& error) {
      if (wanted_ == number) listener_.failed(number, error.what());
    }
  }
}

}  // namespace flocklift
