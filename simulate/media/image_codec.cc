// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/image_codec.h"

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>
#include <cctype>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/media/bgr_converter.h"
#include "simulate/media/libav.h"
#include "simulate/media/turned.h"

namespace flocklift {
namespace {

using internal::AvCodec;
using internal::AvFrame;
using internal::AvPacket;

constexpr int kPngCompression = 6;  // of 9

// By the first bytes, as the formats' definitions have them.
AVCodecID CodecOf(std::string_view bytes) {
  using std::string_view_literals::operator""sv;
  const auto holds = [&](std::size_t at, std::string_view what) {
    return bytes.size() >= at && bytes.substr(at).starts_with(what);
  };
  const auto begins = [&](std::string_view with) { return holds(0, with); };
  if (begins("\x89PNG"sv)) return AV_CODEC_ID_PNG;
  if (begins("\xff\xd8\xff"sv)) return AV_CODEC_ID_MJPEG;
  if (begins("II*\0"sv) || begins("MM\0*"sv)) return AV_CODEC_ID_TIFF;
  if (begins("BM"sv) && holds(6, "\0\0\0\0"sv)) return AV_CODEC_ID_BMP;
  if (begins("RIFF"sv) && holds(8, "WEBP"sv)) return AV_CODEC_ID_WEBP;
  if (begins("P") && bytes.size() > 2 && std::isspace(static_cast<unsigned char>(bytes[2])) != 0) {
    switch (bytes[1]) {
      case '1':
      case '4':
        return AV_CODEC_ID_PBM;
      case '2':
      case '5':
        return AV_CODEC_ID_PGM;
      case '3':
      case '6':
        return AV_CODEC_ID_PPM;
      default:
        break;
    }
  }
  return AV_CODEC_ID_NONE;
}

std::string_view AsText(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The picture in the file's own pixels; null when it is broken.
AvFrame Decode(std::span<const std::uint8_t> bytes) {
  internal::QuietLibav();
  const AVCodec* decoder = avcodec_find_decoder(CodecOf(AsText(bytes)));
  if (decoder == nullptr || bytes.size() > INT_MAX - AV_INPUT_BUFFER_PADDING_SIZE) return nullptr;
  const AvCodec codec(avcodec_alloc_context3(decoder));
  const AvPacket packet(av_packet_alloc());
  AvFrame frame(av_frame_alloc());
  codec->thread_count = 1;
  // A part of a picture is none. Of a TIFF small faults would be taken for it.
  if (decoder->id != AV_CODEC_ID_TIFF) codec->err_recognition = AV_EF_EXPLODE;
  if (!codec || !packet || !frame) return nullptr;
  if (av_new_packet(packet.get(), static_cast<int>(bytes.size())) < 0) return nullptr;
  std::memcpy(packet->data, bytes.data(), bytes.size());
  if (avcodec_open2(codec.get(), decoder, nullptr) < 0 ||
      avcodec_send_packet(codec.get(), packet.get()) < 0 ||
      avcodec_send_packet(codec.get(), nullptr) < 0 ||
      avcodec_receive_frame(codec.get(), frame.get()) < 0) {
    return nullptr;
  }
  const bool is_broken =
      frame->decode_error_flags != 0 || (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0;
  return is_broken ? nullptr : std::move(frame);
}

int Orientation(const AVFrame& frame) {
  const AVDictionaryEntry* entry = av_dict_get(frame.metadata, "Orientation", nullptr, 0);
  return entry == nullptr ? 1 : std::atoi(entry->value);
}

void Must(int status, const std::string& what) {
  if (status < 0) throw std::runtime_error("cannot encode a picture: " + what);
}

AvFrame NewFrame(const Image& image, AVPixelFormat format) {
  AvFrame frame(av_frame_alloc());
  Must(frame ? 0 : AVERROR(ENOMEM), "out of memory");
  frame->format = format;
  frame->width = image.width;
  frame->height = image.height;
  Must(av_frame_get_buffer(frame.get(), 0), "out of memory");
  return frame;
}

// `image` in the pixels that an encoder wants. The scaler reads past the end of rows: it is given
// some that have room there.
AvFrame FrameOf(const Image& image, AVPixelFormat format) {
  const AvFrame padded = NewFrame(image, AV_PIX_FMT_BGR24);
  for (int v = 0; v < image.height; ++v) {
    std::copy_n(image.Row(v), 3 * image.width,
                padded->data[0] + static_cast<std::ptrdiff_t>(v) * padded->linesize[0]);
  }
  AvFrame frame = NewFrame(image, format);
  const internal::AvScaler scaler(
      sws_getContext(image.width, image.height, AV_PIX_FMT_BGR24, image.width, image.height, format,
                     SWS_AREA | SWS_BITEXACT | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
  Must(scaler ? 0 : AVERROR(EINVAL), "no such pixels");
  Must(sws_scale(scaler.get(), padded->data, padded->linesize, 0, image.height, frame->data,
                 frame->linesize),
       "its colours cannot be converted");
  return frame;
}

// `configure` sets what the format has to choose from.
template <typename Configure>
std::vector<std::uint8_t> Encode(const Image& image, AVCodecID id, AVPixelFormat format,
                                 const Configure& configure) {
  Check(image.width > 0 && image.height > 0, "a picture without pixels cannot be encoded");
  internal::QuietLibav();
  const AVCodec* encoder = avcodec_find_encoder(id);
  if (encoder == nullptr) throw std::runtime_error("libavcodec lacks the encoder of a picture");
  const AvCodec codec(avcodec_alloc_context3(encoder));
  const AvPacket packet(av_packet_alloc());
  Must(codec && packet ? 0 : AVERROR(ENOMEM), "out of memory");
  codec->width = image.width;
  codec->height = image.height;
  codec->pix_fmt = format;
  codec->time_base = {1, 1};
  codec->thread_count = 1;
  codec->flags |= AV_CODEC_FLAG_BITEXACT;
  configure(codec.get());
  Must(avcodec_open2(codec.get(), encoder, nullptr), "its encoder does not open");
  const AvFrame frame = FrameOf(image, format);
  frame->quality = codec->global_quality;
  frame->pts = 0;
  Must(avcodec_send_frame(codec.get(), frame.get()), "its frame is refused");
  Must(avcodec_send_frame(codec.get(), nullptr), "its frame is refused");
  Must(avcodec_receive_packet(codec.get(), packet.get()), "nothing comes out");
  return {packet->data, packet->data + packet->size};
}

// The quantizer of libavcodec whose files are about as large as those of the Independent JPEG
// Group's library, whose quality it is: that scales its tables by `scale`.
int QuantizerOf(int quality) {
  const double scale = quality < 50 ? 50.0 / quality : 2 - quality / 50.0;
  return std::clamp(static_cast<int>(std::lround(12 * scale)), 1, 31);
}

}  // namespace

std::vector<std::uint8_t> EncodePng(const Image& image) {
  return Encode(image, AV_CODEC_ID_PNG, AV_PIX_FMT_RGB24, [](AVCodecContext* codec) {
    codec->compression_level = kPngCompression;
    Must(av_opt_set(codec->priv_data, "pred", "mixed", 0), "no such prediction");
  });
}

std::vector<std::uint8_t> EncodeJpeg(const Image& image, int quality) {
  Check(quality >= 1 && quality <= 100, "the quality of a JPEG goes from 1 to 100");
  return Encode(image, AV_CODEC_ID_MJPEG, AV_PIX_FMT_YUVJ420P, [&](AVCodecContext* codec) {
    codec->flags |= AV_CODEC_FLAG_QSCALE;
    codec->qmin = 1;
    codec->global_quality = QuantizerOf(quality) * FF_QP2LAMBDA;
  });
}

std::optional<Image> DecodeImage(std::span<const std::uint8_t> bytes) {
  const AvFrame frame = Decode(bytes);
  if (!frame) return std::nullopt;
  Image image;
  internal::BgrConverter converter(true);
  if (!converter.Convert(*frame, frame->width, frame->height, &image)) return std::nullopt;
  const int orientation = Orientation(*frame);
  return orientation == 1 ? std::move(image) : Upright(image, orientation);
}

bool IsImageFile(const std::filesystem::path& path) {
  char first[16] = {};
  std::ifstream file(path, std::ios::binary);
  file.read(first, sizeof first);
  return CodecOf({first, static_cast<std::size_t>(file.gcount())}) != AV_CODEC_ID_NONE;
}

void WritePng(const std::filesystem::path& path, const Image& image) {
  const std::vector<std::uint8_t> bytes = EncodePng(image);
  WriteTextFile(path, AsText(bytes));
}

Image ReadImage(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path.string(), 0, "cannot be opened", "check the name");
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::optional<Image> image =
      DecodeImage({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  if (!image) {
    throw InputError(path.string(), 0, "the picture cannot be decoded",
                     "give a PNG or JPEG file, or leave it out");
  }
  return *std::move(image);
}

}  // namespace flocklift
