// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A picture as OpenCV wants it, without a copy.

#ifndef FLOCKLIFT_TRACK_DETECT_GRAY_VIEW_H_
#define FLOCKLIFT_TRACK_DETECT_GRAY_VIEW_H_

#include <cstdint>
#include <opencv2/core.hpp>

#include "track/gray_image.h"

namespace flocklift {

// What writes to it writes to the picture, which must outlive it.
inline cv::Mat View(const GrayImage& image) {
  return cv::Mat(image.height, image.width, CV_8UC1,
                 const_cast<std::uint8_t*>(image.pixels.data()));
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_GRAY_VIEW_H_
