// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/interchange/foreign_tracks.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/fuzz.h"

namespace {

using namespace flocklift;

void RequireSound(const Detection& d) {
  FLOCKLIFT_REQUIRE(d.frame >= 1 && std::isfinite(d.box.left) && std::isfinite(d.box.top));
  FLOCKLIFT_REQUIRE(d.box.width > 0 && d.box.height > 0);
  FLOCKLIFT_REQUIRE(d.confidence > 0 && d.confidence <= 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  ForeignTracks read;
  if (!ReadsOrRefuses("FILE", [&] { read = ReadForeignTracks(stream, "FILE", {}); })) return 0;
  FLOCKLIFT_REQUIRE(read.has_ids != read.tracks.tracklets.empty());
  FLOCKLIFT_REQUIRE(read.has_ids == read.detections.empty());
  FLOCKLIFT_REQUIRE(!read.tracks.fps || *read.tracks.fps > 0);
  Id last_id = 0;
  for (const Tracklet& t : read.tracks.tracklets) {
    FLOCKLIFT_REQUIRE(t.id > last_id && !t.detections.empty());
    last_id = t.id;
    int last = 0;
    for (const Detection& d : t.detections) {
      RequireSound(d);
      FLOCKLIFT_REQUIRE(d.frame > last);
      last = d.frame;
    }
  }
  int last = 0;
  for (const DetectionFrame& f : read.detections) {
    FLOCKLIFT_REQUIRE(f.frame > last && !f.detections.empty());
    last = f.frame;
    for (const Detection& d : f.detections) RequireSound(d);
  }
  return 0;
}
