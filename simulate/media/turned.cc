// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/turned.h"

#include <algorithm>

namespace flocklift {
namespace {

// Left to right.
Image Mirrored(const Image& from) {
  Image to(from.width, from.height);
  for (int v = 0; v < from.height; ++v) {
    for (int u = 0; u < from.width; ++u) {
      std::copy_n(from.Row(v) + 3 * u, 3, to.Row(v) + 3 * (from.width - 1 - u));
    }
  }
  return to;
}

}  // namespace

Image Turned(const Image& from, int quarters) {
  if (quarters == 0) return from;
  const bool swaps = quarters % 2 == 1;
  Image to(swaps ? from.height : from.width, swaps ? from.width : from.height);
  for (int v = 0; v < from.height; ++v) {
    for (int u = 0; u < from.width; ++u) {
      const int x = quarters == 1 ? from.height - 1 - v : quarters == 2 ? from.width - 1 - u : v;
      const int y = quarters == 1 ? u : quarters == 2 ? from.height - 1 - v : from.width - 1 - u;
      std::copy_n(from.Row(v) + 3 * u, 3, to.Row(y) + 3 * x);
    }
  }
  return to;
}

Image Upright(const Image& from, int exif_orientation) {
  switch (exif_orientation) {
    case 2:
      return Mirrored(from);
    case 3:
      return Turned(from, 2);
    case 4:
      return Turned(Mirrored(from), 2);
    case 5:
      return Turned(Mirrored(from), 3);
    case 6:
      return Turned(from, 1);
    case 7:
      return Turned(Mirrored(from), 1);
    case 8:
      return Turned(from, 3);
    default:
      return from;
  }
}

}  // namespace flocklift
