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
  Tracks tracks;
  if (!ReadsOrRefuses("FILE", [&] { tracks = ReadTracks(stream, "FILE"); })) return 0;
  FLOCKLIFT_REQUIRE(!tracks.tracklets.empty());
  FLOCKLIFT_REQUIRE(IsOrdered(
      tracks.tracklets, [](const Tracklet& t) -> const auto& { return t.detections; }));
  const auto once = ScratchFile("once.csv"), twice = ScratchFile("twice.csv");
  WriteTracks(once, tracks);
  const Tracks again = ReadTracks(once);
  FLOCKLIFT_REQUIRE(Same(tracks, again, 1.01e-4));
  WriteTracks(twice, again);
  FLOCKLIFT_REQUIRE(Contents(once) == Contents(twice));
  return 0;
}
