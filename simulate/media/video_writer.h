// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writes pictures as a film: H.264 in MP4 at constant quality through libavcodec (MPEG-4 part 2
// where no H.264 encoder is installed), yuv420p, BT.601 limited range, index at the front of the
// file. Colour conversion and encoding run in threads of their own while the caller makes the next
// picture.

#ifndef FLOCKLIFT_SIMULATE_MEDIA_VIDEO_WRITER_H_
#define FLOCKLIFT_SIMULATE_MEDIA_VIDEO_WRITER_H_

#include <filesystem>
#include <memory>
#include <string>

#include "simulate/core/image.h"

namespace flocklift {

struct VideoOptions {
  int crf = 18;                      // H.264 constant rate factor; smaller is better and larger
  std::string preset = "ultrafast";  // of x264, up to veryslow; noisy film gains little from more
  int threads = 2;  // of the encoder. The bytes depend on it: leave it alone where they matter
  std::string encoder = {};  // libavcodec's name; empty: libx264, or mpeg4 where that is missing
};

template <typename Visitor>
void Describe(Visitor& visit, VideoOptions& o) {
  visit("crf", o.crf, {.low = 0, .high = 51}, "", "H.264 constant rate factor, smaller is better");
  visit("preset", o.preset, {}, "", "x264 preset, ultrafast to veryslow");
  visit("encoder-threads", o.threads, {.low = 1, .high = 16}, "", "threads of the video encoder");
  visit("encoder", o.encoder, {}, "", "libavcodec's name of the encoder, empty: the best");
}

// A frame rate as containers keep it.
struct FrameRate {
  int numerator = 30, denominator = 1;  // [1/s]

  // The simplest ratio equal to `fps` up to its last digits: 29.97 is 2997/100, and
  // 30000.0 / 1001 is 30000/1001. `fps` must be positive.
  static FrameRate Nearest(double fps);
};

// The same pictures, options and size give the same bytes. The file appears under its name in
// Finish; without Finish (an exception, say) nothing is left. Throws std::invalid_argument for bad
// options or a picture of another size, std::runtime_error when the encoder or the disk fails.
class VideoWriter {
 public:
  // yuv420p needs even sizes: an odd width or height grows by one, repeating the last column or
  // row, so that pixel coordinates stay as they are.
  VideoWriter(const std::filesystem::path& path, int width, int height, double fps,
              const VideoOptions& options = {});
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  // Appends one picture. Returns at once unless several wait already. Move it in to save a copy.
  void Write(Image image);
  void Finish();

 private:
  class Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_MEDIA_VIDEO_WRITER_H_
