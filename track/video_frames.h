// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The frames of a video file by number, each the same however it is come to: the file is gone
// through once for the times of its frames and its key frames, and decoded from one of these.

#ifndef FLOCKLIFT_TRACK_VIDEO_FRAMES_H_
#define FLOCKLIFT_TRACK_VIDEO_FRAMES_H_

#include <filesystem>
#include <memory>

#include "simulate/core/image.h"

namespace flocklift {

class VideoFrames {
 public:
  // Throws InputError when there is no video that can be decoded.
  explicit VideoFrames(const std::filesystem::path& path);
  ~VideoFrames();
  VideoFrames(const VideoFrames&) = delete;
  VideoFrames& operator=(const VideoFrames&) = delete;

  int width() const;
  int height() const;
  int frame_count() const;

  // Frame `frame` (from 1) at `width` x `height` px; false when it cannot be decoded.
  bool Read(int frame, int width, int height, Image* image);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_VIDEO_FRAMES_H_
