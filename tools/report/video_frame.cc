// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/report/video_frame.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/media/image_codec.h"
#include "track/video_frames.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr int kQuality = 84;

// Of no size when there is none.
Image ReadFrame(const fs::path& footage, int frame) {
  Image image;
  const std::vector<fs::path> pictures = FootagePictures(footage);
  if (pictures.empty()) {
    VideoFrames video(footage);
    if (!video.Read(frame, video.width(), video.height(), &image)) return {};
  } else if (static_cast<std::size_t>(frame) <= pictures.size()) {
    image = ReadImage(pictures[static_cast<std::size_t>(frame - 1)]);
  }
  return image;
}

}  // namespace

std::optional<EmbeddedPicture> ReadVideoFrame(const fs::path& footage, int frame, int widest) {
  Check(frame >= 1 && widest >= 16, "frames count from 1, pictures are at least 16 px wide");
  Image image;
  try {
    image = ReadFrame(footage, frame);
  } catch (const InputError&) {
    return std::nullopt;  // a report without its picture
  }
  if (image.width == 0) return std::nullopt;
  EmbeddedPicture embedded{image.width, image.height, {}};
  if (image.width > widest) {
    Image smaller(
        widest,
        std::max(1, static_cast<int>(std::lround(1.0 * widest * image.height / image.width))));
    cv::Mat to(smaller.height, smaller.width, CV_8UC3, smaller.bgr.data());
    cv::resize(cv::Mat(image.height, image.width, CV_8UC3, image.bgr.data()), to, to.size(), 0, 0,
               cv::INTER_AREA);
    image = std::move(smaller);
  }
  embedded.data_uri = "data:image/jpeg;base64," + Base64(EncodeJpeg(image, kQuality));
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
