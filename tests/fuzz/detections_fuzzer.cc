// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>

#include "simulate/core/io.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/same.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flocklift;
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::istringstream stream(text), streamed(text);
  std::vector<DetectionFrame> frames;
  if (!ReadsOrRefuses("FILE", [&] { frames = ReadDetections(stream, "FILE"); })) return 0;
  std::size_t count = 0, streamed_count = 0;
  int last_frame = 0;
  for (const DetectionFrame& frame : frames) {
    FLOCKLIFT_REQUIRE(frame.frame > last_frame && !frame.detections.empty());
    last_frame = frame.frame;
    count += frame.detections.size();
  }
  ForEachTrackRow(streamed, "FILE", [&](const TrackRow&) { ++streamed_count; });
  FLOCKLIFT_REQUIRE(count == streamed_count);
  const auto once = ScratchFile("once.csv"), twice = ScratchFile("twice.csv");
  WriteDetections(once, frames);
  const std::vector<DetectionFrame> again = ReadDetections(once);
  FLOCKLIFT_REQUIRE(again.size() == frames.size());
  WriteDetections(twice, again);
  FLOCKLIFT_REQUIRE(Contents(once) == Contents(twice));
  return 0;
}
