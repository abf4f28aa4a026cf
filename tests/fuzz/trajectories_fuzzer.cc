// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>

#include "simulate/core/io.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/same.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flocklift;
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  Trajectories flock;
  if (!ReadsOrRefuses("FILE", [&] { flock = ReadTrajectories(stream, "FILE"); })) return 0;
  FLOCKLIFT_REQUIRE(!flock.trajectories.empty());
  FLOCKLIFT_REQUIRE(IsOrdered(
      flock.trajectories, [](const Trajectory& t) -> const auto& { return t.points; }));
  const auto once = ScratchFile("once.csv"), twice = ScratchFile("twice.csv");
  WriteTrajectories(once, flock);
  const Trajectories again = ReadTrajectories(once);
  FLOCKLIFT_REQUIRE(Same(flock, again, 1e-8));
  WriteTrajectories(twice, again);
  if (!flock.has_orientation) FLOCKLIFT_REQUIRE(Contents(once) == Contents(twice));
  const FrameSpan span = SpanOf(again);
  FLOCKLIFT_REQUIRE(StateAtFrame(again, span.first).size() > 0);
  return 0;
}
