// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What stands before the sky of a camera at rest, pixel by pixel: lamp posts, leaves that sway. A
// look at the footage gives each pixel a contrast c(x), 0 where it does not stand out from its
// surroundings (background.h). Of the looks over some seconds,
//   S(x) = the contrast that a tenth of them reach,
// where within a few pixels something stood out in half of them: no animal that flies is at a place
// so often, and what sways is at each of its places often enough. S is taken out of a picture
// before anything is looked for in it: there, an animal shows by what it has more. Where nothing
// stands any more for some seconds, nothing is taken out.

#ifndef FLOCKLIFT_TRACK_DETECT_STILL_PICTURE_H_
#define FLOCKLIFT_TRACK_DETECT_STILL_PICTURE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulate/core/state_archive.h"
#include "track/detect/background.h"
#include "track/gray_image.h"

namespace flocklift {

class StillPicture {
 public:
  // None: nothing stands.
  StillPicture() = default;

  bool empty() const { return amount_.pixels.empty(); }

  // `dark`: what stands is darker than the sky.
  void TakeOut(bool dark, const GrayImage& image, GrayImage* cleaned) const;

  // A later look: lightly smoothed, as in learning, and the sky of the same picture, cleaned.
  // `frames` went by since the last one.
  void Follow(bool dark, const GrayImage& smooth, const LocalBackground& background, int frames);

  void Save(StateWriter* state) const;
  void Load(StateReader* state);

 private:
  friend class StillLooks;
  // Of a square of pixels: how many were seen to stand in half of the looks, and when last.
  struct Block {
    int seeds = 0;
    int unseen = 0;  // frames
  };

  void SetBlocks();
  // Of the block's neighbourhood, something still stands.
  bool Stands(int i, int j) const;

  GrayImage amount_;  // [grey levels]
  GrayImage seeds_;   // 1 where something stood in half of the looks
  int columns_ = 0, rows_ = 0;
  std::vector<Block> blocks_;
};

// The looks from which it is learned.
class StillLooks {
 public:
  static constexpr int kCount = 50;

  // `mask`: 255 where a pixel stands out.
  void Add(bool dark, const GrayImage& smooth, const LocalBackground& background,
           const GrayImage& mask);

  // After kCount looks; fewer teach nothing.
  StillPicture Learn() const;

 private:
  static constexpr std::size_t kStrongest = kCount / 10;

  int count_ = 0, width_ = 0, height_ = 0;
  std::vector<std::array<std::uint8_t, kStrongest>> strongest_;  // contrasts, falling
  std::vector<std::uint8_t> times_;                              // it stood out
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_STILL_PICTURE_H_
