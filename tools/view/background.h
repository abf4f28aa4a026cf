// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Work behind a page, one job after another on a thread of its own, which rests while others do
// what somebody waits for. It has their priority all the same: with less, it would be kept from
// going on while it holds what they wait for.

#ifndef FLOCKLIFT_TOOLS_VIEW_BACKGROUND_H_
#define FLOCKLIFT_TOOLS_VIEW_BACKGROUND_H_

#include <atomic>
#include <chrono>
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

  // Somebody waits for something else: a job that reports within the next kQuiet rests until
  // then, though not for longer than kLongestRest at a time, so that it comes to its end.
  void GiveWay();
  static constexpr std::chrono::milliseconds kQuiet{300}, kLongestRest{400};

 private:
  using Clock = std::chrono::steady_clock;
  void Work();
  void Rest();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  std::atomic<bool> stops_ = false;
  std::atomic<Clock::duration> quiet_from_ = Clock::duration::min();  // of the clock's epoch
  std::thread thread_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_BACKGROUND_H_
