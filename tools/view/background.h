// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Work behind a page, one job after another on a thread of its own, which yields to the threads
// that somebody waits for.

#ifndef FLOCKLIFT_TOOLS_VIEW_BACKGROUND_H_
#define FLOCKLIFT_TOOLS_VIEW_BACKGROUND_H_

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "simulate/core/progress.h"

namespace flocklift {

class Background {
 public:
  // Reports its progress now and then, and lets what that throws pass: it is how a job is ended
  // when the page goes. Tells its own failures; what it throws else is lost.
  using Job = std::function<void(const Progress&)>;

  Background();
  ~Background();  // ends the job that runs, and forgets the others
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  void Add(Job job);

 private:
  void Work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  std::atomic<bool> stops_ = false;
  std::thread thread_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_BACKGROUND_H_
