// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/background.h"

#include <sys/resource.h>
#include <unistd.h>

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

void Background::Work() {
  // Linux gives every thread a priority of its own; where this is refused, work goes on all the
  // same.
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
  const Progress progress = [this](std::int64_t, std::int64_t) {
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
