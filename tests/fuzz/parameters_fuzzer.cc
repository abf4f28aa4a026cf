// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>

#include "simulate/core/parameters.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flocklift;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Parameters parameters;
  if (!ReadsOrRefuses("FILE", [&] { parameters = ParseParameters(text, "FILE"); })) return 0;
  const std::string once = FormatParameters(parameters);
  FLOCKLIFT_REQUIRE(FormatParameters(ParseParameters(once, "FILE")) == once);
  return 0;
}
