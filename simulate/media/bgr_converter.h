// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Decoded frames of any pixel format as pictures, through libswscale.

#ifndef FLOCKLIFT_SIMULATE_MEDIA_BGR_CONVERTER_H_
#define FLOCKLIFT_SIMULATE_MEDIA_BGR_CONVERTER_H_

#include <memory>

#include "simulate/core/image.h"

struct AVFrame;

namespace flocklift::internal {

// What is scaled is averaged over areas.
class BgrConverter {
 public:
  // `exact`: the same bytes on every machine, colours between those of the pixels; slower.
  explicit BgrConverter(bool exact);
  ~BgrConverter();
  BgrConverter(const BgrConverter&) = delete;
  BgrConverter& operator=(const BgrConverter&) = delete;

  // At `width` x `height` px; false for a pixel format that cannot be converted, `image` then being
  // as it was.
  bool Convert(const AVFrame& frame, int width, int height, Image* image);

 private:
  struct Scaler;
  std::unique_ptr<Scaler> scaler_;
};

// Are 0 and 255 black and white (and not 16 and 235)?
bool IsFullRange(const AVFrame& frame);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_MEDIA_BGR_CONVERTER_H_
