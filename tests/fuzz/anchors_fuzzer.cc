// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

#include "simulate/core/io.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flocklift;
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<Anchor> anchors;
  if (!ReadsOrRefuses("FILE", [&] { anchors = ReadAnchors(stream, "FILE"); })) return 0;
  std::string text = "frame,id,x,y,z,sd\n";
  for (const Anchor& a : anchors) {
    text += fmt::format("{},{},{},{},{},{}\n", a.frame, a.id, a.position.x, a.position.y,
                        a.position.z, a.sd);
  }
  std::istringstream rewritten(text);
  const std::vector<Anchor> again = ReadAnchors(rewritten, "FILE");
  FLOCKLIFT_REQUIRE(again.size() == anchors.size() && !again.empty());
  for (std::size_t k = 0; k < again.size(); ++k) {
    const Anchor &a = anchors[k], &b = again[k];
    FLOCKLIFT_REQUIRE(a.frame == b.frame && a.id == b.id && a.position == b.position);
    FLOCKLIFT_REQUIRE(a.sd == b.sd && a.sd > 0);
  }
  return 0;
}
