// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/kept_memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <string>
#include <thread>

namespace flocklift {
namespace {

constexpr int kAnswers = 100;
constexpr std::size_t kBytes = 700 << 10;
constexpr long kPagesOfAnswer = kBytes / 4096;

// Page faults of the calling thread so far.
long Faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt;
}

// Those while it makes answers and frees them.
long FaultsOfAnswers() {
  const long before = Faults();
  for (int k = 0; k < kAnswers; ++k) {
    const std::string body(kBytes, static_cast<char>('a' + k % 26));
    const std::string sent = body + "\r\n";
    EXPECT_EQ(sent.size(), kBytes + 2);
  }
  return Faults() - before;
}

TEST(KeptMemory, AnswersComeFromPagesThatAreThere) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer's own allocator is in use";
#endif
  KeepFreedMemory();
  EXPECT_LT(FaultsOfAnswers(), 10 * kPagesOfAnswer);
  std::thread([] { EXPECT_LT(FaultsOfAnswers(), 10 * kPagesOfAnswer); }).join();
}

TEST(KeptMemory, SoDoArraysBelowTheSizeAskedFor) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer's own allocator is in use";
#endif
  constexpr std::size_t kArray = 12 << 20;
  KeepFreedMemory(32 << 20, 256 << 20);
  const long before = Faults();
  for (int k = 0; k < 10; ++k) {
    const std::string array(kArray, static_cast<char>('a' + k));
    EXPECT_EQ(array.size(), kArray);
  }
  EXPECT_LT(Faults() - before, static_cast<long>(2 * kArray / 4096));
}

}  // namespace
}  // namespace flocklift
