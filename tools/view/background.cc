// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/background.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace flocklift {
namespace {

struct Ended {};

}  // namespace

Background::Background() : thread_([this] { Work(); }) {}

Background::~Background() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Background::Add(Job job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  changed_.notify_all();
}

void Background::GiveWay() { quiet_from_ = Clock::now().time_since_epoch() + kQuiet; }

void Background::Rest() {
  const Clock::time_point latest = Clock::now() + kLongestRest;
  while (!stops_) {
    const Clock::time_point until = std::min(Clock::time_point(quiet_from_), latest);
    if (until <= Clock::now()) return;
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, until, [this] { return stops_.load(); });
  }
}

void Background::Work() {
  const Progress progress = [this](std::int64_t, std::int64_t) {
    Rest();
    if (stops_) throw Ended();
  };
  while (true) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stops_ || !jobs_.empty(); });
      if (stops_) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    try {
      job(progress);
    } catch (const Ended&) {
      return;
    } catch (const std::exception&) {
      continue;
    }
  }
}

}  // namespace flocklift
