// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// flocklift_depth_curves: the second half of tools/depth_curves. Makes the twins, runs the methods
// and writes the picture and the table.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "tools/depth_curves.h"

namespace {

namespace fs = std::filesystem;
using namespace flocklift;  // NOLINT: the program's own parts

// Lin's method looks at one frame at a time; dynamics is where batch is, or a little before it.
constexpr const char* kMethods[] = {"batch", "batch-no-size", "cobyla"};

}  // namespace

int main(int argc, char** argv) {
  fs::path scenes, out;
  int birds = 20, seeds = 3, threads = 0;
  CLI::App app("Errors of depth by what goes wrong");
  app.add_option("--scenes", scenes, "folder of depth_*.toml")->required();
  app.add_option("--out", out, "folder to write into")->required();
  app.add_option("--birds", birds, "number of birds")->check(CLI::Range(2, 1000));
  app.add_option("--seeds", seeds, "runs of each")->check(CLI::Range(1, 1000));
  app.add_option("--threads", threads, "for every method")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<DepthPanel> panels;
    for (const DepthSweep& sweep : DepthSweeps()) {
      DepthPanel& panel = panels.emplace_back(DepthPanel{sweep, {}});
      for (const char* method : kMethods) panel.curves.push_back({method, {}, {}});
      for (const double amount : sweep.amounts) {
        DepthCase depth_case{.scene = "circling"};
        sweep.apply(amount, &depth_case);
        for (DepthCurve& curve : panel.curves) {
          curve.absolute.push_back(0);
          curve.scaled.push_back(0);
        }
        for (int seed = 1; seed <= seeds; ++seed) {
          const DepthTwin twin =
              MakeDepthTwin(depth_case, scenes, birds, static_cast<std::uint64_t>(seed), threads);
          for (DepthCurve& curve : panel.curves) {
            for (const DepthMethod& method : DepthMethods()) {
              if (method.name != curve.method) continue;
              const TrajectoryScores scores = RunDepthMethod(method, twin, threads).scores;
              curve.absolute.back() += scores.error_median / seeds;
              curve.scaled.back() += scores.scaled_error_median / seeds;
            }
          }
        }
        fmt::print(stderr, "{}: {}\n", sweep.name, amount);
      }
    }
    WriteTextFile(out / "depth_curves.svg", DepthCurvesPicture(panels));
    const std::string table = DepthCurvesTable(panels);
    WriteTextFile(out / "depth_curves.md", table);
    fmt::print("{}", table);
  } catch (const std::exception& error) {
    fmt::print(stderr, "flocklift_depth_curves: {}\n", error.what());
    return 2;
  }
  return 0;
}
