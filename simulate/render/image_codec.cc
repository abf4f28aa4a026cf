// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/image_codec.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"

namespace flocklift {
namespace {

std::vector<std::uint8_t> Encode(const Image& image, const char* extension,
                                 const std::vector<int>& settings) {
  Check(image.width > 0 && image.height > 0, "a picture without pixels cannot be encoded");
  // OpenCV's header wants a mutable pointer; imencode only reads.
  const cv::Mat picture(image.height, image.width, CV_8UC3,
                        const_cast<std::uint8_t*>(image.bgr.data()));
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(extension, picture, bytes, settings)) {
    throw std::runtime_error(std::string("cannot encode a picture as ") + extension);
  }
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> EncodePng(const Image& image) {
  return Encode(image, ".png", {cv::IMWRITE_PNG_COMPRESSION, 6});
}

std::vector<std::uint8_t> EncodeJpeg(const Image& image, int quality) {
  Check(quality >= 1 && quality <= 100, "the quality of a JPEG goes from 1 to 100");
  return Encode(image, ".jpg", {cv::IMWRITE_JPEG_QUALITY, quality});
}

std::optional<Image> DecodeImage(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return std::nullopt;
  const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8UC1,
                        const_cast<std::uint8_t*>(bytes.data()));
  cv::Mat picture;
  try {
    picture = cv::imdecode(encoded, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  if (picture.empty()) return std::nullopt;
  Image image(picture.cols, picture.rows);
  for (int v = 0; v < image.height; ++v) {
    std::memcpy(image.Row(v), picture.ptr(v), 3 * static_cast<std::size_t>(image.width));
  }
  return image;
}

void WritePng(const std::filesystem::path& path, const Image& image) {
  const std::vector<std::uint8_t> bytes = EncodePng(image);
  WriteTextFile(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Image ReadImage(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path.string(), 0, "cannot be opened", "check the name");
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::optional<Image> image =
      DecodeImage({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  if (!image) {
    throw InputError(path.string(), 0, "is no picture that can be read", "give a PNG or JPEG file");
  }
  return *std::move(image);
}

}  // namespace flocklift
