// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/build_id.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace flocklift {
namespace {

// As the compiler's own tools read it off the file.
std::string IdByReadelf() {
  const std::string command = fmt::format("readelf --notes /proc/{}/exe", getpid());
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 256> line;
  while (fgets(line.data(), line.size(), pipe.get()) != nullptr) text += line.data();
  constexpr std::string_view kLabel = "Build ID: ";
  const std::size_t at = text.find(kLabel);
  if (at == std::string::npos) return "none";
  const std::size_t first = at + kLabel.size();
  return text.substr(first, text.find_first_not_of("0123456789abcdef", first) - first);
}

TEST(BuildId, IsWhatTheProgramsFileSays) {
  EXPECT_GE(BuildId().size(), 16U);
  EXPECT_EQ(BuildId(), IdByReadelf());
}

TEST(BuildId, IsPartOfTheProgramsIdentity) {
  EXPECT_NE(ProgramIdentity().find(BuildId()), std::string::npos);
}

}  // namespace
}  // namespace flocklift
