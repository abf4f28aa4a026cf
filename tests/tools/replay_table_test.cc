// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/replay_table.h"

#include <gtest/gtest.h>

namespace flocklift {
namespace {

TEST(ReplayTable, HasARowATimeWithBothFlocks) {
  const auto divergence = nlohmann::ordered_json::parse(R"([
      {"time": 0.5, "model_rms": 0.25, "noiseless_rms": 0.2, "straight_on_rms": 1.5,
       "perturbed_rms": 0.001},
      {"time": 2, "model_rms": 3, "noiseless_rms": 2, "straight_on_rms": 12.5}])");
  const auto statistics = nlohmann::ordered_json::parse(R"([
      {"time": 2, "reconstruction": {"polarisation": 0.9, "median_speed": 10},
       "replay": {"polarisation": null, "median_speed": 9.5}}])");
  const std::string table = ReplayTable(divergence, statistics);
  const auto row = table.find("   0.5 ");
  ASSERT_NE(row, std::string::npos);
  const std::string first = table.substr(row, table.find('\n', row) - row);
  EXPECT_NE(first.find("0.25        0.2          1.5      0.001"), std::string::npos) << first;
  EXPECT_EQ(first.find('|'), std::string::npos) << first;  // nothing is told of both then
  const std::string second = table.substr(table.find('\n', row));
  EXPECT_NE(second.find("9.5 | 10"), std::string::npos) << second;
  EXPECT_NE(second.find(" | 0.9"), std::string::npos) << second;
  EXPECT_NE(second.find("12.5"), std::string::npos) << second;
}

TEST(ReplayTable, IsEmptyWithoutDivergence) {
  EXPECT_EQ(ReplayTable(nlohmann::ordered_json::array(), nlohmann::ordered_json::array()), "");
}

}  // namespace
}  // namespace flocklift
