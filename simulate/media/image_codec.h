// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures as PNG (lossless) or JPEG, in memory and in files, through libavcodec.

#ifndef FLOCKLIFT_SIMULATE_MEDIA_IMAGE_CODEC_H_
#define FLOCKLIFT_SIMULATE_MEDIA_IMAGE_CODEC_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "simulate/core/image.h"

namespace flocklift {

std::vector<std::uint8_t> EncodePng(const Image& image);
std::vector<std::uint8_t> EncodeJpeg(const Image& image, int quality = 90);  // of 100

// PNG, JPEG, TIFF, BMP, WebP, PBM, PGM or PPM, upright where the Exif of a JPEG says how the
// camera was held;
// nothing when it is none of them, or broken.
std::optional<Image> DecodeImage(std::span<const std::uint8_t> bytes);

// Written aside and renamed.
void WritePng(const std::filesystem::path& path, const Image& image);
// Throws InputError when there is no such file, or it is no picture.
Image ReadImage(const std::filesystem::path& path);

// Does a file begin like a picture that DecodeImage knows?
bool IsImageFile(const std::filesystem::path& path);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_MEDIA_IMAGE_CODEC_H_
