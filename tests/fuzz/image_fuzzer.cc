// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <cstdint>

#include "simulate/media/image_codec.h"
#include "tests/fuzz/fuzz.h"

// What is taken has all its pixels, and is the same after PNG.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flocklift;
  const auto image = DecodeImage({data, size});
  if (!image) return 0;
  FLOCKLIFT_REQUIRE(image->width > 0 && image->height > 0);
  FLOCKLIFT_REQUIRE(image->bgr.size() == std::size_t{3} * image->width * image->height);
  if (image->bgr.size() > (1U << 22U)) return 0;
  const auto again = DecodeImage(EncodePng(*image));
  FLOCKLIFT_REQUIRE(again && again->bgr == image->bgr);
  return 0;
}
