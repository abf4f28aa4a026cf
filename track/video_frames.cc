// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/video_frames.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/media/bgr_converter.h"
#include "simulate/media/turned.h"
#include "track/video_stream.h"

namespace flocklift {

class VideoFrames::Impl {
 public:
  explicit Impl(const std::filesystem::path& path) : stream_(path) {
    MakeIndex();
    if (times_.empty()) {
      throw InputError(path.string(), 0, "the video has no frame",
                       "check that it plays, or convert it with ffmpeg");
    }
  }

  bool Read(int number, int width, int height, Image* image) {
    const auto index = static_cast<std::size_t>(number - 1);
    if (number < 1 || index >= times_.size()) return false;
    if (frame_ == nullptr || at_ != index) {
      if (!(frame_ != nullptr && at_ < index && index - at_ <= WayFromKey(index)) &&
          !SeekTo(index)) {
        return false;
      }
      do {
        if (!DecodeNext()) return false;
      } while (at_ < index);
      if (at_ != index) return false;
    }
    return Convert(width, height, image);
  }

  internal::VideoStream stream_;
  std::vector<std::int64_t> times_;  // of the frames, increasing [stream's time base]

 private:
  // The times of all frames and which of them are key frames. A file whose packets have no times
  // keeps the order in which they stand.
  void MakeIndex() {
    const internal::AvPacket packet(av_packet_alloc());
    std::vector<std::pair<std::int64_t, bool>> all;
    while (av_read_frame(stream_.input(), packet.get()) >= 0) {
      if (packet->stream_index == stream_.index() && (packet->flags & AV_PKT_FLAG_DISCARD) == 0) {
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
    if (all.empty()) return;
    if (keys_.empty() || keys_.front() != 0) keys_.insert(keys_.begin(), 0);
    Rewind();
  }

  std::size_t KeyBefore(std::size_t index) const {
    return *std::prev(std::upper_bound(keys_.begin(), keys_.end(), index));
  }
  std::size_t WayFromKey(std::size_t index) const { return index - KeyBefore(index) + 1; }

  void Forget() {
    frame_ = nullptr;
    stream_.Flush();
  }
  bool Seek(std::int64_t time, int how) {
    return av_seek_frame(stream_.input(), stream_.index(), time, how) >= 0;
  }

  bool Rewind() {
    Forget();
    decoded_ = 0;
    return Seek(std::min<std::int64_t>(0, times_.front()), AVSEEK_FLAG_BACKWARD) ||
           Seek(0, AVSEEK_FLAG_BYTE);
  }

  // To a place from which decoding gives the frame: the key frame before it, or an earlier one
  // where a decoder starts with frames that refer to what came before (open groups of pictures).
  bool SeekTo(std::size_t index) {
    if (!has_times_) return Rewind();
    std::size_t key = KeyBefore(index);
    while (true) {
      if (key == 0 && !Rewind()) return false;
      if (key > 0) {
        Forget();
        if (!Seek(times_[key], AVSEEK_FLAG_BACKWARD)) {
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
    do {
      frame_ = stream_.Next();
      if (frame_ == nullptr) return false;
    } while (!Place());
    return true;
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
    const int turns = stream_.turns();
    if (turns % 2 == 1) std::swap(width, height);
    if (!converter_.Convert(*frame_, width, height, image)) return false;
    if (turns != 0) *image = Turned(*image, turns);
    return true;
  }

  bool has_times_ = true;
  std::vector<std::size_t> keys_;   // frames that decode by themselves
  const AVFrame* frame_ = nullptr;  // the one decoded last
  bool held_ = false;
  std::size_t at_ = 0;       // its number from 0
  std::size_t decoded_ = 0;  // since the start, of a file without times
  internal::BgrConverter converter_{false};
};

VideoFrames::VideoFrames(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {}
VideoFrames::~VideoFrames() = default;
int VideoFrames::width() const { return impl_->stream_.width(); }
int VideoFrames::height() const { return impl_->stream_.height(); }
int VideoFrames::frame_count() const { return static_cast<int>(impl_->times_.size()); }
bool VideoFrames::Read(int frame, int width, int height, Image* image) {
  return impl_->Read(frame, width, height, image);
}

}  // namespace flocklift
