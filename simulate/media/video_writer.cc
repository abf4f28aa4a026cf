// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/media/video_writer.h"

extern "C" {
#include <libavutil/opt.h>
}

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "simulate/core/options.h"
#include "simulate/media/libav.h"
#include "simulate/media/yuv420.h"

namespace flocklift {
namespace {

constexpr std::size_t kQueueLength = 3;  // pictures that may wait for the encoder

struct FreeMuxer {
  void operator()(AVFormatContext* p) const {
    if (p->pb != nullptr) avio_closep(&p->pb);
    avformat_free_context(p);
  }
};

const AVCodec* FindEncoder(const std::string& name) {
  if (!name.empty()) {
    const AVCodec* codec = avcodec_find_encoder_by_name(name.c_str());
    Check(codec != nullptr, "option encoder: libavcodec has no encoder " + name);
    return codec;
  }
  const AVCodec* codec = avcodec_find_encoder_by_name("libx264");
  return codec != nullptr ? codec : avcodec_find_encoder(AV_CODEC_ID_MPEG4);
}

void CheckPreset(const std::string& preset) {
  for (const char* known : {"ultrafast", "superfast", "veryfast", "faster", "fast", "medium",
                            "slow", "slower", "veryslow", "placebo"}) {
    if (preset == known) return;
  }
  Check(false, "option preset is " + preset + ", it goes from ultrafast to veryslow");
}

int EvenAbove(int size) { return size + size % 2; }

}  // namespace

FrameRate FrameRate::Nearest(double fps) {
  Check(fps > 0 && fps < 1e6, "frame rate is " + std::to_string(fps) + ", it must be positive");
  const AVRational ratio = av_d2q(fps, 1'000'000);
  Check(ratio.num > 0, "frame rate is " + std::to_string(fps) + ", too small for a film");
  return {ratio.num, ratio.den};
}

// The libav objects of one file, and the thread that feeds them.
class VideoWriter::Encoder {
 public:
  Encoder(const std::filesystem::path& path, int width, int height, double fps,
          const VideoOptions& options)
      : path_(path), file_(path), width_(width), height_(height) {
    internal::QuietLibav();
    OpenCodec(FrameRate::Nearest(fps), options);
    OpenMuxer();
    thread_ = std::thread([this] { Run(); });
  }

  ~Encoder() {
    {
      const std::lock_guard lock(mutex_);
      queue_.clear();  // nobody wants an unfinished film
    }
    Close();
    if (thread_.joinable()) thread_.join();
  }

  void Write(Image image) {
    Check(image.width == width_ && image.height == height_,
          "a picture of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
              " in a film of " + std::to_string(width_) + " x " + std::to_string(height_));
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return queue_.size() < kQueueLength || failure_; });
    if (failure_) std::rethrow_exception(failure_);
    Check(!closed_, "a picture after the end of the film");
    queue_.push_back(std::move(image));
    changed_.notify_all();
  }

  void Finish() {
    Close();
    if (thread_.joinable()) thread_.join();
    if (failure_) std::rethrow_exception(failure_);
    Encode(nullptr);
    Must(av_write_trailer(muxer_.get()), "cannot finish");
    Must(avio_closep(&muxer_->pb), "cannot write");
    file_.Commit();
  }

 private:
  void Must(int status, const std::string& what) const {
    if (status >= 0) return;
    char text[AV_ERROR_MAX_STRING_SIZE] = {};
    av_strerror(status, text, sizeof text);
    throw std::runtime_error(path_.string() + ": " + what + ": " + text);
  }

  void OpenCodec(FrameRate fps, const VideoOptions& options) {
    const AVCodec* codec = FindEncoder(options.encoder);
    if (codec == nullptr) {
      throw std::runtime_error(path_.string() + ": libavcodec has neither libx264 nor mpeg4");
    }
    codec_.reset(avcodec_alloc_context3(codec));
    AVCodecContext* c = codec_.get();
    c->width = EvenAbove(width_);
    c->height = EvenAbove(height_);
    c->pix_fmt = AV_PIX_FMT_YUV420P;
    c->color_range = AVCOL_RANGE_MPEG;
    c->colorspace = AVCOL_SPC_SMPTE170M;
    c->framerate = {fps.numerator, fps.denominator};
    c->time_base = {fps.denominator, fps.numerator};
    c->thread_count = options.threads;
    c->flags |= AV_CODEC_FLAG_BITEXACT | AV_CODEC_FLAG_GLOBAL_HEADER;
    if (codec->id == AV_CODEC_ID_H264) {
      Must(av_opt_set(c->priv_data, "preset", options.preset.c_str(), 0), "option preset");
      Must(av_opt_set_int(c->priv_data, "crf", options.crf, 0), "option crf");
      // Macroblock trees read memory that nobody wrote (x264 164 with AVX-512) and differ between
      // instruction sets: without them the same frames give the same bytes.
      Must(av_opt_set_int(c->priv_data, "mbtree", 0, 0), "option mbtree");
    } else {
      c->flags |= AV_CODEC_FLAG_QSCALE;
      c->global_quality = 2 * FF_QP2LAMBDA;
      c->gop_size = 60;
      if (c->time_base.den > 65535) c->time_base = av_inv_q(av_d2q(av_q2d(c->framerate), 65535));
    }
    Must(avcodec_open2(c, codec, nullptr), std::string("encoder ") + codec->name);

    frame_.reset(av_frame_alloc());
    frame_->format = c->pix_fmt;
    frame_->width = c->width;
    frame_->height = c->height;
    Must(av_frame_get_buffer(frame_.get(), 0), "out of memory");
    packet_.reset(av_packet_alloc());
  }

  void OpenMuxer() {
    const std::string name = file_.temporary().string();
    AVFormatContext* muxer = nullptr;
    Must(avformat_alloc_output_context2(&muxer, nullptr, "mp4", name.c_str()), "no mp4 writer");
    muxer_.reset(muxer);
    muxer->flags |= AVFMT_FLAG_BITEXACT;
    stream_ = avformat_new_stream(muxer, nullptr);
    Must(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "stream");
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = codec_->framerate;
    Must(avio_open(&muxer->pb, name.c_str(), AVIO_FLAG_WRITE), "cannot write");
    AVDictionary* settings = nullptr;
    av_dict_set(&settings, "movflags", "+faststart", 0);
    const int status = avformat_write_header(muxer, &settings);
    av_dict_free(&settings);
    Must(status, "cannot write");
  }

  void Close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

  // The thread: takes pictures from the queue until it is closed and empty.
  void Run() {
    try {
      for (;;) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return closed_ || !queue_.empty(); });
        if (queue_.empty()) return;
        const Image image = std::move(queue_.front());
        queue_.pop_front();
        changed_.notify_all();
        lock.unlock();
        Convert(image);
        Encode(frame_.get());
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
      changed_.notify_all();
    }
  }

  void Convert(const Image& image) {
    Must(av_frame_make_writable(frame_.get()), "out of memory");
    Yuv420View view;
    for (int k = 0; k < 3; ++k) {
      view.plane[k] = frame_->data[k];
      view.stride[k] = frame_->linesize[k];
    }
    ConvertToYuv420(image, view);
    frame_->pts = frames_++;
  }

  // Null flushes the frames that the encoder still holds.
  void Encode(const AVFrame* frame) {
    Must(avcodec_send_frame(codec_.get(), frame), "cannot encode");
    for (;;) {
      const int status = avcodec_receive_packet(codec_.get(), packet_.get());
      if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return;
      Must(status, "cannot encode");
      if (packet_->duration == 0) packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      Must(av_interleaved_write_frame(muxer_.get(), packet_.get()), "cannot write");
    }
  }

  std::filesystem::path path_;
  AtomicFile file_;
  int width_, height_;
  internal::AvCodec codec_;
  std::unique_ptr<AVFormatContext, FreeMuxer> muxer_;
  internal::AvFrame frame_;
  internal::AvPacket packet_;
  AVStream* stream_ = nullptr;  // owned by muxer_
  std::int64_t frames_ = 0;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Image> queue_;
  bool closed_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

VideoWriter::VideoWriter(const std::filesystem::path& path, int width, int height, double fps,
                         const VideoOptions& options) {
  Check(width > 0 && height > 0, "a film needs a positive size");
  CheckOptions(options);
  CheckPreset(options.preset);
  encoder_ = std::make_unique<Encoder>(path, width, height, fps, options);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::Write(Image image) {
  Check(encoder_ != nullptr, "a picture after the end of the film");
  encoder_->Write(std::move(image));
}

void VideoWriter::Finish() {
  Check(encoder_ != nullptr, "the film is finished already");
  const std::unique_ptr<Encoder> encoder = std::move(encoder_);
  encoder->Finish();
}

}  // namespace flocklift
