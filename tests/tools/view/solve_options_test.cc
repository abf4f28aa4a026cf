// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/solve_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

ReconstructCommand Command() {
  ReconstructCommand command;
  command.method = "batch";
  command.tracks = "run/tracks.csv";
  command.camera = "a camera.yaml";
  return command;
}

TEST(SolveOptions, GoThereAndBack) {
  ReconstructCommand command = Command();
  const Json given = Json::parse(
      R"({"method": "cobyla", "speed": "11,1", "near": 12.5, "no-size": true,
          "batch": {"jump": 7, "flock-turn": true, "max-iterations": 12},
          "cobyla": {"lambda-t": 0.25}, "of another": 1})");
  TakeSolveOptions(given, &command);
  EXPECT_EQ(command.method, "cobyla");
  EXPECT_EQ(command.near, 12.5);
  EXPECT_TRUE(command.no_size);
  EXPECT_EQ(command.batch.jump, 7);
  EXPECT_TRUE(command.batch.flock_turn);
  EXPECT_EQ(command.batch.max_iterations, 12);
  EXPECT_EQ(command.cobyla.lambda_t, 0.25);
  ReconstructCommand again = Command();
  TakeSolveOptions(SolveOptionsAsJson(command), &again);
  EXPECT_EQ(SolveOptionsAsJson(again), SolveOptionsAsJson(command));
}

TEST(SolveOptions, ForcesAreLeftOutWhileSomebodyWaits) {
  for (const char* method : {"auto", "dynamics", "batch"}) {
    ReconstructCommand command;
    TakeSolveOptions({{"method", method}, {"speed", "11,1"}}, &command);
    EXPECT_EQ(command.method, "batch");
    EXPECT_EQ(command.speed, "11,1");
  }
}

TEST(SolveOptions, AreChecked) {
  for (const char* text :
       {R"({"method": "magic"})", R"({"batch": {"jump": -1}})", R"({"batch": {"jump": "7"}})",
        R"({"cobyla": {"lambda-sep": 2}})", R"({"batch": {"flock-turn": 1}})", R"({"near": "x"})",
        R"({"speed": 11})", R"([])", R"({"batch": {"max-iterations": 1e300}})"}) {
    ReconstructCommand command = Command();
    EXPECT_THROW(TakeSolveOptions(Json::parse(text), &command), std::invalid_argument) << text;
  }
}

TEST(SolveOptions, TheCommandLineSaysWhatDiffers) {
  ReconstructCommand command = Command();
  command.wingspan = "0.7,0.03";
  command.batch.jump = 7;
  command.batch.level_flight = false;
  command.cobyla.lambda_t = 3;
  EXPECT_EQ(CommandLineOf(command),
            "flocklift reconstruct run/tracks.csv --camera 'a camera.yaml' --method batch "
            "--wingspan 0.7,0.03 --jump 7 --no-level-flight");
  command.method = "cobyla";
  EXPECT_THAT(CommandLineOf(command), HasSubstr("--lambda-t 3"));
  EXPECT_THAT(CommandLineOf(command), Not(HasSubstr("--jump")));
  EXPECT_EQ(Quoted("it's; rm -r"), "'it'\\''s; rm -r'");
  EXPECT_EQ(Quoted(""), "''");
}

TEST(SolveOptions, EveryOneIsDescribed) {
  const Json list = DescribeSolveOptions(Command());
  const Json values = SolveOptionsAsJson(Command());
  EXPECT_EQ(list.size(), values.at("batch").size() + values.at("cobyla").size());
  for (const Json& option : list) {
    const std::string group = option.at("group"), name = option.at("name");
    EXPECT_EQ(option.at("value"), values.at(group).at(name)) << name;
    EXPECT_FALSE(option.at("help").get<std::string>().empty()) << name;
  }
}

}  // namespace
}  // namespace flocklift
