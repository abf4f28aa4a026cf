// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/video_source.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/media/bgr_converter.h"
#include "simulate/media/image_codec.h"
#include "simulate/media/turned.h"
#include "track/video_stream.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFootageMend =
    "give a video file, a pattern such as img_%04d.png, or a folder of pictures";

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

bool IsPicture(const fs::path& path) {
  static constexpr const char* kExtensions[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff",
                                                ".bmp", ".pgm", ".ppm",  ".webp"};
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(std::begin(kExtensions), std::end(kExtensions), extension) !=
         std::end(kExtensions);
}

std::vector<fs::path> PicturesOfFolder(const fs::path& folder) {
  std::vector<fs::path> pictures;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && IsPicture(entry.path())) pictures.push_back(entry.path());
  }
  if (pictures.empty()) {
    throw InputError(folder.string(), 0, "the folder holds no picture", kFootageMend);
  }
  std::sort(pictures.begin(), pictures.end(), [](const fs::path& a, const fs::path& b) {
    return NaturalLess(a.filename().string(), b.filename().string());
  });
  return pictures;
}

// A file name with one %d or %0Nd in it.
struct Pattern {
  std::string before, after;
  std::size_t digits = 0;  // at least so many
};

std::optional<Pattern> ParsePattern(const std::string& name) {
  const std::size_t percent = name.find('%');
  if (percent == std::string::npos) return std::nullopt;
  std::size_t end = percent + 1;
  while (end < name.size() && IsDigit(name[end])) ++end;
  if (end >= name.size() || name[end] != 'd' || end - percent > 3) return std::nullopt;
  const std::string width = name.substr(percent + 1, end - percent - 1);
  return Pattern{name.substr(0, percent), name.substr(end + 1),
                 width.empty() ? 1 : static_cast<std::size_t>(std::stoi(width))};
}

std::vector<fs::path> PicturesOfPattern(const fs::path& path, const Pattern& pattern) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::map<unsigned long long, fs::path> numbered;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(pattern.before) || !name.ends_with(pattern.after)) continue;
    if (name.size() < pattern.before.size() + pattern.after.size() + pattern.digits) continue;
    const std::string number = name.substr(
        pattern.before.size(), name.size() - pattern.before.size() - pattern.after.size());
    if (number.size() > 18 || !std::all_of(number.begin(), number.end(), IsDigit)) continue;
    numbered.emplace(std::stoull(number), entry.path());
  }
  if (numbered.empty()) {
    throw InputError(path.string(), 0, "no file matches the pattern", kFootageMend);
  }
  std::vector<fs::path> pictures;
  for (const auto& [number, picture] : numbered) pictures.push_back(picture);
  return pictures;
}

}  // namespace

std::vector<fs::path> FootagePictures(const fs::path& path) {
  if (const auto pattern = ParsePattern(path.filename().string())) {
    return PicturesOfPattern(path, *pattern);
  }
  if (!fs::exists(path)) throw InputError(path.string(), 0, "no such file", kFootageMend);
  if (fs::is_directory(path)) return PicturesOfFolder(path);
  if (fs::is_regular_file(path) && fs::file_size(path) == 0) {
    throw InputError(path.string(), 0, "the file is empty", kFootageMend);
  }
  if (IsPicture(path)) {
    throw InputError(path.string(), 0, "this is one picture, not footage",
                     "give the folder that holds it, or a pattern such as img_%04d.png");
  }
  return {};
}

bool NaturalLess(std::string_view a, std::string_view b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (IsDigit(a[i]) && IsDigit(b[j])) {
      const auto run = [](std::string_view s, std::size_t& k) {
        while (k < s.size() && s[k] == '0') ++k;
        const std::size_t first = k;
        while (k < s.size() && IsDigit(s[k])) ++k;
        return s.substr(first, k - first);
      };
      const std::string_view x = run(a, i), y = run(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if ((i < a.size()) != (j < b.size())) return j < b.size();
  return a < b;  // equal but for leading zeros
}

class VideoSource::Impl {
 public:
  explicit Impl(const fs::path& path) : path_(path), pictures_(FootagePictures(path)) {
    if (pictures_.empty()) {
      stream_.emplace(path);
      ahead_ = stream_->Next();
      if (ahead_ == nullptr) {
        throw InputError(path.string(), 0, "no frame can be read",
                         "check that the video plays, or convert it with ffmpeg");
      }
      SetSize(stream_->turns(), ahead_->width, ahead_->height);
    } else {
      picture_ = DecodePicture();
      SetSize(0, picture_->width, picture_->height);
    }
  }

  bool Read(Image* image) {
    if (!stream_) return NextPicture(image);
    const AVFrame* frame = NextFrame();
    return frame != nullptr && Convert(*frame, image);
  }

  bool Read(GrayImage* image) {
    if (stream_) {
      const AVFrame* frame = NextFrame();
      if (frame == nullptr) return false;
      if (stream_->turns() == 0 && internal::ReadLuma(*frame, image)) return true;
      if (!Convert(*frame, &colours_)) return false;
    } else if (!NextPicture(&colours_)) {
      return false;
    }
    if (image->width != width_ || image->height != height_) *image = GrayImage(width_, height_);
    const cv::Mat bgr(height_, width_, CV_8UC3, colours_.bgr.data());
    cv::cvtColor(bgr, cv::Mat(height_, width_, CV_8UC1, image->pixels.data()), cv::COLOR_BGR2GRAY);
    return true;
  }

  bool Skip(std::int64_t frames) {
    if (stream_) {
      for (; frames > 0; --frames) {
        if (NextFrame() == nullptr) return false;
      }
      return true;
    }
    if (frames > 0 && picture_) {
      picture_.reset();
      --frames;
    }
    const std::size_t left = pictures_.size() - next_picture_;
    next_picture_ += std::min(left, static_cast<std::size_t>(frames));
    return left >= static_cast<std::size_t>(frames);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  std::optional<double> fps() const { return stream_ ? stream_->fps() : std::nullopt; }
  std::optional<std::int64_t> frame_count() const {
    return stream_ ? stream_->frame_count() : static_cast<std::int64_t>(pictures_.size());
  }

 private:
  void SetSize(int turns, int width, int height) {
    width_ = turns % 2 == 1 ? height : width;
    height_ = turns % 2 == 1 ? width : height;
  }

  void CheckSize(const fs::path& path, int width, int height) const {
    if (width == width_ && height == height_) return;
    throw InputError(path.string(), 0,
                     "the frame is " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels, those before are " + std::to_string(width_) + " x " +
                         std::to_string(height_),
                     "bring all frames to one size");
  }

  // The next frame of the film, valid until the next call; null after the last one.
  const AVFrame* NextFrame() {
    const AVFrame* frame = ahead_ != nullptr ? ahead_ : stream_->Next();
    ahead_ = nullptr;
    if (frame == nullptr) return nullptr;
    const bool swaps = stream_->turns() % 2 == 1;
    CheckSize(path_, swaps ? frame->height : frame->width, swaps ? frame->width : frame->height);
    return frame;
  }

  bool Convert(const AVFrame& frame, Image* image) {
    if (!converter_.Convert(frame, frame.width, frame.height, image)) return false;
    if (stream_->turns() != 0) *image = Turned(*image, stream_->turns());
    return true;
  }

  Image DecodePicture() {
    try {
      return ReadImage(pictures_[next_picture_++]);
    } catch (const InputError&) {
      throw InputError(pictures_[next_picture_ - 1].string(), 0, "the picture cannot be decoded",
                       "replace it or take it out of the sequence");
    }
  }

  bool NextPicture(Image* image) {
    if (!picture_) {
      if (next_picture_ == pictures_.size()) return false;
      picture_ = DecodePicture();
      CheckSize(pictures_[next_picture_ - 1], picture_->width, picture_->height);
    }
    *image = *std::move(picture_);
    picture_.reset();
    return true;
  }

  fs::path path_;
  std::vector<fs::path> pictures_;
  std::size_t next_picture_ = 0;
  std::optional<Image> picture_;  // decoded ahead of its turn
  std::optional<internal::VideoStream> stream_;
  const AVFrame* ahead_ = nullptr;  // likewise
  internal::BgrConverter converter_{false};
  Image colours_;
  int width_ = 0, height_ = 0;
};

VideoSource::VideoSource(const fs::path& path) : impl_(std::make_unique<Impl>(path)) {}
VideoSource::~VideoSource() = default;

int VideoSource::width() const { return impl_->width(); }
int VideoSource::height() const { return impl_->height(); }
std::optional<double> VideoSource::fps() const { return impl_->fps(); }
std::optional<std::int64_t> VideoSource::frame_count() const { return impl_->frame_count(); }
bool VideoSource::Read(Image* image) { return impl_->Read(image); }
bool VideoSource::Read(GrayImage* image) { return impl_->Read(image); }
bool VideoSource::Skip(std::int64_t frames) { return impl_->Skip(frames); }

}  // namespace flocklift
