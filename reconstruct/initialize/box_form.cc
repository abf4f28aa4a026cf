// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/box_form.h"

#include <algorithm>
#include <cmath>

namespace flocklift {

BoxForm FormOfBoxes(const Tracks& tracks, const Camera& camera) {
  double squares = 0, freedoms = 0, diagonals = 0, boxes = 0;
  for (const Tracklet& tracklet : tracks.tracklets) {
    double n = 0, mean = 0;
    for (const Detection& d : tracklet.detections) {
      if (d.confidence < kMeasuredConfidence || IsCutOff(d.box, camera)) continue;
      if (!(d.box.width > 0) || !(d.box.height > 0)) continue;
      const double form = std::log(d.box.width / d.box.height);
      n += 1;
      const double step = form - mean;
      mean += step / n;
      squares += step * (form - mean);
      diagonals += 0.5 * std::log1p(std::exp(-2 * std::abs(form)));
    }
    boxes += n;
    freedoms += std::max(0.0, n - 1);
  }
  BoxForm form;
  if (boxes > 0) form.log_diagonal = diagonals / boxes;
  if (freedoms > 0) form.sd = std::sqrt(squares / freedoms);
  return form;
}

bool IsCutOff(const Box& box, const Camera& camera) {
  constexpr double kMargin = 1.5;  // [px]
  return box.left < kMargin || box.top < kMargin ||
         box.left + box.width > camera.width - 1 - kMargin ||
         box.top + box.height > camera.height - 1 - kMargin;
}

}  // namespace flocklift
