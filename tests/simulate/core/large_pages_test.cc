// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/large_pages.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <thread>
#include <vector>

namespace flocklift {
namespace {

constexpr std::size_t kBlock = 2 << 20;  // bytes

TEST(LargePages, PiecesAreAlignedAndApart) {
  LargePages memory;
  std::vector<std::pair<std::uintptr_t, std::size_t>> pieces;
  for (const std::size_t bytes : {1U, 100U, 64U, 3'000'000U, 7U, 2'097'152U, 4096U}) {
    for (const std::size_t alignment : {1U, 4U, 64U, 4096U}) {
      const auto at = reinterpret_cast<std::uintptr_t>(memory.allocate(bytes, alignment));
      EXPECT_EQ(at % alignment, 0U);
      for (const auto& [other, size] : pieces) {
        EXPECT_TRUE(at + bytes <= other || other + size <= at);
      }
      pieces.emplace_back(at, bytes);
    }
  }
}

TEST(LargePages, ManySmallPiecesShareABlock) {
  LargePages memory;
  EXPECT_EQ(memory.size(), 0U);
  for (int k = 0; k < 16; ++k) (void)memory.allocate(100'000, 4);
  EXPECT_EQ(memory.size(), kBlock);
}

TEST(LargePages, BlocksDoubleAndHoldWhatIsLarger) {
  LargePages memory;
  for (int k = 0; k < 100; ++k) (void)memory.allocate(1'000'000, 4);
  EXPECT_GE(memory.size(), 100'000'000U);
  EXPECT_LT(memory.size(), 140'000'000U);
  (void)memory.allocate(200'000'000, 64);
  EXPECT_GE(memory.size(), 300'000'000U);
}

TEST(LargePages, ThreadsGetPiecesOfTheirOwn) {
  LargePages memory;
  constexpr int kArrays = 200;
  std::vector<std::pmr::vector<int>> arrays;
  for (int k = 0; k < kArrays; ++k) arrays.emplace_back(&memory);
  const auto fill = [&](int first) {
    for (int k = first; k < kArrays; k += 2) {
      for (int n = 0; n < 2000; ++n) arrays[static_cast<std::size_t>(k)].push_back(k);
    }
  };
  std::thread other(fill, 1);
  fill(0);
  other.join();
  for (int k = 0; k < kArrays; ++k) {
    EXPECT_EQ(arrays[static_cast<std::size_t>(k)], (std::pmr::vector<int>(2000, k)));
  }
}

}  // namespace
}  // namespace flocklift
