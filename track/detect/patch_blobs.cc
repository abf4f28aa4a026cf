// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/patch_blobs.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "track/detect/outline.h"

namespace flocklift {
namespace {

constexpr float kLeastContrast = 0.01f;  // [grey levels]: a blob's pixels all count

// Sums over the pixels of one blob, which stand at the end of `found.pixels` from `first` on. Its
// box is of whole pixels.
Blob Measure(const BlobFrame& found, std::size_t first) {
  const auto pixels = std::span(found.pixels).subspan(first);
  const float x0 = pixels[0].x, y0 = pixels[0].y;  // near, so that no digits are lost
  float left = x0, top = y0, right = x0, bottom = y0;
  double mass = 0, mx = 0, my = 0, mxx = 0, mxy = 0, myy = 0;
  for (const BlobPixel& p : pixels) {
    const double c = p.contrast, x = p.x - x0, y = p.y - y0;
    mass += c;
    mx += c * x;
    my += c * y;
    mxx += c * x * x;
    mxy += c * x * y;
    myy += c * y * y;
    left = std::min(left, p.x);
    right = std::max(right, p.x);
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  Blob blob;
  blob.mass = mass;
  mx /= mass;
  my /= mass;
  blob.center = {x0 + mx, y0 + my};
  blob.moments = {mxx / mass - mx * mx + 1.0 / 12, mxy / mass - mx * my,
                  myy / mass - my * my + 1.0 / 12};
  blob.box = {left - 0.5, top - 0.5, right - left + 1.0, bottom - top + 1.0};
  blob.first_pixel = static_cast<std::uint32_t>(first);
  blob.pixel_count = static_cast<std::uint32_t>(pixels.size());
  return blob;
}

}  // namespace

Box PatchCutter::BoxOfOutline(std::span<const BlobPixel> pixels, const Box& whole) {
  columns_.assign(static_cast<std::size_t>(whole.width), 0);
  rows_.assign(static_cast<std::size_t>(whole.height), 0);
  const auto left = static_cast<float>(whole.left + 0.5), top = static_cast<float>(whole.top + 0.5);
  for (const BlobPixel& p : pixels) {
    float& column = columns_[static_cast<std::size_t>(p.x - left)];
    float& row = rows_[static_cast<std::size_t>(p.y - top)];
    column = std::max(column, p.contrast);
    row = std::max(row, p.contrast);
  }
  const internal::Outline across = internal::OutlineOf(columns_), down = internal::OutlineOf(rows_);
  return {left + across.first, top + down.first, across.length(), down.length()};
}

void PatchCutter::Append(const Component& patch, const ContrastView& view, const BlobLimits& limits,
                         BlobFrame* found) {
  const int width = patch.right - patch.left + 1, height = patch.bottom - patch.top + 1;
  contrast_.assign(static_cast<std::size_t>(width) * height, 0);
  raw_.resize(contrast_.size());
  const auto sign = static_cast<float>(view.sign);
  float peak = 0;
  for (const PixelRun& run : patch.runs) {
    const std::uint8_t* smooth = view.smooth.Row(run.v);
    const std::uint8_t* image = view.image.Row(run.v);
    const std::size_t row = static_cast<std::size_t>(run.v - patch.top) * width;
    for (int u = run.first; u <= run.last; ++u) {
      const float level = view.level.At(u, run.v);
      const std::size_t k = row + (u - patch.left);
      contrast_[k] = std::max(sign * (level - smooth[u]), kLeastContrast);
      raw_[k] = std::max(sign * (level - image[u]), kLeastContrast);
      peak = std::max(peak, contrast_[k]);
    }
  }
  if (peak < limits.least_peak) return;

  WatershedOptions options;
  options.least_dip = std::max(4 * limits.noise, 0.5 * limits.least_peak);
  const int parts = watershed_.Cut(contrast_, width, height, options);
  for (int p = 0; p < parts; ++p) {
    const std::size_t first = found->pixels.size();
    found->pixels.resize(first + static_cast<std::size_t>(patch.area));
    BlobPixel* next = found->pixels.data() + first;
    float part_peak = 0;
    for (const PixelRun& run : patch.runs) {
      const std::size_t row = static_cast<std::size_t>(run.v - patch.top) * width;
      for (int u = run.first; u <= run.last; ++u) {
        const std::size_t k = row + (u - patch.left);
        if (parts > 1 && watershed_.part()[k] != p) continue;
        part_peak = std::max(part_peak, contrast_[k]);
        *next++ = {static_cast<float>(u), static_cast<float>(run.v), raw_[k]};
      }
    }
    found->pixels.resize(static_cast<std::size_t>(next - found->pixels.data()));
    Blob blob = Measure(*found, first);
    blob.peak = part_peak;
    blob.snr = part_peak / limits.noise;
    blob.cut = parts > 1;
    const Box box = blob.box;
    blob.edges = {
        box.left<0, box.top<0, box.left + box.width> view.image.width - 1, box.top + box.height>
            view.image.height -
        1};
    if (part_peak < limits.least_peak || static_cast<int>(blob.pixel_count) < limits.min_area ||
        std::max(box.width, box.height) > limits.longest_side) {
      found->pixels.resize(first);
      continue;
    }
    blob.box = BoxOfOutline(std::span(found->pixels).subspan(first), box);
    found->blobs.push_back(blob);
  }
}

}  // namespace flocklift
