// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/report/video_frame.h"

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

#include "simulate/core/check.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr int kDecodeFromStart = 900;  // frames; later ones are sought, which may be inexact
constexpr int kQuality = 84;

bool SkipTo(cv::VideoCapture& video, int frame) {
  for (int k = 1; k < frame; ++k) {
    if (!video.grab()) return false;
  }
  return true;
}

cv::Mat ReadFromVideo(const fs::path& path, int frame) {
  cv::VideoCapture video(path.string(), cv::CAP_FFMPEG);
  cv::Mat picture;
  if (!video.isOpened()) return picture;
  bool is_there = false;
  if (frame > kDecodeFromStart) {
    is_there = video.set(cv::CAP_PROP_POS_FRAMES, frame - 1) &&
               std::lround(video.get(cv::CAP_PROP_POS_FRAMES)) == frame - 1;
    if (!is_there) video.open(path.string(), cv::CAP_FFMPEG);
  }
  if (!is_there && !SkipTo(video, frame)) return picture;
  video.read(picture);
  return picture;
}

// A folder or pattern of pictures.
cv::Mat ReadFromPictures(const fs::path& path, int frame) {
  try {
    VideoSource source(path);
    Image image;
    for (int k = 1; k <= frame; ++k) {
      if (!source.Read(&image)) return {};
    }
    return cv::Mat(image.height, image.width, CV_8UC3, image.bgr.data()).clone();
  } catch (const InputError&) {
    return {};  // a report without its picture
  }
}

}  // namespace

std::optional<EmbeddedPicture> ReadVideoFrame(const fs::path& footage, int frame, int widest) {
  Check(frame >= 1 && widest >= 16, "frames count from 1, pictures are at least 16 px wide");
  cv::Mat picture = fs::is_regular_file(footage) ? ReadFromVideo(footage, frame)
                                                 : ReadFromPictures(footage, frame);
  if (picture.empty()) return std::nullopt;
  EmbeddedPicture embedded{picture.cols, picture.rows, {}};
  if (picture.cols > widest) {
    const int height =
        std::max(1, static_cast<int>(std::lround(1.0 * widest * picture.rows / picture.cols)));
    cv::Mat smaller;
    cv::resize(picture, smaller, {widest, height}, 0, 0, cv::INTER_AREA);
    picture = smaller;
  }
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality})) {
    return std::nullopt;
  }
  embedded.data_uri = "data:image/jpeg;base64," + Base64(bytes);
  return embedded;
}

std::string Base64(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t left = bytes.size() - k;
    const std::uint32_t word =
        (bytes[k] << 16) | ((left > 1 ? bytes[k + 1] : 0) << 8) | (left > 2 ? bytes[k + 2] : 0);
    text += kDigits[word >> 18];
    text += kDigits[(word >> 12) & 63];
    text += left > 1 ? kDigits[(word >> 6) & 63] : '=';
    text += left > 2 ? kDigits[word & 63] : '=';
  }
  return text;
}

}  // namespace flocklift
