// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/gray_view.h"

#include <cstdint>
#include <opencv2/core.hpp>

namespace flocklift {

cv::Mat View(const GrayImage& image) {
  return cv::Mat(image.height, image.width, CV_8UC1,
                 const_cast<std::uint8_t*>(image.pixels.data()));
}

}  // namespace flocklift
