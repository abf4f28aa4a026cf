// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Calibration boards and where their corners lie in a picture: chessboards (found by Duda and
// Frese, "Accurate detection and localization of checkerboard corners for calibration", BMVC 2018,
// in OpenCV) and ChArUco boards (Garrido-Jurado et al., Pattern Recognition 47, 2014), of which a
// part in view is enough.

#ifndef FLOCKLIFT_SIMULATE_CAMERA_BOARD_H_
#define FLOCKLIFT_SIMULATE_CAMERA_BOARD_H_

#include <string>
#include <vector>

#include "simulate/core/image.h"
#include "simulate/core/vec3.h"

namespace flocklift {

struct Board {
  enum class Kind { kChessboard, kCharuco };

  Kind kind = Kind::kChessboard;
  int columns = 9, rows = 6;  // inner corners of a chessboard; squares of a ChArUco board
  double square = 1;          // side of a square [m]
  double marker = 0.5;        // side of a marker, ChArUco only [m]
  std::string dictionary = "DICT_4X4_50";  // of the markers, by OpenCV's name
};

// Throws std::invalid_argument: sizes out of range, an unknown dictionary.
void CheckBoard(const Board& board);

// The corners found in one picture, index k in both arrays; empty when no board was found.
struct BoardView {
  std::string name;             // of the picture, for messages
  double sharpness = 0;         // of the picture, see Sharpness
  std::vector<Vec3d> on_board;  // z = 0 [m]
  std::vector<Vec2d> pixels;    // [px]
  bool found() const { return !pixels.empty(); }
};
BoardView FindBoard(const Board& board, const Image& image, const std::string& name);

// How sharp a picture is: the variance of its Laplacian, for comparing neighbouring frames.
double Sharpness(const Image& image);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CAMERA_BOARD_H_
