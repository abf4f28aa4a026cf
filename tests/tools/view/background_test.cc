// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/background.h"

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <stdexcept>
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
