// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/still_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "track/detect/gray_view.h"

namespace flocklift {
namespace {

constexpr int kNear = 6;            // [px] from what stood in half of the looks
constexpr double kMargin = 1.1;     // on the contrast: light changes, leaves go on swaying
constexpr int kBlock = 16;          // side [px]
constexpr double kLeastSeen = 0.2;  // of a block's seeds
constexpr int kForget = 120;        // frames

void Widen(int reach, GrayImage* image) {
  cv::Mat view = View(*image);
  cv::dilate(view, view, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8UC1));
}

int ContrastAt(const LevelTable& level, bool dark, const GrayImage& smooth, int u, int v) {
  const double c = level.At(u, v) - static_cast<double>(smooth.Row(v)[u]);
  return static_cast<int>(std::lround(dark ? c : -c));
}

}  // namespace

void StillLooks::Add(bool dark, const GrayImage& smooth, const LocalBackground& background,
                     const GrayImage& mask) {
  const std::size_t size = smooth.pixels.size();
  if (count_ == 0) {
    width_ = smooth.width;
    height_ = smooth.height;
    strongest_.assign(size, {});
    times_.assign(size, 0);
  }
  ++count_;
  const LevelTable level(background, width_, height_);
  for (int v = 0; v < height_; ++v) {
    const std::uint8_t* marked = mask.Row(v);
    for (int u = 0; u < width_; ++u) {
      if (marked[u] == 0) continue;
      const std::size_t k = static_cast<std::size_t>(v) * width_ + u;
      ++times_[k];
      auto contrast =
          static_cast<std::uint8_t>(std::clamp(ContrastAt(level, dark, smooth, u, v), 1, 255));
      for (std::uint8_t& strong : strongest_[k]) {
        if (contrast > strong) std::swap(contrast, strong);
      }
    }
  }
}

StillPicture StillLooks::Learn() const {
  StillPicture still;
  if (count_ < kCount) return still;
  GrayImage amount(width_, height_), seeds(width_, height_);
  for (std::size_t k = 0; k < times_.size(); ++k) {
    seeds.pixels[k] = 2 * times_[k] >= count_ ? 1 : 0;
    const double with_margin = std::min(kMargin * strongest_[k].back(), 255.0);
    amount.pixels[k] = static_cast<std::uint8_t>(with_margin);
  }
  GrayImage near = seeds;
  Widen(kNear, &near);
  Widen(1, &amount);
  for (std::size_t k = 0; k < times_.size(); ++k) amount.pixels[k] *= near.pixels[k];
  if (std::none_of(seeds.pixels.begin(), seeds.pixels.end(), [](auto s) { return s > 0; })) {
    return still;
  }
  still.amount_ = std::move(amount);
  still.seeds_ = std::move(seeds);
  still.SetBlocks();
  return still;
}

void StillPicture::SetBlocks() {
  columns_ = (amount_.width + kBlock - 1) / kBlock;
  rows_ = (amount_.height + kBlock - 1) / kBlock;
  blocks_.assign(static_cast<std::size_t>(columns_) * rows_, {});
  for (int v = 0; v < amount_.height; ++v) {
    for (int u = 0; u < amount_.width; ++u) {
      blocks_[static_cast<std::size_t>(v / kBlock) * columns_ + u / kBlock].seeds +=
          seeds_.Row(v)[u];
    }
  }
}

void StillPicture::TakeOut(bool dark, const GrayImage& image, GrayImage* cleaned) const {
  if (cleaned->width != image.width || cleaned->height != image.height) {
    *cleaned = GrayImage(image.width, image.height);
  }
  cv::Mat out = View(*cleaned);
  if (dark) {
    cv::add(View(image), View(amount_), out);
  } else {
    cv::subtract(View(image), View(amount_), out);
  }
}

bool StillPicture::Stands(int i, int j) const {
  for (int y = std::max(j - 1, 0); y <= std::min(j + 1, rows_ - 1); ++y) {
    for (int x = std::max(i - 1, 0); x <= std::min(i + 1, columns_ - 1); ++x) {
      const Block& block = blocks_[static_cast<std::size_t>(y) * columns_ + x];
      if (block.seeds > 0 && block.unseen <= kForget) return true;
    }
  }
  return false;
}

void StillPicture::Follow(bool dark, const GrayImage& smooth, const LocalBackground& background,
                          int frames) {
  const LevelTable level(background, smooth.width, smooth.height);
  bool changes = false;
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      Block& block = blocks_[static_cast<std::size_t>(j) * columns_ + i];
      if (block.seeds == 0 || block.unseen > kForget) continue;
      int seen = 0;
      const int bottom = std::min((j + 1) * kBlock, smooth.height);
      const int right = std::min((i + 1) * kBlock, smooth.width);
      for (int v = j * kBlock; v < bottom; ++v) {
        for (int u = i * kBlock; u < right; ++u) {
          if (seeds_.Row(v)[u] == 0) continue;
          seen += 2 * ContrastAt(level, dark, smooth, u, v) >= amount_.Row(v)[u] ? 1 : 0;
        }
      }
      block.unseen = seen >= kLeastSeen * block.seeds ? 0 : block.unseen + frames;
      changes = changes || block.unseen > kForget;
    }
  }
  if (!changes) return;
  for (int v = 0; v < amount_.height; ++v) {
    for (int u = 0; u < amount_.width; ++u) {
      std::uint8_t* amount = amount_.Row(v) + u;
      if (*amount > 0 && !Stands(u / kBlock, v / kBlock)) *amount = 0;
    }
  }
}

void StillPicture::Save(StateWriter* state) const {
  state->Put(amount_.width);
  state->Put(amount_.height);
  state->Put(amount_.pixels);
  state->Put(seeds_.pixels);
  state->Put(blocks_);
}

void StillPicture::Load(StateReader* state) {
  int width = 0, height = 0;
  state->Take(&width);
  state->Take(&height);
  amount_ = width > 0 ? GrayImage(width, height) : GrayImage();
  seeds_ = amount_;
  state->Take(&amount_.pixels);
  state->Take(&seeds_.pixels);
  SetBlocks();
  state->Take(&blocks_);
}

}  // namespace flocklift
