// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>

#include "simulate/core/scene_io.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flocklift;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Scene scene;
  if (!ReadsOrRefuses("FILE", [&] { scene = ParseScene(text, "FILE"); })) return 0;
  FLOCKLIFT_REQUIRE(!scene.species.empty() && scene.FrameCount() >= 1);
  const std::string once = FormatScene(scene);
  FLOCKLIFT_REQUIRE(FormatScene(ParseScene(once, "FILE")) == once);
  return 0;
}
