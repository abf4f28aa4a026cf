// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/parallel_for.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace flocklift {
namespace {

TEST(ParallelFor, EveryIndexOnceAtAnyThreadCount) {
  for (const int threads : {1, 2, 3, 8}) {
    for (const int size : {0, 1, 7, 64, 1000}) {
      std::vector<int> hits(static_cast<std::size_t>(size), 0);
      ParallelFor(threads, 0, size, 7, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t k = first; k < last; ++k) ++hits[static_cast<std::size_t>(k)];
      });
      EXPECT_EQ(std::accumulate(hits.begin(), hits.end(), 0), size) << threads << " " << size;
      EXPECT_TRUE(std::all_of(hits.begin(), hits.end(), [](int hit) { return hit == 1; }));
    }
  }
}

TEST(ParallelFor, ChunksDoNotDependOnTheThreads) {
  const auto chunks = [](int threads) {
    std::set<std::pair<std::int64_t, std::int64_t>> result;
    std::mutex mutex;
    ParallelFor(threads, 3, 103, 9, [&](std::int64_t first, std::int64_t last) {
      const std::lock_guard lock(mutex);
      result.emplace(first, last);
    });
    return result;
  };
  const auto expected = chunks(1);
  EXPECT_EQ(expected.size(), 12U);
  EXPECT_TRUE(expected.contains({3, 12}));
  EXPECT_TRUE(expected.contains({102, 103}));
  EXPECT_EQ(chunks(2), expected);
  EXPECT_EQ(chunks(5), expected);
}

// Each loop reads what the one before has written, and some threads come to few of them.
TEST(ThreadPool, ShortLoopsFollowEachOther) {
  for (const int threads : {2, 3, 7}) {
    ThreadPool pool(threads);
    std::vector<int> now(40, 0), next(40, 0);
    for (int loop = 0; loop < 3000; ++loop) {
      const auto size = static_cast<std::int64_t>(1 + loop % 40);
      pool.For(0, size, 1 + loop % 3, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t k = first; k < last; ++k) {
          const auto own = static_cast<std::size_t>(k);
          next[own] = now[(own + 1) % now.size()] + 1;
        }
      });
      for (std::size_t k = 0; k < static_cast<std::size_t>(size); ++k) {
        ASSERT_EQ(next[k], now[(k + 1) % now.size()] + 1) << threads << " " << loop;
      }
      std::copy_n(next.begin(), size, now.begin());
    }
  }
}

TEST(ThreadPool, GoesOnAfterAFailure) {
  ThreadPool pool(3);
  for (int loop = 0; loop < 200; ++loop) {
    EXPECT_THROW(pool.For(0, 30, 1,
                          [](std::int64_t first, std::int64_t) {
                            if (first == 17) throw std::runtime_error("17");
                          }),
                 std::runtime_error);
    std::vector<int> hits(30, 0);
    pool.For(0, 30, 1, [&](std::int64_t k, std::int64_t) { ++hits[static_cast<std::size_t>(k)]; });
    EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), 30);
  }
}

TEST(ParallelFor, TheFirstFailureIsRethrown) {
  for (const int threads : {1, 2, 4}) {
    try {
      ParallelFor(threads, 0, 100, 1, [](std::int64_t first, std::int64_t) {
        if (first >= 40) throw std::runtime_error(std::to_string(first));
      });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "40");
    }
  }
}

// More threads than cores: most come late to a loop, and some when the next has begun.
TEST(ThreadPool, ThreadsThatComeLateDoNoHarm) {
  ThreadPool pool(12);
  std::vector<std::int64_t> sums(40);
  for (int round = 0; round < 5000; ++round) {
    const std::vector<int> own(40, round);  // gone when the loop is
    pool.For(0, 40, 1, [&](std::int64_t first, std::int64_t) {
      sums[static_cast<std::size_t>(first)] += own[static_cast<std::size_t>(first)];
    });
  }
  for (const std::int64_t sum : sums) EXPECT_EQ(sum, 4999 * 2500);
}

TEST(ThreadPool, ManyShortLoops) {
  ThreadPool pool(3);
  EXPECT_EQ(pool.threads(), 3);
  std::vector<std::int64_t> sums(4);
  for (int round = 0; round < 2000; ++round) {
    pool.For(0, 4, 1, [&](std::int64_t first, std::int64_t) {
      sums[static_cast<std::size_t>(first)] += first + round;
    });
  }
  for (std::int64_t k = 0; k < 4; ++k) {
    EXPECT_EQ(sums[static_cast<std::size_t>(k)], 2000 * k + 1999 * 1000);
  }
}

}  // namespace
}  // namespace flocklift
