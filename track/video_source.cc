// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/video_source.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "simulate/core/check.h"
#include "track/luma_decoder.h"

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
  explicit Impl(const fs::path& path) : path_(path) {
    pictures_ = FootagePictures(path);
    if (pictures_.empty()) OpenVideo();
    if (!Decode(&ahead_)) {
      throw InputError(path.string(), 0, "no frame can be read",
                       "check that the video plays, or convert it with ffmpeg");
    }
    width_ = ahead_.cols;
    height_ = ahead_.rows;
  }

  // The next frame as OpenCV has it, valid until the next call; null after the last one.
  const cv::Mat* Next() {
    FLOCKLIFT_DCHECK(!luma_);
    is_begun_ = true;
    if (has_ahead_) {
      has_ahead_ = false;
      return &ahead_;
    }
    if (!Decode(&frame_)) return nullptr;
    CheckSize(frame_.cols, frame_.rows);
    return &frame_;
  }

  // False after the last frame.
  bool NextLuma(GrayImage* image) {
    if (StartLuma()) {
      if (!luma_->Read(image)) return false;
      CheckSize(image->width, image->height);
      return true;
    }
    const cv::Mat* frame = Next();
    if (frame == nullptr) return false;
    if (image->width != frame->cols || image->height != frame->rows) {
      *image = GrayImage(frame->cols, frame->rows);
    }
    cv::Mat gray(frame->rows, frame->cols, CV_8UC1, image->pixels.data());
    cv::cvtColor(*frame, gray, cv::COLOR_BGR2GRAY);
    return true;
  }

  bool Skip(std::int64_t frames) {
    if (StartLuma()) {
      for (; frames > 0; --frames) {
        if (!luma_->Skip()) return false;
      }
      return true;
    }
    if (frames > 0 && has_ahead_) {
      has_ahead_ = false;
      --frames;
    }
    if (!pictures_.empty()) {
      const std::size_t left = pictures_.size() - next_picture_;
      next_picture_ += std::min(left, static_cast<std::size_t>(frames));
      return left >= static_cast<std::size_t>(frames);
    }
    for (; frames > 0; --frames) {
      if (!capture_.grab()) return false;
    }
    return true;
  }

  int width() const { return width_; }
  int height() const { return height_; }
  std::optional<double> fps() const { return fps_; }
  std::optional<std::int64_t> frame_count() const {
    if (!pictures_.empty()) return static_cast<std::int64_t>(pictures_.size());
    return declared_count_;
  }

 private:
  void CheckSize(int width, int height) const {
    if (width == width_ && height == height_) return;
    throw InputError(current_.string(), 0,
                     "the frame is " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels, those before are " + std::to_string(width_) + " x " +
                         std::to_string(height_),
                     "bring all frames to one size");
  }

  // Whether luma comes straight from the codec: decided at the first frame.
  bool StartLuma() {
    if (!is_begun_ && pictures_.empty()) {
      luma_ = internal::LumaDecoder::Open(path_);
      if (luma_) capture_.release();
    }
    is_begun_ = true;
    return luma_ != nullptr;
  }

  void OpenVideo() {
    // FFmpeg's own messages would stand beside our one line.
    setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
    bool opened = false;
    try {
      opened = capture_.open(path_.string(), cv::CAP_FFMPEG);
    } catch (const cv::Exception&) {
      opened = false;
    }
    if (!opened) {
      throw InputError(path_.string(), 0, "this is no video that can be decoded",
                       "convert it with ffmpeg, for example to H.264 in .mp4");
    }
    const double fps = capture_.get(cv::CAP_PROP_FPS);
    if (std::isfinite(fps) && fps > 0) fps_ = fps;
    const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    if (std::isfinite(count) && count > 0 && count < 1e12) {
      declared_count_ = static_cast<std::int64_t>(count);
    }
  }

  bool Decode(cv::Mat* frame) {
    if (pictures_.empty()) {
      current_ = path_;
      return capture_.read(*frame) && !frame->empty();
    }
    if (next_picture_ == pictures_.size()) return false;
    current_ = pictures_[next_picture_++];
    try {
      *frame = cv::imread(current_.string(), cv::IMREAD_COLOR);
    } catch (const cv::Exception&) {
      frame->release();
    }
    if (frame->empty()) {
      throw InputError(current_.string(), 0, "the picture cannot be decoded",
                       "replace it or take it out of the sequence");
    }
    return true;
  }

  fs::path path_;
  fs::path current_;
  std::unique_ptr<internal::LumaDecoder> luma_;
  bool is_begun_ = false;  // a frame was asked for
  std::vector<fs::path> pictures_;
  std::size_t next_picture_ = 0;
  cv::VideoCapture capture_;
  cv::Mat ahead_, frame_;
  bool has_ahead_ = true;
  int width_ = 0, height_ = 0;
  std::optional<double> fps_;
  std::optional<std::int64_t> declared_count_;
};

VideoSource::VideoSource(const fs::path& path) : impl_(std::make_unique<Impl>(path)) {}
VideoSource::~VideoSource() = default;

int VideoSource::width() const { return impl_->width(); }
int VideoSource::height() const { return impl_->height(); }
std::optional<double> VideoSource::fps() const { return impl_->fps(); }
std::optional<std::int64_t> VideoSource::frame_count() const { return impl_->frame_count(); }

bool VideoSource::Read(Image* image) {
  const cv::Mat* frame = impl_->Next();
  if (frame == nullptr) return false;
  if (image->width != frame->cols || image->height != frame->rows) {
    *image = Image(frame->cols, frame->rows);
  }
  frame->copyTo(cv::Mat(frame->rows, frame->cols, CV_8UC3, image->bgr.data()));
  return true;
}

bool VideoSource::Skip(std::int64_t frames) { return impl_->Skip(frames); }

bool VideoSource::Read(GrayImage* image) { return impl_->NextLuma(image); }

}  // namespace flocklift
