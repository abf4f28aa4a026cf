// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/detect/detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/text.h"
#include "track/detect/background.h"
#include "track/detect/components.h"
#include "track/detect/gray_view.h"
#include "track/detect/patch_blobs.h"

namespace flocklift {
namespace {

constexpr double kLeastNoise = 0.7;         // [grey levels]: 8-bit pictures have no less
constexpr double kLeastOutlier = 2;         // [grey levels]
constexpr double kOutlierContrast = 0.1;    // a cell that differs by so much of the usual contrast
constexpr double kLowOverHigh = 0.5;        // hysteresis
constexpr double kWindowOverLength = 3;     // of the local mean, to the usual length
constexpr double kLongestOverWindow = 1.2;  // a longer blob is no animal
constexpr double kFirstWindowOverHeight = 1.0 / 8;
constexpr std::size_t kRemembered = 600;    // blobs
constexpr std::size_t kPolarityStride = 3;  // of the frames to learn from

void Fit(int width, int height, GrayImage* image) {
  if (image->width != width || image->height != height) *image = GrayImage(width, height);
}

// mask = 255 where the image passes the threshold, 0 elsewhere; `limit` is scratch.
void MarkContrast(const GrayImage& image, const LocalBackground& background, bool dark,
                  const std::vector<float>& threshold, GrayImage* limit, GrayImage* mask) {
  cv::Mat coarse(background.height, background.width, CV_8UC1);
  for (std::size_t k = 0; k < threshold.size(); ++k) {
    const float value = dark ? std::ceil(background.level[k] - threshold[k])
                             : std::floor(background.level[k] + threshold[k]);
    coarse.data[k] = static_cast<std::uint8_t>(std::clamp(value, 0.0f, 255.0f));
  }
  const int width = background.width * background.step;  // reaches beyond the image
  const int height = background.height * background.step;
  Fit(width, height, limit);
  Fit(image.width, image.height, mask);
  cv::Mat limit_view = View(*limit), mask_view = View(*mask);
  cv::resize(coarse, limit_view, limit_view.size(), 0, 0, cv::INTER_LINEAR);
  cv::compare(View(image), limit_view(cv::Rect(0, 0, image.width, image.height)), mask_view,
              dark ? cv::CMP_LT : cv::CMP_GT);
}

// "left,top,width,height;...".
std::vector<Box> ParseBoxes(const std::string& text) {
  std::vector<Box> boxes;
  std::string_view rest = text;
  while (!Trim(rest).empty()) {
    const std::size_t end = rest.find(';');
    std::string_view one = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    std::array<double, 4> values{};
    std::size_t count = 0;
    bool is_good = true;
    while (is_good) {
      const std::size_t comma = one.find(',');
      const std::optional<double> value = ParseReal(Trim(one.substr(0, comma)));
      is_good = value && count < values.size();
      if (is_good) values[count++] = *value;
      if (comma == std::string_view::npos) break;
      one.remove_prefix(comma + 1);
    }
    Check(is_good && count == values.size() && values[2] > 0 && values[3] > 0,
          "option ignore is " + text + ", allowed are left,top,width,height;...");
    boxes.push_back({values[0], values[1], values[2], values[3]});
  }
  return boxes;
}

// Value at which `share` of the mass is reached.
template <typename Get>
double MassQuantile(std::vector<std::pair<double, double>>* scratch, double share, const Get& get) {
  scratch->clear();
  get(scratch);
  std::sort(scratch->begin(), scratch->end());
  double total = 0, sum = 0;
  for (const auto& [value, mass] : *scratch) total += mass;
  for (const auto& [value, mass] : *scratch) {
    sum += mass;
    if (sum >= share * total) return value;
  }
  return 0;
}

}  // namespace

Detector::Detector(const DetectorOptions& options) : options_(options), scratch_(1) {
  CheckOptions(options);
  const std::string& p = options.polarity;
  Check(p == "auto" || p == "dark" || p == "bright" || p == "both",
        "option polarity is " + p + ", allowed are dark, bright, both and auto");
  dark_ = p != "bright";
  bright_ = p == "bright" || p == "both";
  ignored_ = ParseBoxes(options.ignore);
}

double Detector::Window(int image_height) const {
  const double widest = std::max(16.0, kFirstWindowOverHeight * image_height);
  if (options_.window > 0) return options_.window;
  if (usual_length_ <= 0) return widest;
  return std::clamp(kWindowOverLength * usual_length_, std::min(24.0, widest), widest);
}

void Detector::Learn(std::span<const GrayImage> images, ThreadPool* pool) {
  if (options_.polarity == "auto" && still_.empty()) LearnPolarity(images, pool);
  DetectAll(0, images, pool);
}

// The sign that has more to it.
void Detector::LearnPolarity(std::span<const GrayImage> images, ThreadPool* pool) {
  const std::size_t looks = 2 * ((images.size() + kPolarityStride - 1) / kPolarityStride);
  while (scratch_.size() < looks) scratch_.emplace_back();
  std::vector<double> energies(looks, 0);  // dark, bright, dark, ...
  pool->For(0, static_cast<std::int64_t>(looks), 1, [&](std::int64_t k, std::int64_t) {
    BlobFrame found;
    FindBlobs(images[static_cast<std::size_t>(k) / 2 * kPolarityStride], k % 2 == 0, &scratch_[k],
              &found);
    for (const Blob& blob : found.blobs) energies[k] += blob.peak * blob.peak;
  });
  double dark_energy = 0, bright_energy = 0;
  for (std::size_t k = 0; k < looks; ++k) (k % 2 == 0 ? dark_energy : bright_energy) += energies[k];
  dark_ = dark_energy >= bright_energy;
  bright_ = !dark_;
}

BlobFrame Detector::Detect(int frame, const GrayImage& image) {
  BlobFrame found = Find(frame, image, &scratch_.front());
  Remember(found);
  return found;
}

std::vector<BlobFrame> Detector::DetectAll(int first_frame, std::span<const GrayImage> images,
                                           ThreadPool* pool) {
  std::vector<BlobFrame> all(images.size());
  for (std::size_t done = 0; done < images.size();) {
    const std::size_t count =
        std::min(images.size() - done, static_cast<std::size_t>(FramesToSummary()));
    while (scratch_.size() < count) scratch_.emplace_back();
    pool->For(0, static_cast<std::int64_t>(count), 1, [&](std::int64_t k, std::int64_t) {
      const std::size_t at = done + static_cast<std::size_t>(k);
      all[at] = Find(first_frame + static_cast<int>(at), images[at], &scratch_[k]);
    });
    for (const std::size_t end = done + count; done < end; ++done) Remember(all[done]);
    if (frames_since_summary_ == 0) FollowStill(images[done - 1]);
  }
  return all;
}

// How many frames from here on are looked at with what is known now.
int Detector::FramesToSummary() const {
  return usual_length_ > 0 ? kSummaryInterval - frames_since_summary_ : 1;
}

BlobFrame Detector::Find(int frame, const GrayImage& image, Scratch* scratch) const {
  BlobFrame found;
  found.frame = frame;
  found.pixels.reserve(usual_pixels_);
  if (!still_.empty()) still_.TakeOut(dark_, image, &scratch->cleaned);
  const GrayImage& cleaned = still_.empty() ? image : scratch->cleaned;
  if (dark_) FindBlobs(cleaned, true, scratch, &found);
  if (bright_) FindBlobs(cleaned, false, scratch, &found);
  return found;
}

// Whether a patch's strongest pixel passes the threshold.
bool Detector::StandsOut(const Component& c, const ContrastView& view,
                         const LocalBackground& background, double least_contrast) const {
  for (const PixelRun& run : c.runs) {
    for (int u = run.first; u <= run.last; ++u) {
      const double contrast = view.sign * (view.level.At(u, run.v) - view.smooth.Row(run.v)[u]);
      if (contrast >= std::max(options_.threshold * background.NoiseAt(u, run.v), least_contrast)) {
        return true;
      }
    }
  }
  return false;
}

// The candidates, in the scratch's mask, of its smooth picture.
LocalBackground Detector::MarkCandidates(const GrayImage& image, bool dark,
                                         Scratch* scratch) const {
  GrayImage& smooth = scratch->smooth;
  Fit(image.width, image.height, &smooth);
  cv::Mat smooth_view = View(smooth);
  cv::GaussianBlur(View(image), smooth_view, cv::Size(3, 3), 0);
  LocalBackground background =
      EstimateBackground(smooth, Window(image.height), kLeastNoise,
                         std::max(kLeastOutlier, kOutlierContrast * usual_contrast_));
  std::vector<float> low(background.noise.size());
  for (std::size_t k = 0; k < low.size(); ++k) {
    low[k] =
        static_cast<float>(kLowOverHigh * std::max(options_.threshold * background.noise[k],
                                                   options_.relative_contrast * usual_contrast_));
  }
  MarkContrast(smooth, background, dark, low, &scratch->limit, &scratch->mask);
  return background;
}

void Detector::FindBlobs(const GrayImage& image, bool dark, Scratch* scratch,
                         BlobFrame* found) const {
  const LocalBackground background = MarkCandidates(image, dark, scratch);
  const double window = Window(image.height);
  const double least_contrast = options_.relative_contrast * usual_contrast_;
  const LevelTable level(background, image.width, image.height);
  const ContrastView view{image, scratch->smooth, level, dark ? 1.0 : -1.0};
  const Components components = FindComponents(scratch->mask);
  for (const Component& c : components) {
    if (c.area < options_.min_area) {
      found->specks += StandsOut(c, view, background, least_contrast) ? 1 : 0;
      continue;
    }
    if (c.right - c.left >= image.width / 2 && c.bottom - c.top >= image.height / 2) continue;
    const double noise = background.NoiseAt(0.5 * (c.left + c.right), 0.5 * (c.top + c.bottom));
    const std::size_t first = found->blobs.size();
    scratch->cutter.Append(c, view,
                           {.noise = noise,
                            .least_peak = std::max(options_.threshold * noise, least_contrast),
                            .min_area = options_.min_area,
                            .longest_side = kLongestOverWindow * window},
                           found);
    if (!ignored_.empty()) DropIgnored(first, found);
  }
}

// Of the blobs from `first` on, with their pixels.
void Detector::DropIgnored(std::size_t first, BlobFrame* found) const {
  const auto is_ignored = [this](const Vec2d& p) {
    return std::any_of(ignored_.begin(), ignored_.end(), [&p](const Box& b) {
      return p.x >= b.left && p.y >= b.top && p.x <= b.left + b.width && p.y <= b.top + b.height;
    });
  };
  for (std::size_t k = found->blobs.size(); k-- > first;) {
    const Blob& blob = found->blobs[k];
    if (!is_ignored(blob.center)) continue;
    const auto begin = found->pixels.begin() + blob.first_pixel;
    found->pixels.erase(begin, begin + blob.pixel_count);
    for (std::size_t later = k + 1; later < found->blobs.size(); ++later) {
      found->blobs[later].first_pixel -= blob.pixel_count;
    }
    found->blobs.erase(found->blobs.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

void Detector::Remember(const BlobFrame& found) {
  usual_pixels_ = found.pixels.size() + found.pixels.size() / 4;
  for (const Blob& blob : found.blobs) {
    recent_.push_back({blob.mass, blob.peak, ShapeOf(blob.moments, 0).major});
    if (recent_.size() > kRemembered) recent_.pop_front();
  }
  if (recent_.empty() || (usual_length_ > 0 && ++frames_since_summary_ < kSummaryInterval)) return;
  frames_since_summary_ = 0;
  std::vector<std::pair<double, double>> scratch;
  usual_contrast_ = MassQuantile(&scratch, 0.5, [this](auto* values) {
    for (const Trace& t : recent_) values->push_back({t.peak, t.mass});
  });
  usual_length_ = MassQuantile(&scratch, 0.8, [this](auto* values) {
    for (const Trace& t : recent_) values->push_back({t.length, t.mass});
  });
}

}  // namespace flocklift
