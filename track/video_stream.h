// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The first video of a file, frame after frame as its codec has them, through libavformat and
// libavcodec.

#ifndef FLOCKLIFT_TRACK_VIDEO_STREAM_H_
#define FLOCKLIFT_TRACK_VIDEO_STREAM_H_

#include <cstdint>
#include <filesystem>
#include <optional>

#include "simulate/media/libav.h"
#include "track/gray_image.h"

namespace flocklift::internal {

class VideoStream {
 public:
  // Throws InputError when there is no video that can be decoded. The frames are the same for any
  // number of threads; 0: as many as there are cores, 16 at most.
  explicit VideoStream(const std::filesystem::path& path, int threads = 0);

  // Upright, as the container says that it is to be shown [px].
  int width() const { return width_; }
  int height() const { return height_; }
  int turns() const { return turns_; }              // quarters clockwise to be upright
  std::optional<double> fps() const;                // [1/s]
  std::optional<std::int64_t> frame_count() const;  // as the file declares it

  // The next frame, valid until the next call; null after the last one. Packets that cannot be
  // decoded cost their frame, not the rest of the film.
  const AVFrame* Next();
  // Before a seek of `input`: forgets what was being decoded.
  void Flush();

  // The next packet is of this stream of this file.
  AVFormatContext* input() { return input_.get(); }
  int index() const { return index_; }

 private:
  bool Feed();

  AvInput input_;
  AvCodec codec_;
  AvFrame frame_{av_frame_alloc()};
  AvPacket packet_{av_packet_alloc()};
  int index_ = -1;
  int turns_ = 0, width_ = 0, height_ = 0;
  bool is_drained_ = false;
};

// The plane of 8-bit luma of a frame without a conversion to colours and back, limited range
// spread, (Y - 16) 255 / 219, so that black is 0 and white 255; false for frames without one.
bool ReadLuma(const AVFrame& frame, GrayImage* image);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_VIDEO_STREAM_H_
