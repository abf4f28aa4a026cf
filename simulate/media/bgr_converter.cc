// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/bgr_converter.h"

extern "C" {
#include <libavutil/frame.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <cstdint>
#include <vector>

namespace flocklift::internal {
namespace {

// Rows of the scaler end on a multiple of this, hence a picture of its own to spare.
constexpr int kAlignment = 64;

void CopyGray(const AVFrame& frame, Image* image) {
  for (int v = 0; v < frame.height; ++v) {
    const std::uint8_t* from = frame.data[0] + static_cast<std::ptrdiff_t>(v) * frame.linesize[0];
    std::uint8_t* to = image->Row(v);
    for (int u = 0; u < frame.width; ++u) std::fill_n(to + 3 * u, 3, from[u]);
  }
}

}  // namespace

bool IsFullRange(const AVFrame& frame) {
  switch (frame.format) {
    case AV_PIX_FMT_GRAY8:
    case AV_PIX_FMT_YUVJ420P:
    case AV_PIX_FMT_YUVJ422P:
    case AV_PIX_FMT_YUVJ444P:
      return true;
    default:
      return frame.color_range == AVCOL_RANGE_JPEG;
  }
}

BgrConverter::BgrConverter(bool exact) : exact_(exact) {}
BgrConverter::~BgrConverter() { sws_freeContext(scaler_); }

bool BgrConverter::Convert(const AVFrame& frame, int width, int height, Image* image) {
  if (image->width != width || image->height != height) *image = Image(width, height);
  const bool is_scaled = width != frame.width || height != frame.height;
  if (frame.format == AV_PIX_FMT_GRAY8 && !is_scaled) {
    CopyGray(frame, image);
    return true;
  }
  int flags = is_scaled ? SWS_AREA : SWS_BICUBIC;
  if (exact_) flags |= SWS_BITEXACT | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT;
  scaler_ = sws_getCachedContext(scaler_, frame.width, frame.height,
                                 static_cast<AVPixelFormat>(frame.format), width, height,
                                 AV_PIX_FMT_BGR24, flags, nullptr, nullptr, nullptr);
  if (scaler_ == nullptr) return false;
  if (frame.color_range == AVCOL_RANGE_JPEG) {
    const int* coefficients = sws_getCoefficients(SWS_CS_DEFAULT);
    sws_setColorspaceDetails(scaler_, coefficients, 1, coefficients, 1, 0, 1 << 16, 1 << 16);
  }
  const int stride = (3 * width + kAlignment - 1) / kAlignment * kAlignment;
  std::vector<std::uint8_t> padded(static_cast<std::size_t>(stride) * (height + 1));
  std::uint8_t* rows[4] = {padded.data(), nullptr, nullptr, nullptr};
  const int strides[4] = {stride, 0, 0, 0};
  if (sws_scale(scaler_, frame.data, frame.linesize, 0, frame.height, rows, strides) != height) {
    return false;
  }
  for (int v = 0; v < height; ++v) {
    std::copy_n(padded.data() + static_cast<std::size_t>(stride) * v, 3 * width, image->Row(v));
  }
  return true;
}

}  // namespace flocklift::internal
