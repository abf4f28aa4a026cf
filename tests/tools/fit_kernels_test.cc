// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/fit_kernels.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/core/io.h"
#include "tests/reconstruct/fit/kernel_flock.h"
#include "tools/run_command.h"
#include "tools/walls.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr double kPull = 0.15, kAlign = 0.3;

std::string Slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

struct TablePoint {
  std::string kernel;
  double distance, value, sd, low, high, density;
  bool known;
};

std::vector<TablePoint> ReadTable(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line.substr(0, 8), "# units:");
  std::getline(file, line);
  EXPECT_EQ(line, "kernel,distance,value,sd,low,high,density,known");
  std::vector<TablePoint> points;
  while (std::getline(file, line)) {
    const auto comma = line.find(',');
    const std::vector<double> v = ParseNumbers(line.substr(comma + 1), 7).value();
    points.push_back({line.substr(0, comma), v[0], v[1], v[2], v[3], v[4], v[5], v[6] != 0});
  }
  return points;
}

class FitKernelsTest : public testing::Test {
 protected:
  FitKernelsTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    const KernelFlock flock{.order = 2,
                            .animals = 6,
                            .frames = 60,
                            .attraction = [](double) { return kPull; },
                            .alignment = [](double) { return kAlign; },
                            .diffusion = 1e-3,
                            .noise = 1e-4};
    for (const std::uint64_t seed : {1, 2, 3}) {
      WriteTrajectories(File(seed), FlyKernels(flock, seed));
    }
  }
  ~FitKernelsTest() override { fs::remove_all(folder_); }

  fs::path File(std::uint64_t seed) const {
    return folder_ / ("flock" + std::to_string(seed) + ".csv");
  }
  fs::path Run(const std::string& arguments, const std::string& out) {
    CLI::App app;
    AddFitCommand(app);
    AddRunCommand(app);
    app.parse(arguments + " --quiet --out " + (folder_ / out).string());
    return folder_ / out;
  }
  std::string Fit(const std::string& arguments) const {
    return "fit " + File(1).string() + " --model kernels --intervals 8 " + arguments;
  }
  std::string Also(std::uint64_t seed) const { return " --also " + File(seed).string() + " "; }
  static nlohmann::json Figures(const fs::path& out) {
    return nlohmann::json::parse(Slurp(out / "summary.fit.json")).at("figures");
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "flocklift_fit_kernels_test";
};

TEST_F(FitKernelsTest, WritesTheKernelsOfAllFilms) {
  const fs::path out = Run(Fit(Also(2) + Also(3) + "--threads 1"), "out");
  std::map<std::string, int> known, covered;
  for (const TablePoint& point : ReadTable(out / "kernels.csv")) {
    EXPECT_NEAR(point.low, point.value - 1.96 * point.sd, 1e-6);
    EXPECT_NEAR(point.high, point.value + 1.96 * point.sd, 1e-6);
    EXPECT_GE(point.density, 0);
    if (!point.known) continue;
    const double truth = point.kernel == "attraction" ? kPull : kAlign;
    ++known[point.kernel];
    covered[point.kernel] += std::abs(point.value - truth) <= 2 * 1.96 * point.sd ? 1 : 0;
  }
  for (const char* name : {"attraction", "alignment"}) {
    EXPECT_GT(known[name], 10) << name;
    EXPECT_EQ(covered[name], known[name]) << name;
  }
  const std::string picture = Slurp(out / "kernels.svg");
  EXPECT_NE(picture.find("attraction"), std::string::npos);
  EXPECT_NE(picture.find("1/s²"), std::string::npos);
  EXPECT_EQ(picture.find("var("), std::string::npos);  // which only browsers know
  EXPECT_FALSE(fs::exists(out / "parameters.toml"));
  const nlohmann::json figures = Figures(out);
  EXPECT_EQ(figures.at("method"), "kernels");
  EXPECT_EQ(figures.at("files"), 3);
  EXPECT_EQ(figures.at("animals"), 18);
  EXPECT_EQ(figures.at("kernels").at(0).at("unit"), "1/s^2");
  EXPECT_EQ(figures.at("kernels").at(1).at("unit"), "1/s");
  EXPECT_GT(figures.at("r2_held_out"), 0);
  EXPECT_NEAR(figures.at("position_noise"), 1e-4, 5e-5);

  const fs::path again = Run(Fit(Also(2) + Also(3) + "--threads 3"), "again");
  EXPECT_EQ(Slurp(out / "kernels.csv"), Slurp(again / "kernels.csv"));
  EXPECT_EQ(Slurp(out / "kernels.svg"), Slurp(again / "kernels.svg"));
}

TEST_F(FitKernelsTest, MoreFilmsNarrowTheBands) {
  const auto mean_sd = [&](const fs::path& out) {
    double sum = 0, count = 0;
    for (const TablePoint& point : ReadTable(out / "kernels.csv")) {
      if (point.distance < 1 || point.distance > 2) continue;
      sum += point.sd;
      count += 1;
    }
    return sum / count;
  };
  const double one = mean_sd(Run(Fit("--held-out 0"), "one"));
  const double three = mean_sd(Run(Fit("--held-out 0" + Also(2) + Also(3)), "three"));
  EXPECT_LT(three, 0.8 * one);
}

TEST_F(FitKernelsTest, FitsTheKernelsThatAreNamed) {
  const fs::path out = Run(Fit("--free alignment --held-out 0 --position-noise 2e-4"), "out");
  for (const TablePoint& point : ReadTable(out / "kernels.csv")) {
    EXPECT_EQ(point.kernel, "alignment");
  }
  EXPECT_NEAR(Figures(out).at("position_noise"), 2e-4, 1e-12);  // as said
  EXPECT_FALSE(Figures(out).contains("r2_held_out"));
  EXPECT_EQ(Figures(Run(Fit("--order 1 --held-out 0"), "first")).at("kernels").size(), 1U);
}

TEST_F(FitKernelsTest, ComparesWithModelsThatHaveParameters) {
  const std::string models = "--compare linear,kernels";
  const auto scores = [&](const fs::path& out) {
    std::map<std::string, double> of;
    const nlohmann::json figures = Figures(out);
    for (const auto& score : figures.at("comparison")) {
      of[score.at("model")] = score.at("r2_held_out");
    }
    return of;
  };
  const auto here = scores(Run(Fit(models), "here"));
  ASSERT_EQ(here.size(), 3U);
  EXPECT_EQ(here.at("constant velocity"), 0);
  EXPECT_GT(here.at("kernels"), 0);
  // The same flock: pulled by all, alike at all distances.
  EXPECT_NEAR(here.at("kernels"), here.at("linear"), 0.1);
  const auto there =
      scores(Run("fit " + File(1).string() + " --model linear --intervals 8 " + models, "there"));
  EXPECT_EQ(there.at("kernels"), here.at("kernels"));
}

TEST_F(FitKernelsTest, RefusesWithNothingWritten) {
  const auto refused = [&](const std::string& arguments) {
    EXPECT_ANY_THROW(Run(arguments, "none")) << arguments;
    EXPECT_FALSE(fs::exists(folder_ / "none")) << arguments;
  };
  for (const char* arguments :
       {"--order 3", "--intervals 3", "--degree 4", "--free pull", "--order 1 --free alignment",
        "--set a=1", "--walls=0,0,0,1,1,1", "--goal seek", "--method differences",
        "--start nowhere.toml", "--also nowhere.csv", "--order 1 --compare linear",
        "--compare starlings", "--position-noise -1"}) {
    refused(Fit(arguments));
  }
  refused(Fit(Also(1)));                         // the same film twice
  refused(Fit(Also(2) + "--compare linear"));    // which is fitted to one file
  refused("fit " + File(1).string() + Also(2));  // likewise
  refused("fit " + File(1).string() + " --model linear --order 1 --compare kernels");
  refused("run film.mp4 --model kernels --camera " + File(1).string());
  std::ofstream(folder_ / "slow.csv") << "# fps=7\n"
                                      << "frame,id,x,y,z\n1,1,0,0,0\n";
  EXPECT_THROW(Run(Fit("--also " + (folder_ / "slow.csv").string()), "none"), InputError);
  std::ofstream(File(1)) << "# fps=20\nframe,id,x,y,z\n1,1,0,0,0\n2,1,0,0,1\n";
  EXPECT_THROW(Run(Fit(""), "none"), CannotFit);  // alone
  std::ofstream(File(1)) << "frame,id,x,y,z\n1,1,0,0,0\n2,1,0,0,1\n";
  EXPECT_THROW(Run(Fit(""), "none"), InputError);  // no frames per second
  EXPECT_FALSE(fs::exists(folder_ / "none"));
}

}  // namespace
}  // namespace flocklift
