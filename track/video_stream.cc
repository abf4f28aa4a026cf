// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/video_stream.h"

extern "C" {
#include <libavutil/display.h>
}

#include <algorithm>
#include <cmath>
#include <cstring>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/media/bgr_converter.h"
#include "track/spread_luma.h"

namespace flocklift::internal {
namespace {

constexpr int kMostThreads = 16;
constexpr int kMostFaults = 1000;  // one after the other, of a film that may still go on

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

// Quarter turns clockwise that the container asks for, as phones write it.
int QuarterTurns(const AVStream* stream) {
  const auto* matrix = reinterpret_cast<const std::int32_t*>(
      av_stream_get_side_data(stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
  if (matrix == nullptr) return 0;
  const double degrees = -av_display_rotation_get(matrix);
  return std::isfinite(degrees) ? ((static_cast<int>(std::lround(degrees / 90)) % 4) + 4) % 4 : 0;
}

}  // namespace

VideoStream::VideoStream(const std::filesystem::path& path, int threads) {
  const auto must = [&path](bool is_so) {
    if (is_so) return;
    throw InputError(path.string(), 0, "this is no video that can be decoded",
                     "convert it with ffmpeg, for example to H.264 in .mp4");
  };
  QuietLibav();
  AVFormatContext* input = nullptr;
  must(avformat_open_input(&input, path.c_str(), nullptr, nullptr) >= 0);
  input_.reset(input);
  must(avformat_find_stream_info(input, nullptr) >= 0);
  const AVCodec* decoder = nullptr;
  index_ = av_find_best_stream(input, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
  must(index_ >= 0 && decoder != nullptr);
  const AVStream* stream = input->streams[index_];
  codec_.reset(avcodec_alloc_context3(decoder));
  must(avcodec_parameters_to_context(codec_.get(), stream->codecpar) >= 0);
  codec_->thread_count = threads > 0 ? threads : std::min(ResolveThreads(0), kMostThreads);
  must(avcodec_open2(codec_.get(), decoder, nullptr) >= 0);
  must(codec_->width > 0 && codec_->height > 0);
  turns_ = QuarterTurns(stream);
  width_ = turns_ % 2 == 1 ? codec_->height : codec_->width;
  height_ = turns_ % 2 == 1 ? codec_->width : codec_->height;
}

std::optional<double> VideoStream::fps() const {
  AVStream* const stream = input_->streams[index_];
  // The mean where the rate varies, as phones' does.
  const double mean = av_q2d(stream->avg_frame_rate);
  const double fps = std::isfinite(mean) && mean > 0
                         ? mean
                         : av_q2d(av_guess_frame_rate(input_.get(), stream, nullptr));
  if (!std::isfinite(fps) || fps <= 0) return std::nullopt;
  return fps;
}

std::optional<std::int64_t> VideoStream::frame_count() const {
  if (const std::int64_t frames = input_->streams[index_]->nb_frames; frames > 0) return frames;
  const std::optional<double> rate = fps();
  if (!rate || input_->duration <= 0) return std::nullopt;
  const double count = *rate * static_cast<double>(input_->duration) / AV_TIME_BASE;
  if (count >= 1e12) return std::nullopt;
  return std::llround(count);
}

const AVFrame* VideoStream::Next() {
  for (int faults = 0; faults < kMostFaults;) {
    const int status = avcodec_receive_frame(codec_.get(), frame_.get());
    if (status >= 0) {
      if ((frame_->flags & AV_FRAME_FLAG_DISCARD) != 0) continue;
      return frame_.get();
    }
    if (status == AVERROR_EOF) return nullptr;
    if (status != AVERROR(EAGAIN)) {  // of one packet, behind which others may be well
      ++faults;
      continue;
    }
    if (is_drained_) return nullptr;
    if (!Feed()) {
      is_drained_ = true;
      avcodec_send_packet(codec_.get(), nullptr);
    }
  }
  return nullptr;
}

void VideoStream::Flush() {
  is_drained_ = false;
  avcodec_flush_buffers(codec_.get());
}

// Hands one packet of the stream to the codec; false when there is none.
bool VideoStream::Feed() {
  while (av_read_frame(input_.get(), packet_.get()) >= 0) {
    const bool is_ours = packet_->stream_index == index_;
    if (is_ours) avcodec_send_packet(codec_.get(), packet_.get());
    av_packet_unref(packet_.get());
    if (is_ours) return true;
  }
  return false;
}

bool ReadLuma(const AVFrame& frame, GrayImage* image) {
  if (!HasLumaPlane(frame.format)) return false;
  if (image->width != frame.width || image->height != frame.height) {
    *image = GrayImage(frame.width, frame.height);
  }
  const bool is_full = IsFullRange(frame);
  for (int v = 0; v < frame.height; ++v) {
    const std::uint8_t* from = frame.data[0] + static_cast<std::ptrdiff_t>(v) * frame.linesize[0];
    std::uint8_t* to = image->Row(v);
    if (is_full) {
      std::memcpy(to, from, static_cast<std::size_t>(frame.width));
    } else {
      SpreadLuma(from, frame.width, to);
    }
  }
  return true;
}

}  // namespace flocklift::internal
