// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// flocklift_kernel_table, a build target that is not installed: flies the flocks, fits their
// kernels and writes the table, and the kernels of each first seed beside the true ones.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "tools/kernel_picture.h"
#include "tools/kernel_table.h"

namespace {

namespace fs = std::filesystem;
using namespace flocklift;  // NOLINT: the program's own parts

}  // namespace

int main(int argc, char** argv) {
  fs::path out;
  std::vector<std::string> names;
  std::vector<double> noises = {0, 1e-3};
  int seeds = 5, predicted = 20, runs = 0, threads = 0;
  KernelFitOptions options;
  CLI::App app("Fits of kernels without a form where the kernels are known");
  app.add_option("--out", out, "folder to write into")->required();
  app.add_option("--system", names, "only these")->delimiter(',');
  app.add_option("--noise", noises, "sd of the positions [m]")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--seeds", seeds, "of each")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--runs", runs, "that a fit sees; 0: as published");
  app.add_option("--predicted", predicted, "runs of each kind that are predicted")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--intervals", options.intervals, "of a spline")->capture_default_str();
  app.add_option("--degree", options.degree, "of a spline")->capture_default_str();
  app.add_option("--threads", threads, "for every fit")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<KernelRow> rows;
    for (KernelSystem system : KernelSystems()) {
      if (!names.empty() && std::find(names.begin(), names.end(), system.name) == names.end()) {
        continue;
      }
      if (runs > 0) system.runs = runs;
      for (const double noise : noises) {
        for (int seed = 1; seed <= seeds; ++seed) {
          const KernelTrial trial = TryKernels(
              system, options, noise, static_cast<std::uint64_t>(seed), predicted, threads);
          rows.push_back(trial.row);
          fmt::print(stderr,
                     "{} noise {:g} seed {}: error {:.4f}, covers {:.2f}, noise {:.3g}, D {:.3g}, "
                     "{:.1f} parameters{}\n",
                     system.name, noise, seed, trial.row.kernels[0].error,
                     trial.row.kernels[0].coverage, trial.fit.position_noise, trial.fit.diffusion,
                     trial.fit.effective, trial.fit.converged ? "" : ", not converged");
          if (seed > 1) continue;
          WriteTextFile(out / fmt::format("{}_{:g}.svg", system.name, noise),
                        KernelsPicture(trial.fit.kernels, system.order,
                                       {system.attraction, system.alignment}));
        }
      }
    }
    const std::string table = KernelTable(rows);
    WriteTextFile(out / "kernel_table.md", table);
    fmt::print("{}", table);
  } catch (const std::exception& error) {
    fmt::print(stderr, "flocklift_kernel_table: {}\n", error.what());
    return 2;
  }
  return 0;
}
