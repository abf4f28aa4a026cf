// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/video_frames.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

template <typename T, void (*Free)(T**)>
struct Freer {
  void operator()(T* p) const { Free(&p); }
};
using Format = std::unique_ptr<AVFormatContext, Freer<AVFormatContext, avformat_close_input>>;
using Codec = std::unique_ptr<AVCodecContext, Freer<AVCodecContext, avcodec_free_context>>;
using Packet = std::unique_ptr<AVPacket, Freer<AVPacket, av_packet_free>>;
using Frame = std::unique_ptr<AVFrame, Freer<AVFrame, av_frame_free>>;
struct SwsFreer {
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
using Scaler = std::unique_ptr<SwsContext, SwsFreer>;

// Quarter turns clockwise that the container asks for, as phones write it.
int QuarterTurns(const AVStream* stream) {
  const auto* matrix = reinterpret_cast<const std::int32_t*>(
      av_stream_get_side_data(stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
  if (matrix == nullptr) return 0;
  const double degrees = -av_display_rotation_get(matrix);
  return std::isfinite(degrees) ? ((static_cast<int>(std::lround(degrees / 90)) % 4) + 4) % 4 : 0;
}

Image Turned(const Image& from, int quarters) {
  if (quarters == 0) return from;
  const bool swaps = quarters % 2 == 1;
  Image to(swaps ? from.height : from.width, swaps ? from.width : from.height);
  for (int v = 0; v < from.height; ++v) {
    for (int u = 0; u < from.width; ++u) {
      const int x = quarters == 1 ? from.height - 1 - v : quarters == 2 ? from.width - 1 - u : v;
      const int y = quarters == 1 ? u : quarters == 2 ? from.height - 1 - v : from.width - 1 - u;
      std::copy_n(from.Row(v) + 3 * u, 3, to.Row(y) + 3 * x);
    }
  }
  return to;
}

}  // namespace

class VideoFrames::Impl {
 public:
  explicit Impl(const std::filesystem::path& path) : path_(path) {
    av_log_set_level(AV_LOG_QUIET);
    AVFormatContext* format = nullptr;
    if (avformat_open_input(&format, path.c_str(), nullptr, nullptr) < 0) Fail();
    format_.reset(format);
    if (avformat_find_stream_info(format, nullptr) < 0) Fail();
    const AVCodec* decoder = nullptr;
    stream_ = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
    if (stream_ < 0 || decoder == nullptr) Fail();
    AVStream* stream = format->streams[stream_];
    codec_.reset(avcodec_alloc_context3(decoder));
    if (avcodec_parameters_to_context(codec_.get(), stream->codecpar) < 0) Fail();
    codec_->thread_count = 0;
    if (avcodec_open2(codec_.get(), decoder, nullptr) < 0) Fail();
    turns_ = QuarterTurns(stream);
    width_ = codec_->width;
    height_ = codec_->height;
    if (turns_ % 2 == 1) std::swap(width_, height_);
    MakeIndex();
    if (times_.empty() || width_ <= 0 || height_ <= 0) Fail();
  }

  bool Read(int number, int width, int height, Image* image) {
    const auto index = static_cast<std::size_t>(number - 1);
    if (number < 1 || index >= times_.size()) return false;
    if (!frame_there_ || at_ != index) {
      if (!(frame_there_ && at_ < index && index - at_ <= WayFromKey(index)) && !SeekTo(index)) {
        return false;
      }
      do {
        if (!DecodeNext()) return false;
      } while (at_ < index);
      if (at_ != index) return false;
    }
    return Convert(width, height, image);
  }

  int width_ = 0, height_ = 0;
  std::vector<std::int64_t> times_;  // of the frames, increasing [stream's time base]

 private:
  [[noreturn]] void Fail() const {
    throw InputError(path_.string(), 0, "this is no video that can be decoded",
                     "convert it with ffmpeg, for example to H.264 in .mp4");
  }

  // The times of all frames and which of them are key frames. A file whose packets have no times
  // keeps the order in which they stand.
  void MakeIndex() {
    const Packet packet(av_packet_alloc());
    std::vector<std::pair<std::int64_t, bool>> all;
    while (av_read_frame(format_.get(), packet.get()) >= 0) {
      if (packet->stream_index == stream_ && (packet->flags & AV_PKT_FLAG_DISCARD) == 0) {
        const std::int64_t time = packet->pts != AV_NOPTS_VALUE ? packet->pts : packet->dts;
        has_times_ = has_times_ && time != AV_NOPTS_VALUE;
        all.emplace_back(time, (packet->flags & AV_PKT_FLAG_KEY) != 0);
      }
      av_packet_unref(packet.get());
    }
    if (has_times_) std::sort(all.begin(), all.end());
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k].second) keys_.push_back(k);
      times_.push_back(has_times_ ? all[k].first : static_cast<std::int64_t>(k));
    }
    if (keys_.empty() || keys_.front() != 0) keys_.insert(keys_.begin(), 0);
    Rewind();
  }

  std::size_t KeyBefore(std::size_t index) const {
    return *std::prev(std::upper_bound(keys_.begin(), keys_.end(), index));
  }
  std::size_t WayFromKey(std::size_t index) const { return index - KeyBefore(index) + 1; }

  bool Rewind() {
    frame_there_ = false;
    drains_ = false;
    decoded_ = 0;
    avcodec_flush_buffers(codec_.get());
    return av_seek_frame(format_.get(), stream_, std::min<std::int64_t>(0, times_.front()),
                         AVSEEK_FLAG_BACKWARD) >= 0 ||
           av_seek_frame(format_.get(), stream_, 0, AVSEEK_FLAG_BYTE) >= 0;
  }

  // To a place from which decoding gives the frame: the key frame before it, or an earlier one
  // where a decoder starts with frames that refer to what came before (open groups of pictures).
  bool SeekTo(std::size_t index) {
    if (!has_times_) return Rewind();
    std::size_t key = KeyBefore(index);
    while (true) {
      if (key == 0 && !Rewind()) return false;
      if (key > 0) {
        frame_there_ = false;
        drains_ = false;
        avcodec_flush_buffers(codec_.get());
        if (av_seek_frame(format_.get(), stream_, times_[key], AVSEEK_FLAG_BACKWARD) < 0) {
          key = 0;
          continue;
        }
      }
      if (!DecodeNext()) return false;
      if (at_ <= index) break;
      if (key == 0) return false;
      key = KeyBefore(key - 1);
    }
    // The caller decodes the next one: let it begin with the one that is here.
    held_ = true;
    return true;
  }

  bool DecodeNext() {
    if (held_) {
      held_ = false;
      return true;
    }
    const Packet packet(av_packet_alloc());
    while (true) {
      const int got = avcodec_receive_frame(codec_.get(), frame_.get());
      if (got == 0) {
        if ((frame_->flags & AV_FRAME_FLAG_DISCARD) != 0) continue;
        if (!Place()) continue;
        frame_there_ = true;
        return true;
      }
      if (got != AVERROR(EAGAIN) || drains_) return false;
      if (av_read_frame(format_.get(), packet.get()) < 0) {
        drains_ = true;
        avcodec_send_packet(codec_.get(), nullptr);
        continue;
      }
      // A packet that is damaged costs its frame, not the rest of the film.
      if (packet->stream_index == stream_) avcodec_send_packet(codec_.get(), packet.get());
      av_packet_unref(packet.get());
    }
  }

  // Which frame the decoded one is; false for one that the index does not have.
  bool Place() {
    if (!has_times_) {
      at_ = decoded_++;
      return at_ < times_.size();
    }
    const std::int64_t time =
        frame_->pts != AV_NOPTS_VALUE ? frame_->pts : frame_->best_effort_timestamp;
    const auto found = std::lower_bound(times_.begin(), times_.end(), time);
    if (found == times_.end() || *found != time) return false;
    at_ = static_cast<std::size_t>(found - times_.begin());
    return true;
  }

  bool Convert(int width, int height, Image* image) {
    if (turns_ % 2 == 1) std::swap(width, height);
    scaler_.reset(sws_getCachedContext(scaler_.release(), frame_->width, frame_->height,
                                       static_cast<AVPixelFormat>(frame_->format), width, height,
                                       AV_PIX_FMT_BGR24, SWS_AREA, nullptr, nullptr, nullptr));
    if (!scaler_) return false;
    *image = Image(width, height);
    // The scaler writes whole vectors past the end of a row, hence a row of its own to spare.
    const int stride = (3 * width + 63) / 64 * 64;
    std::vector<std::uint8_t> padded(static_cast<std::size_t>(stride) * (height + 1));
    std::uint8_t* rows[4] = {padded.data(), nullptr, nullptr, nullptr};
    const int strides[4] = {stride, 0, 0, 0};
    if (sws_scale(scaler_.get(), frame_->data, frame_->linesize, 0, frame_->height, rows,
                  strides) != height) {
      return false;
    }
    for (int v = 0; v < height; ++v) {
      std::copy_n(padded.data() + static_cast<std::size_t>(stride) * v, 3 * width, image->Row(v));
    }
    *image = Turned(*image, turns_);
    return true;
  }

  std::filesystem::path path_;
  Format format_;
  Codec codec_;
  int stream_ = -1;
  int turns_ = 0;  // quarters, clockwise
  bool has_times_ = true;
  std::vector<std::size_t> keys_;  // frames that decode by themselves
  Frame frame_{av_frame_alloc()};  // the one decoded last
  bool frame_there_ = false, held_ = false, drains_ = false;
  std::size_t at_ = 0;       // its number from 0
  std::size_t decoded_ = 0;  // since the start, of a file without times
  Scaler scaler_;
};

VideoFrames::VideoFrames(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {}
VideoFrames::~VideoFrames() = default;
int VideoFrames::width() const { return impl_->width_; }
int VideoFrames::height() const { return impl_->height_; }
int VideoFrames::frame_count() const { return static_cast<int>(impl_->times_.size()); }
bool VideoFrames::Read(int frame, int width, int height, Image* image) {
  return impl_->Read(frame, width, height, image);
}

}  // namespace flocklift
