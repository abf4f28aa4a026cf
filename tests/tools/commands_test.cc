// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/commands.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <string>

namespace flocklift {
namespace {

// Commands that chain stages take the options of several; names that collide throw here.
TEST(Commands, TheirOptionsDoNotCollideAndAllAreDescribed) {
  CLI::App app;
  ASSERT_NO_THROW(AddCommands(app));
  const auto commands = app.get_subcommands({});
  EXPECT_GE(commands.size(), 8u);
  for (const CLI::App* command : commands) {
    EXPECT_FALSE(command->get_description().empty()) << command->get_name();
    for (const CLI::Option* option : command->get_options()) {
      EXPECT_FALSE(option->get_description().empty())
          << command->get_name() << ' ' << option->get_name();
    }
  }
}

}  // namespace
}  // namespace flocklift
