// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The program `flocklift`. Exit status: 0 done, 1 failed, 2 bad input or options.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/core/suggest.h"
#include "tools/commands.h"
#include "tools/version.h"

namespace flocklift {
namespace {

int Main(int argc, char** argv) {
  CLI::App app("flocklift: from the video of one camera to a 3D flock");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("flocklift ") + kVersion);
  app.footer("`flocklift COMMAND --help` shows a command's options and examples.");
  AddCommands(app);

  std::vector<std::string> commands;
  for (const CLI::App* sub : app.get_subcommands({})) commands.push_back(sub->get_name());
  if (argc > 1 && argv[1][0] != '-' &&
      std::find(commands.begin(), commands.end(), argv[1]) == commands.end()) {
    fmt::print(stderr, "flocklift: there is no command `{}`; {}\n", argv[1],
               SuggestName(argv[1], commands));
    return 2;
  }
  const auto name = [&] {
    const auto used = app.get_subcommands();
    return used.empty() ? std::string("flocklift") : "flocklift " + used.front()->get_name();
  };
  const auto fail = [&](const std::exception& error, int status) {
    fmt::print(stderr, "{}: {}\n", name(), error.what());
    return status;
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    fmt::print(stderr, "{}: {}; see '{} --help'\n", name(), error.what(), name());
    return 2;
  } catch (const InputError& error) {
    return fail(error, 2);
  } catch (const std::invalid_argument& error) {
    return fail(error, 2);
  } catch (const std::exception& error) {
    return fail(error, 1);
  }
  return 0;
}

}  // namespace
}  // namespace flocklift

int main(int argc, char** argv) { return flocklift::Main(argc, argv); }
