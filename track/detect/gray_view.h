// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A picture as OpenCV wants it, without a copy.

#ifndef FLOCKLIFT_TRACK_DETECT_GRAY_VIEW_H_
#define FLOCKLIFT_TRACK_DETECT_GRAY_VIEW_H_

#include "track/gray_image.h"

namespace cv {
class Mat;
}

namespace flocklift {

// What writes to it writes to the picture, which must outlive it.
cv::Mat View(const GrayImage& image);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_GRAY_VIEW_H_
