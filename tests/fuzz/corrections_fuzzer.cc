// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

#include "simulate/core/io.h"
#include "tests/fuzz/fuzz.h"

namespace {

std::string Format(const flocklift::Correction& c) {
  using Kind = flocklift::Correction::Kind;
  switch (c.kind) {
    case Kind::kSwap:
      return fmt::format("swap {} {} {}\n", c.id, c.other_id, c.first_frame);
    case Kind::kSplit:
      return fmt::format("split {} {}\n", c.id, c.first_frame);
    case Kind::kJoin:
      return fmt::format("join {} {}\n", c.id, c.other_id);
    case Kind::kDelete:
      return c.first_frame == 0
                 ? fmt::format("delete {}\n", c.id)
                 : fmt::format("delete {} {} {}\n", c.id, c.first_frame, c.last_frame);
    case Kind::kPin:
      return fmt::format("pin {} {} {} {}\n", c.id, c.first_frame, c.point.x, c.point.y);
    case Kind::kAdd:
      return fmt::format("add {} {} {}\n", c.first_frame, c.point.x, c.point.y);
  }
  return "";
}

std::string Format(const std::vector<flocklift::Correction>& corrections) {
  std::string text;
  for (const flocklift::Correction& correction : corrections) text += Format(correction);
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flocklift;
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<Correction> corrections;
  if (!ReadsOrRefuses("FILE", [&] { corrections = ReadCorrections(stream, "FILE"); })) return 0;
  const std::string text = Format(corrections);
  std::istringstream rewritten(text);
  FLOCKLIFT_REQUIRE(Format(ReadCorrections(rewritten, "FILE")) == text);
  return 0;
}
