// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/bgr_converter.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "simulate/media/libav.h"

namespace flocklift::internal {
namespace {

constexpr int kAlignment = 64;  // of rows that are written in whole vectors

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

// The one that was used last, and what it is for.
struct BgrConverter::Scaler {
  bool exact;
  AvScaler context;
  bool is_full = false;
  // The scaler writes past the ends of rows: hence a picture of its own, with rows to spare.
  std::vector<std::uint8_t> padded;

  // Null where it cannot be done.
  SwsContext* For(const AVFrame& frame, int width, int height) {
    const bool is_scaled = width != frame.width || height != frame.height;
    int flags = is_scaled ? SWS_AREA : SWS_BICUBIC;
    if (exact) flags |= SWS_BITEXACT | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT;
    const bool is_full_now = frame.color_range == AVCOL_RANGE_JPEG;
    if (is_full_now != is_full) context.reset();
    is_full = is_full_now;
    context.reset(sws_getCachedContext(context.release(), frame.width, frame.height,
                                       static_cast<AVPixelFormat>(frame.format), width, height,
                                       AV_PIX_FMT_BGR24, flags, nullptr, nullptr, nullptr));
    if (context && is_full) {
      const int* coefficients = sws_getCoefficients(SWS_CS_DEFAULT);
      sws_setColorspaceDetails(context.get(), coefficients, 1, coefficients, 1, 0, 1 << 16,
                               1 << 16);
    }
    return context.get();
  }
};

BgrConverter::BgrConverter(bool exact)
    : scaler_(new Scaler{.exact = exact, .context = {}, .padded = {}}) {
  QuietLibav();
}
BgrConverter::~BgrConverter() = default;

bool BgrConverter::Convert(const AVFrame& frame, int width, int height, Image* image) {
  const auto make_room = [&] {
    if (image->width != width || image->height != height) *image = Image(width, height);
  };
  if (frame.format == AV_PIX_FMT_GRAY8 && width == frame.width && height == frame.height) {
    make_room();
    CopyGray(frame, image);
    return true;
  }
  SwsContext* const scaler = scaler_->For(frame, width, height);
  if (scaler == nullptr) return false;
  const int stride = (3 * width + kAlignment - 1) / kAlignment * kAlignment;
  std::vector<std::uint8_t>& padded = scaler_->padded;
  padded.resize(static_cast<std::size_t>(stride) * (static_cast<std::size_t>(height) + 1));
  std::uint8_t* rows[4] = {padded.data(), nullptr, nullptr, nullptr};
  const int strides[4] = {stride, 0, 0, 0};
  if (sws_scale(scaler, frame.data, frame.linesize, 0, frame.height, rows, strides) != height) {
    return false;
  }
  make_room();
  for (int v = 0; v < height; ++v) {
    std::copy_n(padded.data() + static_cast<std::size_t>(stride) * v, 3 * width, image->Row(v));
  }
  return true;
}

}  // namespace flocklift::internal
