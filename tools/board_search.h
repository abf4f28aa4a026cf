// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Looks for a calibration board in pictures, or in the sharpest frames of a video.

#ifndef FLOCKLIFT_TOOLS_BOARD_SEARCH_H_
#define FLOCKLIFT_TOOLS_BOARD_SEARCH_H_

#include <filesystem>
#include <string>
#include <vector>

#include "simulate/camera/board.h"
#include "simulate/core/progress.h"

namespace flocklift {

// The pictures that paths mean: a folder its pictures by natural order of their names, a pattern
// (img_%03d.png) what matches it, a picture itself. Empty for one path that is something else (a
// video). Throws InputError for what is not there, and for videos among pictures.
std::vector<std::filesystem::path> ExpandPictures(const std::vector<std::filesystem::path>& paths);

struct BoardSearch {
  std::vector<BoardView> views;      // those with a board, repeats dropped
  std::vector<std::string> without;  // names of pictures without one
  int looked_at = 0;                 // pictures, or frames that were tried
  int width = 0, height = 0;         // of every picture [px]
};

// Throws InputError for pictures that cannot be decoded or differ in size.
BoardSearch SearchPictures(const std::vector<std::filesystem::path>& pictures, const Board& board,
                           int threads, const Progress& progress);

// Tries the sharpest frame of each of about `tries` stretches of the video, and keeps at most
// `max_views` views, spread well over place, size and tilt.
BoardSearch SearchVideo(const std::filesystem::path& video, const Board& board, int tries,
                        int max_views, int threads, const Progress& progress);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_BOARD_SEARCH_H_
