// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the camera looked in each frame, for tracks that are linked in the first frame's picture
// ("world") and told in their own frames' pictures.

#ifndef FLOCKLIFT_TRACK_CAMERA_PATH_H_
#define FLOCKLIFT_TRACK_CAMERA_PATH_H_

#include <cstdint>
#include <map>

#include "simulate/core/state_archive.h"
#include "track/detect/blob.h"
#include "track/detect/similarity.h"

namespace flocklift::internal {

class CameraPath {
 public:
  void Add(int frame, const Similarity& world_from_image) {
    if (!world_from_image.IsIdentity()) by_frame_.emplace(frame, world_from_image);
  }
  bool rests() const { return by_frame_.empty(); }
  Similarity WorldFromImage(int frame) const {
    const auto found = by_frame_.find(frame);
    return found == by_frame_.end() ? Similarity{} : found->second;
  }
  Vec2d ToImage(int frame, const Vec2d& p) const {
    return rests() ? p : WorldFromImage(frame).Inverse() * p;
  }
  Vec2d ToWorld(int frame, const Vec2d& p) const { return rests() ? p : WorldFromImage(frame) * p; }

  void Save(StateWriter* state) const {
    state->Put(static_cast<std::uint64_t>(by_frame_.size()));
    for (const auto& [frame, world_from_image] : by_frame_) {
      state->Put(frame);
      state->Put(world_from_image);
    }
  }
  void Load(StateReader* state) {
    std::uint64_t count = 0;
    state->Take(&count);
    for (; count > 0; --count) {
      int frame = 0;
      Similarity world_from_image;
      state->Take(&frame);
      state->Take(&world_from_image);
      by_frame_.emplace_hint(by_frame_.end(), frame, world_from_image);
    }
  }

 private:
  std::map<int, Similarity> by_frame_;
};

// Brings centres, moments and pixels into the world; boxes stay in the picture.
inline void Stabilise(BlobFrame* frame) {
  const Similarity& m = frame->world_from_image;
  if (m.IsIdentity()) return;
  for (Blob& blob : frame->blobs) {
    blob.center = m * blob.center;
    const Moments i = blob.moments;
    const double aa = m.a * m.a, bb = m.b * m.b, ab = m.a * m.b;
    blob.moments = {aa * i.xx - 2 * ab * i.xy + bb * i.yy, ab * (i.xx - i.yy) + (aa - bb) * i.xy,
                    bb * i.xx + 2 * ab * i.xy + aa * i.yy};
  }
  for (BlobPixel& p : frame->pixels) {
    const Vec2d at = m * Vec2d{p.x, p.y};
    p.x = static_cast<float>(at.x);
    p.y = static_cast<float>(at.y);
  }
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_CAMERA_PATH_H_
