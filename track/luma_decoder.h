// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The luma of a video's frames as the codec has it, through libavcodec: what detection looks at
// comes without a conversion to colours and back. Luma of limited range is spread,
// (Y - 16) 255 / 219, so that black is 0 and white 255.

#ifndef FLOCKLIFT_TRACK_LUMA_DECODER_H_
#define FLOCKLIFT_TRACK_LUMA_DECODER_H_

#include <filesystem>
#include <memory>

#include "track/gray_image.h"

namespace flocklift::internal {

class LumaDecoder {
 public:
  // Null for a video without a plane of 8-bit luma, one to be turned, or one that cannot be opened.
  static std::unique_ptr<LumaDecoder> Open(const std::filesystem::path& path);
  ~LumaDecoder();
  LumaDecoder(const LumaDecoder&) = delete;
  LumaDecoder& operator=(const LumaDecoder&) = delete;

  // The next frame; false after the last one. Packets that cannot be decoded are left out.
  bool Read(GrayImage* image);
  bool Skip();

 private:
  class Libav;
  explicit LumaDecoder(std::unique_ptr<Libav> libav);
  std::unique_ptr<Libav> libav_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_LUMA_DECODER_H_
