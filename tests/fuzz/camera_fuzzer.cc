// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>

#include "simulate/camera/camera_io.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flocklift;
  const std::string text(reinterpret_cast<const char*>(data), size);
  Camera camera;
  if (!ReadsOrRefuses("FILE", [&] { camera = ParseCamera(text, "FILE"); })) return 0;
  FLOCKLIFT_REQUIRE(ParseCamera(FormatCamera(camera), "FILE") == camera);
  return 0;
}
