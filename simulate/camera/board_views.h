// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which of many views of a board to calibrate by.

#ifndef FLOCKLIFT_SIMULATE_CAMERA_BOARD_VIEWS_H_
#define FLOCKLIFT_SIMULATE_CAMERA_BOARD_VIEWS_H_

#include <vector>

#include "simulate/camera/board.h"

namespace flocklift {

// Without repeats: of views whose corners agree within 2 px (root mean square) only the sharpest
// stays, for together they would count the same errors twice.
std::vector<BoardView> DropRepeats(std::vector<BoardView> views);

// At most `count` of the views, those that differ most in place, size and tilt (farthest-point
// choice from the largest view on), in their given order.
std::vector<BoardView> SelectViews(const std::vector<BoardView>& views, int count);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CAMERA_BOARD_VIEWS_H_
