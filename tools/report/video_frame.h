// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One frame of the footage, for an embedded picture.

#ifndef FLOCKLIFT_TOOLS_REPORT_VIDEO_FRAME_H_
#define FLOCKLIFT_TOOLS_REPORT_VIDEO_FRAME_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace flocklift {

struct EmbeddedPicture {
  int width = 0, height = 0;  // of the footage [px]
  std::string data_uri;       // JPEG, perhaps smaller than the footage
};

// Frame `frame` (from 1) of a video (whose packets are gone through once) or a folder or pattern of
// pictures, at most `widest` px wide; nothing when there is no such frame or the footage cannot be
// read.
std::optional<EmbeddedPicture> ReadVideoFrame(const std::filesystem::path& footage, int frame,
                                              int widest);

std::string Base64(std::span<const std::uint8_t> bytes);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPORT_VIDEO_FRAME_H_
