// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/luma_decoder.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <thread>

#include "track/spread_luma.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace flocklift::internal {
namespace {

struct CloseInput {
  void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
};
struct FreeCodec {
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
};
struct FreeFrame {
  void operator()(AVFrame* p) const { av_frame_free(&p); }
};
struct FreePacket {
  void operator()(AVPacket* p) const { av_packet_free(&p); }
};

bool HasLumaPlane(int format) {
  switch (format) {
    case AV_PIX_FMT_GRAY8:
    case AV_PIX_FMT_YUV420P:
    case AV_PIX_FMT_YUVJ420P:
    case AV_PIX_FMT_YUV422P:
    case AV_PIX_FMT_YUVJ422P:
    case AV_PIX_FMT_YUV444P:
    case AV_PIX_FMT_YUVJ444P:
    case AV_PIX_FMT_NV12:
    case AV_PIX_FMT_NV21:
      return true;
    default:
      return false;
  }
}

bool IsFullRange(const AVFrame& frame) {
  return frame.color_range == AVCOL_RANGE_JPEG || frame.format == AV_PIX_FMT_GRAY8 ||
         frame.format == AV_PIX_FMT_YUVJ420P || frame.format == AV_PIX_FMT_YUVJ422P ||
         frame.format == AV_PIX_FMT_YUVJ444P;
}

}  // namespace

class LumaDecoder::Libav {
 public:
  bool Open(const std::filesystem::path& path) {
    AVFormatContext* input = nullptr;
    if (avformat_open_input(&input, path.c_str(), nullptr, nullptr) < 0) return false;
    input_.reset(input);
    if (avformat_find_stream_info(input, nullptr) < 0) return false;
    const AVCodec* codec = nullptr;
    stream_ = av_find_best_stream(input, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (stream_ < 0 || codec == nullptr) return false;
    const AVStream& stream = *input->streams[stream_];
    if (av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr) != nullptr) {
      return false;
    }
    codec_.reset(avcodec_alloc_context3(codec));
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
    if (!codec_ || !frame_ || !packet_) return false;
    if (avcodec_parameters_to_context(codec_.get(), stream.codecpar) < 0) return false;
    if (!HasLumaPlane(codec_->pix_fmt)) return false;
    codec_->thread_count = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return avcodec_open2(codec_.get(), codec, nullptr) >= 0;
  }

  // The next frame, valid until the next call; null after the last one.
  const AVFrame* Next() {
    while (true) {
      const int status = avcodec_receive_frame(codec_.get(), frame_.get());
      if (status >= 0) return HasLumaPlane(frame_->format) ? frame_.get() : nullptr;
      if (status != AVERROR(EAGAIN) || is_flushed_) return nullptr;
      if (!Feed()) {
        is_flushed_ = true;
        avcodec_send_packet(codec_.get(), nullptr);
      }
    }
  }

 private:
  // Hands one packet of the stream to the codec; false when there is none.
  bool Feed() {
    while (av_read_frame(input_.get(), packet_.get()) >= 0) {
      const bool is_ours = packet_->stream_index == stream_;
      if (is_ours) avcodec_send_packet(codec_.get(), packet_.get());
      av_packet_unref(packet_.get());
      if (is_ours) return true;
    }
    return false;
  }

  std::unique_ptr<AVFormatContext, CloseInput> input_;
  std::unique_ptr<AVCodecContext, FreeCodec> codec_;
  std::unique_ptr<AVFrame, FreeFrame> frame_;
  std::unique_ptr<AVPacket, FreePacket> packet_;
  int stream_ = -1;
  bool is_flushed_ = false;
};

LumaDecoder::LumaDecoder(std::unique_ptr<Libav> libav) : libav_(std::move(libav)) {}
LumaDecoder::~LumaDecoder() = default;

std::unique_ptr<LumaDecoder> LumaDecoder::Open(const std::filesystem::path& path) {
  auto libav = std::make_unique<Libav>();
  if (!libav->Open(path)) return nullptr;
  return std::unique_ptr<LumaDecoder>(new LumaDecoder(std::move(libav)));
}

bool LumaDecoder::Read(GrayImage* image) {
  const AVFrame* frame = libav_->Next();
  if (frame == nullptr) return false;
  if (image->width != frame->width || image->height != frame->height) {
    *image = GrayImage(frame->width, frame->height);
  }
  const bool is_full = IsFullRange(*frame);
  for (int v = 0; v < frame->height; ++v) {
    const std::uint8_t* from = frame->data[0] + static_cast<std::ptrdiff_t>(v) * frame->linesize[0];
    std::uint8_t* to = image->Row(v);
    if (is_full) {
      std::memcpy(to, from, static_cast<std::size_t>(frame->width));
    } else {
      SpreadLuma(from, frame->width, to);
    }
  }
  return true;
}

bool LumaDecoder::Skip() { return libav_->Next() != nullptr; }

}  // namespace flocklift::internal
