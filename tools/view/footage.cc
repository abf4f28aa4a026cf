// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/footage.h"

#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/media/image_codec.h"
#include "track/video_frames.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

constexpr int kQuality = 88;
constexpr std::size_t kKeptBytes = 96 << 20;

Image Resized(const Image& from, int width, int height) {
  if (from.width == width && from.height == height) return from;
  Image to(width, height);
  const cv::Mat source(from.height, from.width, CV_8UC3,
                       const_cast<std::uint8_t*>(from.bgr.data()));
  cv::Mat target(height, width, CV_8UC3, to.bgr.data());
  cv::resize(source, target, target.size(), 0, 0, cv::INTER_AREA);
  return to;
}

}  // namespace

class Footage::Impl {
 public:
  explicit Impl(const std::filesystem::path& path) {
    pictures_ = FootagePictures(path);
    if (pictures_.empty()) {
      video_.emplace(path);
      file_ = path;
      width_ = video_->width();
      height_ = video_->height();
      frame_count_ = video_->frame_count();
      return;
    }
    const Image first = ReadImage(pictures_.front());
    width_ = first.width;
    height_ = first.height;
    frame_count_ = static_cast<int>(pictures_.size());
  }

  std::string Jpeg(int frame, int widest) {
    if (frame < 1 || frame > frame_count_ || widest < 16) return {};
    const int width = std::min(width_, widest);
    const int height =
        std::max(1, static_cast<int>(std::lround(static_cast<double>(height_) * width / width_)));
    const std::lock_guard lock(mutex_);
    const std::pair key{frame, width};
    if (const auto found = kept_.find(key); found != kept_.end()) {
      order_.splice(order_.begin(), order_, found->second.place);
      return found->second.jpeg;
    }
    Image image;
    if (video_) {
      if (!video_->Read(frame, width, height, &image)) return {};
    } else {
      image = Resized(ReadImage(pictures_[static_cast<std::size_t>(frame - 1)]), width, height);
    }
    const std::vector<std::uint8_t> bytes = EncodeJpeg(image, kQuality);
    std::string jpeg(bytes.begin(), bytes.end());
    Keep(key, jpeg);
    return jpeg;
  }

  int width_ = 0, height_ = 0, frame_count_ = 0;
  std::filesystem::path file_;

 private:
  using Key = std::pair<int, int>;  // frame, width
  struct Kept {
    std::string jpeg;
    std::list<Key>::iterator place;
  };

  void Keep(const Key& key, const std::string& jpeg) {
    order_.push_front(key);
    kept_[key] = {jpeg, order_.begin()};
    bytes_ += jpeg.size();
    while (bytes_ > kKeptBytes && order_.size() > 1) {
      const auto oldest = kept_.find(order_.back());
      bytes_ -= oldest->second.jpeg.size();
      kept_.erase(oldest);
      order_.pop_back();
    }
  }

  std::mutex mutex_;
  std::optional<VideoFrames> video_;
  std::vector<std::filesystem::path> pictures_;
  std::list<Key> order_;  // most lately asked for first
  std::map<Key, Kept> kept_;
  std::size_t bytes_ = 0;
};

Footage::Footage(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {}
Footage::~Footage() = default;
int Footage::width() const { return impl_->width_; }
int Footage::height() const { return impl_->height_; }
int Footage::frame_count() const { return impl_->frame_count_; }
const std::filesystem::path& Footage::file() const { return impl_->file_; }
std::string Footage::Jpeg(int frame, int widest) { return impl_->Jpeg(frame, widest); }

}  // namespace flocklift
