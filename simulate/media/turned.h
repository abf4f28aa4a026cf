// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures upright: cameras store them as the sensor lay, and say how it was held.

#ifndef FLOCKLIFT_SIMULATE_MEDIA_TURNED_H_
#define FLOCKLIFT_SIMULATE_MEDIA_TURNED_H_

#include "simulate/core/image.h"

namespace flocklift {

// By quarter turns clockwise, 0 to 3.
Image Turned(const Image& from, int quarters);

// As the orientation 1 to 8 of Exif 2.32, table 6, asks; any other number: as it is.
Image Upright(const Image& from, int exif_orientation);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_MEDIA_TURNED_H_
