// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// flocklift_depth_table: the second half of tools/depth_table. Makes the twins, runs the methods
// and writes the table; the files of every twin and result stay for other judges.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "simulate/core/io.h"
#include "tools/depth_table.h"

namespace {

namespace fs = std::filesystem;
using namespace flocklift;  // NOLINT: the program's own parts

bool Wanted(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

int main(int argc, char** argv) {
  fs::path scenes, out;
  std::vector<std::string> scene_names, method_names;
  std::vector<int> birds = {20, 50};
  int seeds = 3, threads = 1;
  bool quiet = false;
  CLI::App app("Methods of depth side by side on synthetic scenes");
  app.add_option("--scenes", scenes, "folder of depth_*.toml")->required();
  app.add_option("--out", out, "folder to write into")->required();
  app.add_option("--scene", scene_names, "only these scenes");
  app.add_option("--method", method_names, "only these methods");
  app.add_option("--birds", birds, "numbers of birds")->capture_default_str();
  app.add_option("--seeds", seeds, "runs of each")->check(CLI::Range(1, 1000));
  app.add_option("--threads", threads, "for every method")->capture_default_str();
  app.add_flag("--quiet", quiet, "no progress");
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<DepthRow> rows;
    for (const DepthCase& depth_case : DepthCases()) {
      if (!Wanted(scene_names, depth_case.scene)) continue;
      for (const int count : birds) {
        const std::size_t first_row = rows.size();
        for (const DepthMethod& method : DepthMethods()) {
          if (!Wanted(method_names, method.name)) continue;
          rows.push_back({depth_case.scene, count, method.name, {}, {}});
        }
        for (int seed = 1; seed <= seeds; ++seed) {
          const DepthTwin twin =
              MakeDepthTwin(depth_case, scenes, count, static_cast<std::uint64_t>(seed), threads);
          const fs::path folder = out / fmt::format("{}_n{}_s{}", depth_case.scene, count, seed);
          WriteDepthTwin(folder, twin);
          std::size_t row = first_row;
          for (const DepthMethod& method : DepthMethods()) {
            if (!Wanted(method_names, method.name)) continue;
            const DepthRun run = RunDepthMethod(method, twin, threads);
            WriteTrajectories(folder / (method.name + ".csv"), run.result);
            rows[row].scores.push_back(run.scores);
            rows[row].cpu_ms.push_back(run.cpu_ms);
            ++row;
            if (quiet) continue;
            fmt::print(stderr, "{} {}: {:.2f} / {:.2f} %, scaled {:.2f} / {:.2f} %, {:.2f} ms\n",
                       folder.filename().string(), method.name, 100 * run.scores.error_median,
                       100 * run.scores.error_p90, 100 * run.scores.scaled_error_median,
                       100 * run.scores.scaled_error_p90, run.cpu_ms);
            if (run.scores.relative_within_1sd && run.scores.relative_within_2sd) {
              fmt::print(stderr, "  relative depth within 1 and 2 sds: {:.0f}, {:.0f} %\n",
                         100 * *run.scores.relative_within_1sd,
                         100 * *run.scores.relative_within_2sd);
            }
            for (const std::string& warning : run.report.warnings) {
              fmt::print(stderr, "  {}\n", warning);
            }
          }
        }
      }
    }
    const std::string table = DepthTable(rows);
    WriteTextFile(out / "depth_table.md", table);
    fmt::print("{}", table);
  } catch (const std::exception& error) {
    fmt::print(stderr, "flocklift_depth_table: {}\n", error.what());
    return 2;
  }
  return 0;
}
