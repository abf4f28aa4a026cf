// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Footage as a stream of frames: a video file, a pattern of numbered pictures (img_%04d.png) or a
// folder of pictures, in the natural order of their names (img_9 before img_10).

#ifndef FLOCKLIFT_TRACK_VIDEO_SOURCE_H_
#define FLOCKLIFT_TRACK_VIDEO_SOURCE_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "simulate/core/image.h"
#include "track/gray_image.h"

namespace flocklift {

// Reads one frame at a time, upright. Throws InputError for footage that is missing, empty, no
// footage, has no frame, or whose frames differ in size.
class VideoSource {
 public:
  explicit VideoSource(const std::filesystem::path& path);
  ~VideoSource();
  VideoSource(const VideoSource&) = delete;
  VideoSource& operator=(const VideoSource&) = delete;

  int width() const;
  int height() const;
  std::optional<double> fps() const;                // as the video says; pictures have none [1/s]
  std::optional<std::int64_t> frame_count() const;  // as the file declares it

  // The next frame; false after the last one.
  bool Read(Image* image);
  bool Read(GrayImage* image);  // luma

  // Passes over so many frames; false where there are fewer.
  bool Skip(std::int64_t frames);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

// The pictures of a folder or pattern, in the order of the frames; empty when `path` is a file,
// which must then be a video. Throws InputError when there is nothing.
std::vector<std::filesystem::path> FootagePictures(const std::filesystem::path& path);

// Order of names in which runs of digits compare as numbers.
bool NaturalLess(std::string_view a, std::string_view b);

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_VIDEO_SOURCE_H_
