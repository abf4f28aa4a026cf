// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>

#include "simulate/core/io.h"
#include "tests/fuzz/fuzz.h"

namespace {

// Tracks of ids 1 to 3 over frames 1 to 4, for the shapes to fall on.
flocklift::Tracks SmallTracks() {
  flocklift::Tracks tracks;
  for (flocklift::Id id = 1; id <= 3; ++id) {
    flocklift::Tracklet tracklet{.id = id, .detections = {}};
    for (int frame = 1; frame <= 4; ++frame) {
      tracklet.detections.push_back(
          {.frame = frame, .box = {0, 0, 1, 1}, .confidence = 1, .shape = {}});
    }
    tracks.tracklets.push_back(tracklet);
  }
  return tracks;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flocklift;
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  Tracks tracks = SmallTracks(), again = SmallTracks();
  if (!ReadsOrRefuses("FILE", [&] { ReadShapes(stream, "FILE", &tracks); })) return 0;
  const auto once = ScratchFile("once.csv"), twice = ScratchFile("twice.csv");
  WriteShapes(once, tracks);
  ReadShapes(once, &again);
  WriteShapes(twice, again);
  FLOCKLIFT_REQUIRE(Contents(once) == Contents(twice));
  return 0;
}
