// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/solver.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <stdexcept>
#include <vector>

namespace flocklift {
namespace {

struct News {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::int64_t> accepted, finished;
  std::vector<std::string> failed;
  std::atomic<int> reports = 0;

  Solver::Listener Listener() {
    return {.accepted =
                [this](std::int64_t job) {
                  const std::lock_guard lock(mutex);
                  accepted.push_back(job);
                },
            .progress = [this](auto, auto, auto) { ++reports; },
            .finished =
                [this](std::int64_t job, ReconstructResult&&, double seconds) {
                  EXPECT_GE(seconds, 0);
                  const std::lock_guard lock(mutex);
                  finished.push_back(job);
                  changed.notify_all();
                },
            .failed =
                [this](std::int64_t, const std::string& reason) {
                  const std::lock_guard lock(mutex);
                  failed.push_back(reason);
                  changed.notify_all();
                }};
  }
  void AwaitEvents(std::size_t count) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return finished.size() + failed.size() >= count; });
  }
};

TEST(Solver, ANewJobCancelsTheOneBefore) {
  News news;
  std::promise<void> runs;
  std::atomic<bool> was_cancelled = false;
  Solver solver(news.Listener());
  EXPECT_EQ(solver.Start([&](const Progress& progress) -> ReconstructResult {
    runs.set_value();
    try {
      for (int k = 0;; ++k) progress(k, 0);  // until it throws
    } catch (...) {
      was_cancelled = true;
      throw;
    }
  }),
            1);
  runs.get_future().wait();
  EXPECT_EQ(solver.Start([](const Progress&) { return ReconstructResult{}; }), 2);
  news.AwaitEvents(1);
  EXPECT_TRUE(was_cancelled);
  EXPECT_EQ(news.finished, (std::vector<std::int64_t>{2}));
  EXPECT_TRUE(news.failed.empty());
  EXPECT_GE(news.reports, 2);  // each job tells at once that it runs
}

TEST(Solver, AcceptsAJobBeforeTheOneBeforeItStops) {
  News news;
  std::promise<void> runs, ends;
  Solver solver(news.Listener());
  solver.Start([&](const Progress& progress) {
    runs.set_value();
    ends.get_future().wait();  // heavy work, in which no progress is told
    progress(1, 1);
    return ReconstructResult{};
  });
  runs.get_future().wait();
  solver.Start([](const Progress&) { return ReconstructResult{}; });
  EXPECT_EQ(news.accepted, (std::vector<std::int64_t>{1, 2}));
  EXPECT_TRUE(news.finished.empty());
  ends.set_value();
  news.AwaitEvents(1);
  EXPECT_EQ(news.finished, (std::vector<std::int64_t>{2}));
}

TEST(Solver, TellsAFailureAndGoesOn) {
  News news;
  Solver solver(news.Listener());
  solver.Start([](const Progress&) -> ReconstructResult {
    throw std::invalid_argument("nothing fixes the scale");
  });
  news.AwaitEvents(1);
  solver.Start([](const Progress&) { return ReconstructResult{}; });
  news.AwaitEvents(2);
  EXPECT_EQ(news.failed, (std::vector<std::string>{"nothing fixes the scale"}));
  EXPECT_EQ(news.finished, (std::vector<std::int64_t>{2}));
}

TEST(Solver, EndsInTheMiddleOfAJob) {
  News news;
  std::promise<void> runs;
  {
    Solver solver(news.Listener());
    solver.Start([&](const Progress& progress) -> ReconstructResult {
      runs.set_value();
      for (int k = 0;; ++k) progress(k, 0);
    });
    runs.get_future().wait();
  }
  EXPECT_TRUE(news.finished.empty());
  EXPECT_TRUE(news.failed.empty());
}

}  // namespace
}  // namespace flocklift
