// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The frames of a video file by number: see footage.h for how.

#ifndef FLOCKLIFT_TOOLS_VIEW_VIDEO_FRAMES_H_
#define FLOCKLIFT_TOOLS_VIEW_VIDEO_FRAMES_H_

#include <filesystem>
#include <memory>

#include "simulate/core/image.h"

namespace flocklift {

class VideoFrames {
 public:
  // Throws InputError when libav finds no video in the file.
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

#endif  // FLOCKLIFT_TOOLS_VIEW_VIDEO_FRAMES_H_
