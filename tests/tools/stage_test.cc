// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/stage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

class StageTest : public testing::Test {
 protected:
  StageTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    common_.out = folder_;
    common_.quiet = true;
    common_.reuse = true;
    WriteTextFile(input_, "abc");
  }
  ~StageTest() override { fs::remove_all(folder_); }

  // One run of a stage that copies its input; returns whether it had to work.
  bool Run(int option) {
    Stage stage("copy", common_);
    stage.AddInput(input_);
    stage.options()["option"] = option;
    if (stage.IsUpToDate()) return false;
    stage.BeginPhase("copy");
    WriteTextFile(folder_ / "output.txt", "made");
    stage.AddOutput("output.txt");
    stage.figures()["bytes"] = 4;
    stage.Finish();
    return true;
  }

  fs::path folder_ =
      fs::path(testing::TempDir()) / ("flocklift_stage_test_" + std::to_string(getpid()));
  fs::path input_ = folder_ / "input.txt";
  CommonOptions common_;
};

// FIPS 180-2, appendix B.1.
TEST_F(StageTest, Sha256OfAbc) {
  EXPECT_EQ(Sha256OfFile(input_),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(StageTest, WorksAgainOnlyWhenSomethingChanged) {
  EXPECT_TRUE(Run(1));
  EXPECT_FALSE(Run(1));
  EXPECT_TRUE(Run(2));  // another option
  WriteTextFile(input_, "abcd");
  EXPECT_TRUE(Run(2));  // another input
  EXPECT_FALSE(Run(2));
  WriteTextFile(folder_ / "output.txt", "edited");
  EXPECT_TRUE(Run(2));  // the output is not what it left
  fs::remove(folder_ / "output.txt");
  EXPECT_TRUE(Run(2));  // the output is gone
  WriteTextFile(folder_ / "summary.copy.json", "{ torn");
  EXPECT_TRUE(Run(2));  // the summary is no JSON
}

TEST_F(StageTest, WorksAgainInAnotherBuild) {
  EXPECT_TRUE(Run(1));
  const fs::path path = folder_ / "summary.copy.json";
  nlohmann::json summary;
  std::ifstream(path) >> summary;
  summary.at("build") = "of another program";
  WriteTextFile(path, summary.dump());
  EXPECT_TRUE(Run(1));
  EXPECT_FALSE(Run(1));
}

TEST_F(StageTest, NeverSkipsUnlessAsked) {
  common_.reuse = false;
  EXPECT_TRUE(Run(1));
  EXPECT_TRUE(Run(1));
}

TEST_F(StageTest, SummaryHasTheKeysOfTheContract) {
  Run(7);
  std::ifstream file(folder_ / "summary.copy.json");
  const auto summary = nlohmann::json::parse(file);
  EXPECT_EQ(summary.at("command"), "copy");
  EXPECT_EQ(summary.at("options").at("option"), 7);
  EXPECT_EQ(summary.at("inputs").at(0).at("sha256").get<std::string>().size(), 64U);
  EXPECT_EQ(summary.at("phases").at(0).at("name"), "copy");
  EXPECT_GE(summary.at("phases").at(0).at("wall_s").get<double>(), 0);
  EXPECT_EQ(summary.at("figures").at("bytes"), 4);
  EXPECT_TRUE(summary.at("warnings").empty());
  EXPECT_FALSE(summary.at("version").get<std::string>().empty());
  EXPECT_FALSE(summary.at("build").get<std::string>().empty());
}

TEST_F(StageTest, AMissingInputIsAnInputError) {
  Stage stage("copy", common_);
  EXPECT_THROW(stage.AddInput(folder_ / "nothing.csv"), InputError);
  EXPECT_THROW(RequireFile(folder_ / "nothing.csv", "make it"), InputError);
}

struct Knobs {
  double gain = 0.5;
  int count = 3;
  bool fast = true;
};
template <typename Visitor>
void Describe(Visitor& visit, Knobs& k) {
  visit("gain", k.gain, {.low = 0, .high = 1}, "m/s", "how strong");
  visit("count", k.count, {.low = 1}, "", "how many");
  visit("fast", k.fast, {}, "", "hurry");
}

TEST(Flags, ComeFromDescribe) {
  CLI::App app;
  Knobs knobs;
  AddFlags(app, knobs, "Knobs");
  app.parse("--gain 0.25 --no-fast");
  EXPECT_EQ(knobs.gain, 0.25);
  EXPECT_FALSE(knobs.fast);
  EXPECT_EQ(OptionsAsJson(knobs).dump(), R"({"gain":0.25,"count":3,"fast":false})");
  EXPECT_THAT(app.help(), testing::HasSubstr("how strong [m/s] (0 to 1)"));
}

TEST(Flags, RefuseWhatIsOutOfRange) {
  for (const char* arguments : {"--gain 1.5", "--gain nan", "--gain x", "--count 0"}) {
    CLI::App app;
    Knobs knobs;
    AddFlags(app, knobs, "Knobs");
    EXPECT_THROW(app.parse(arguments), CLI::ParseError) << arguments;
  }
  EXPECT_THROW(CheckOptions(Knobs{.gain = -1}), std::invalid_argument);
}

TEST(ParseMeanSd, TakesAMeanAndPerhapsASd) {
  EXPECT_EQ(ParseMeanSd("10", "--speed").mean, 10);
  EXPECT_FALSE(ParseMeanSd("10", "--speed").sd);
  EXPECT_EQ(ParseMeanSd("1.7,0.15", "--wingspan").sd, 0.15);
  for (const char* text : {"", "x", "1,", "1,0", "-1", "nan", "1,2,3"}) {
    EXPECT_THROW(ParseMeanSd(text, "--speed"), CLI::ValidationError) << text;
  }
}

}  // namespace
}  // namespace flocklift
