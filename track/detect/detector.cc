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

namespace flocklift {
namespace {

constexpr double kLeastNoise = 0.7;         // [grey levels]: 8-bit pictures have no less
constexpr double kLeastOutlier = 2;         // [grey levels]
constexpr double kOutlierContrast = 0.1;    // a cell that differs by so much of the usual contrast
constexpr double kLowOverHigh = 0.5;        // hysteresis
constexpr double kWindowOverLength = 3;     // of the local mean, to the usual length
constexpr double kLongestOverWindow = 1.2;  // a longer blob is no animal
constexpr double kFirstWindowOverHeight = 1.0 / 8;
constexpr std::size_t kRemembered = 600;  // blobs
constexpr int kSummaryInterval = 8;       // frames

cv::Mat View(const GrayImage& image) {
  return cv::Mat(image.height, image.width, CV_8UC1,
                 const_cast<std::uint8_t*>(image.pixels.data()));
}

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

// Sums over the pixels of one blob, which stand at the end of `found->pixels` from `first` on.
Blob Measure(const BlobFrame& found, std::size_t first) {
  Blob blob;
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  for (std::size_t k = first; k < found.pixels.size(); ++k) {
    const BlobPixel& p = found.pixels[k];
    blob.mass += p.contrast;
    blob.center.x += p.contrast * p.x;
    blob.center.y += p.contrast * p.y;
    left = std::min<double>(left, p.x);
    right = std::max<double>(right, p.x);
    top = std::min<double>(top, p.y);
    bottom = std::max<double>(bottom, p.y);
  }
  blob.center.x /= blob.mass;
  blob.center.y /= blob.mass;
  for (std::size_t k = first; k < found.pixels.size(); ++k) {
    const BlobPixel& p = found.pixels[k];
    const double dx = p.x - blob.center.x, dy = p.y - blob.center.y;
    blob.moments.xx += p.contrast * dx * dx;
    blob.moments.xy += p.contrast * dx * dy;
    blob.moments.yy += p.contrast * dy * dy;
  }
  blob.moments.xx = blob.moments.xx / blob.mass + 1.0 / 12;
  blob.moments.xy = blob.moments.xy / blob.mass;
  blob.moments.yy = blob.moments.yy / blob.mass + 1.0 / 12;
  blob.box = {left - 0.5, top - 0.5, right - left + 1, bottom - top + 1};
  blob.first_pixel = static_cast<std::uint32_t>(first);
  blob.pixel_count = static_cast<std::uint32_t>(found.pixels.size() - first);
  return blob;
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

Detector::Detector(const DetectorOptions& options) : options_(options) {
  CheckOptions(options);
  const std::string& p = options.polarity;
  Check(p == "auto" || p == "dark" || p == "bright" || p == "both",
        "option polarity is " + p + ", allowed are dark, bright, both and auto");
  dark_ = p != "bright";
  bright_ = p == "bright" || p == "both";
  ignored_ = ParseBoxes(options.ignore);
}

bool Detector::IsIgnored(const Vec2d& p) const {
  return std::any_of(ignored_.begin(), ignored_.end(), [&p](const Box& b) {
    return p.x >= b.left && p.y >= b.top && p.x <= b.left + b.width && p.y <= b.top + b.height;
  });
}

double Detector::Window(int image_height) const {
  const double widest = std::max(16.0, kFirstWindowOverHeight * image_height);
  if (options_.window > 0) return options_.window;
  if (usual_length_ <= 0) return widest;
  return std::clamp(kWindowOverLength * usual_length_, std::min(24.0, widest), widest);
}

void Detector::Learn(std::span<const GrayImage> images) {
  if (options_.polarity == "auto") {
    double dark_energy = 0, bright_energy = 0;
    for (const GrayImage& image : images) {
      for (const bool dark : {true, false}) {
        BlobFrame found;
        FindBlobs(image, dark, &found);
        for (const Blob& blob : found.blobs)
          (dark ? dark_energy : bright_energy) += blob.peak * blob.peak;
      }
    }
    dark_ = dark_energy >= bright_energy;
    bright_ = !dark_;
  }
  for (const GrayImage& image : images) Detect(0, image);
}

BlobFrame Detector::Detect(int frame, const GrayImage& image) {
  BlobFrame found;
  found.frame = frame;
  if (dark_) FindBlobs(image, true, &found);
  if (bright_) FindBlobs(image, false, &found);
  Remember(found);
  return found;
}

// Whether a patch's strongest pixel passes the threshold.
bool Detector::StandsOut(const Component& c, const GrayImage& smooth,
                         const LocalBackground& background, double sign,
                         double least_contrast) const {
  for (const PixelRun& run : c.runs) {
    for (int u = run.first; u <= run.last; ++u) {
      const double contrast = sign * (background.LevelAt(u, run.v) - smooth.Row(run.v)[u]);
      if (contrast >= std::max(options_.threshold * background.NoiseAt(u, run.v), least_contrast)) {
        return true;
      }
    }
  }
  return false;
}

void Detector::FindBlobs(const GrayImage& image, bool dark, BlobFrame* found) {
  Fit(image.width, image.height, &smooth_);
  const GrayImage& smooth = smooth_;
  cv::Mat smooth_view = View(smooth_);
  cv::GaussianBlur(View(image), smooth_view, cv::Size(3, 3), 0);
  const double window = Window(image.height);
  const LocalBackground background = EstimateBackground(
      smooth, window, kLeastNoise, std::max(kLeastOutlier, kOutlierContrast * usual_contrast_));

  const double sign = dark ? 1 : -1;
  const double least_contrast = options_.relative_contrast * usual_contrast_;
  std::vector<float> low(background.noise.size());
  for (std::size_t k = 0; k < low.size(); ++k) {
    low[k] = static_cast<float>(kLowOverHigh *
                                std::max(options_.threshold * background.noise[k], least_contrast));
  }
  MarkContrast(smooth, background, dark, low, &limit_, &mask_);
  const std::vector<Component> components = FindComponents(mask_);

  std::vector<float> contrast, raw;
  for (const Component& c : components) {
    if (c.area < options_.min_area) {
      found->specks += StandsOut(c, smooth, background, sign, least_contrast) ? 1 : 0;
      continue;
    }
    const int width = c.right - c.left + 1, height = c.bottom - c.top + 1;
    if (width > image.width / 2 && height > image.height / 2) continue;
    contrast.assign(static_cast<std::size_t>(width) * height, 0);
    raw.assign(contrast.size(), 0);
    float peak = 0;
    for (const PixelRun& run : c.runs) {
      for (int u = run.first; u <= run.last; ++u) {
        const double level = background.LevelAt(u, run.v);
        const std::size_t k = static_cast<std::size_t>(run.v - c.top) * width + (u - c.left);
        contrast[k] = static_cast<float>(std::max(sign * (level - smooth.Row(run.v)[u]), 0.01));
        raw[k] = static_cast<float>(std::max(sign * (level - image.Row(run.v)[u]), 0.01));
        peak = std::max(peak, contrast[k]);
      }
    }
    const double noise = background.NoiseAt(0.5 * (c.left + c.right), 0.5 * (c.top + c.bottom));
    const double high = std::max(options_.threshold * noise, least_contrast);
    if (peak < high) continue;

    WatershedOptions watershed;
    watershed.least_dip = std::max(4 * noise, 0.5 * high);
    int parts = 0;
    const std::vector<int> part = CutAtSaddles(contrast, width, height, watershed, &parts);
    for (int p = 0; p < parts; ++p) {
      const std::size_t first = found->pixels.size();
      float part_peak = 0;
      for (int k = 0; k < width * height; ++k) {
        if (part[k] != p) continue;
        part_peak = std::max(part_peak, contrast[k]);
        found->pixels.push_back({static_cast<float>(c.left + k % width),
                                 static_cast<float>(c.top + k / width), raw[k]});
      }
      Blob blob = Measure(*found, first);
      blob.peak = part_peak;
      blob.snr = part_peak / noise;
      blob.cut = parts > 1;
      const Box& box = blob.box;
      blob.edges.left = box.left < 0;
      blob.edges.top = box.top < 0;
      blob.edges.right = box.left + box.width > image.width - 1;
      blob.edges.bottom = box.top + box.height > image.height - 1;
      if (IsIgnored(blob.center) || part_peak < high ||
          static_cast<int>(blob.pixel_count) < options_.min_area ||
          std::max(blob.box.width, blob.box.height) > kLongestOverWindow * window) {
        found->pixels.resize(first);
        continue;
      }
      found->blobs.push_back(blob);
    }
  }
}

void Detector::Remember(const BlobFrame& found) {
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
