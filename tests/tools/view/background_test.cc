// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/background.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

namespace flocklift {
namespace {

TEST(Background, DoesOneJobAfterAnother) {
  std::vector<int> done;
  std::promise<void> last;
  Background background;
  for (int k = 0; k < 5; ++k) {
    background.Add([k, &done](const Progress&) {
      done.push_back(k);
      if (k == 2) throw std::runtime_error("a job that fails does not end the others");
    });
  }
  background.Add([&last](const Progress&) { last.set_value(); });
  last.get_future().wait();
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 3, 4}));
}

// How often a job reports while others are waited for, and whether this thread saw to that without
// being held up itself.
struct Held {
  int reports = 0;
  bool always = true;
};
Held ReportsWhileHeld() {
  using Clock = std::chrono::steady_clock;
  Background background;
  std::promise<void> started;
  std::promise<int> counted;
  std::atomic<bool> is_over = false;
  background.Add([&](const Progress& alive) {
    started.set_value();
    int reports = 0;
    for (; !is_over; ++reports) alive(0, 1);
    counted.set_value(reports);
  });
  Held held;
  Clock::time_point last = Clock::now();
  const auto give_way = [&] {
    background.GiveWay();
    held.always = held.always && Clock::now() - last < Background::kQuiet;
    last = Clock::now();
  };
  give_way();
  started.get_future().wait();
  for (const auto end = Clock::now() + 3 * Background::kLongestRest; Clock::now() < end;) {
    give_way();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  is_over = true;
  give_way();
  held.reports = counted.get_future().get();
  return held;
}

// As often as it may, it goes on once in so long a rest; at its own pace it would a million times.
TEST(Background, RestsWhileOthersAreWaitedFor) {
  Held held = ReportsWhileHeld();
  for (int again = 0; again < 20 && !held.always; ++again) held = ReportsWhileHeld();
  ASSERT_TRUE(held.always) << "a machine too busy to tell";
  EXPECT_LE(held.reports, 5);
}

TEST(Background, GoesOnOnceItIsQuiet) {
  Background background;
  std::promise<void> done;
  background.GiveWay();
  background.Add([&](const Progress& alive) {
    for (int k = 0; k < 1000; ++k) alive(k, 1000);  // with a rest for each it would take minutes
    done.set_value();
  });
  EXPECT_EQ(done.get_future().wait_for(std::chrono::minutes(1)), std::future_status::ready);
}

TEST(Background, EndsAJobThatReports) {
  auto background = std::make_unique<Background>();
  std::promise<void> started;
  bool is_next_done = false;
  background->Add([&started](const Progress& alive) {
    started.set_value();
    while (true) alive(0, 1);
  });
  background->Add([&is_next_done](const Progress&) { is_next_done = true; });
  started.get_future().wait();
  background.reset();
  EXPECT_FALSE(is_next_done);
}

}  // namespace
}  // namespace flocklift
