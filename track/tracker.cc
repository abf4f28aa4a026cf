// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/tracker.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <thread>
#include <utility>

#include "simulate/core/check.h"
#include "track/associate/uncross.h"
#include "track/bounded_queue.h"
#include "track/finish.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

constexpr std::size_t kLearnImages = 24;      // at the start, for the detector
constexpr std::size_t kLearnStride = 2;       // of these, every second one
constexpr std::size_t kLearnBlobFrames = 90;  // for the motion noise
constexpr int kLeastPath = 8;                 // frames of a path that teaches motion
constexpr int kRelearnInterval = 100;         // frames
constexpr std::size_t kQueued = 6;            // frames between two threads

class Stopwatch {
 public:
  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Adds the time of one call to `sum`.
template <typename Call>
auto Timed(double* sum, const Call& call) {
  const Stopwatch watch;
  struct Adder {
    const Stopwatch& watch;
    double* sum;
    ~Adder() { *sum += watch.Seconds(); }
  } adder{watch, sum};
  return call();
}

// Frames in, tracks out: keeps the first frames until the motion noise is learned.
class Linker {
 public:
  Linker(const TrackerOptions& options, double width, double height)
      : options_(options), width_(width), height_(height) {}

  void Add(BlobFrame frame) {
    if (tracker_) {
      Step(frame);
      return;
    }
    first_.push_back(std::move(frame));
    if (first_.size() == kLearnBlobFrames) Start();
  }

  std::vector<TrackRecord> Finish() {
    if (!tracker_) Start();
    return tracker_->Finish();
  }
  const MotionNoise& noise() const { return noise_; }

 private:
  void Start() {
    noise_ = EstimateMotionNoise(UnmistakablePaths(first_, kLeastPath), MotionNoise{});
    tracker_.emplace(options_.associate, noise_, width_, height_);
    for (const BlobFrame& frame : first_) Step(frame);
    first_.clear();
  }

  void Step(const BlobFrame& frame) {
    tracker_->Step(frame);
    if (++steps_ % kRelearnInterval != 0) return;
    noise_ = EstimateMotionNoise(tracker_->RecentPaths(kLeastPath), noise_);
    tracker_->SetNoise(noise_);
  }

  const TrackerOptions& options_;
  double width_, height_;
  MotionNoise noise_;
  std::vector<BlobFrame> first_;
  std::optional<FlockTracker> tracker_;
  int steps_ = 0;
};

TrackerResult FinishAll(const TrackerOptions& options, Linker* linker, double width, double height,
                        std::optional<double> fps, TrackerReport report) {
  TrackerResult result;
  result.report = std::move(report);
  Timed(&result.report.timings.finish_s, [&] {
    const MotionNoise& noise = linker->noise();
    std::vector<TrackRecord> records = linker->Finish();
    result.report.exchanges = Uncross(noise, &records);
    int joins = 0;
    records = Stitch(options.stitch, noise, width, height, std::move(records), &joins);
    result.report.joins = joins;
    result.report.noise = linker->noise();
    result.tracks =
        internal::FinishTracks(options, noise, fps, width, height, records, &result.report);
  });
  return result;
}

// A detection as a blob: its shape (or box) as an ellipse of even contrast.
void AppendBlob(const Detection& detection, BlobFrame* frame) {
  constexpr int kRings = 4;
  Blob blob;
  blob.center = detection.box.Center();
  blob.box = detection.box;
  const Shape shape =
      detection.shape.value_or(Shape{detection.box.width, detection.box.height, 0,
                                     0.785 * detection.box.width * detection.box.height});
  blob.moments = MomentsOf(shape);
  blob.mass = std::max(shape.area, 1.0);
  blob.peak = 1;
  blob.snr = 1;
  blob.first_pixel = static_cast<std::uint32_t>(frame->pixels.size());
  const double angle = shape.angle_deg * 3.14159265358979 / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  for (int i = -kRings; i <= kRings; ++i) {
    for (int j = -kRings; j <= kRings; ++j) {
      const double a = static_cast<double>(i) / kRings, b = static_cast<double>(j) / kRings;
      if (a * a + b * b > 1) continue;
      const double x = 0.5 * shape.major * a, y = 0.5 * shape.minor * b;
      frame->pixels.push_back({static_cast<float>(blob.center.x + c * x - s * y),
                               static_cast<float>(blob.center.y + s * x + c * y), 1.0f});
    }
  }
  blob.pixel_count = static_cast<std::uint32_t>(frame->pixels.size()) - blob.first_pixel;
  frame->blobs.push_back(blob);
}

}  // namespace

TrackerResult TrackVideo(const TrackerOptions& options, const std::filesystem::path& path,
                         const Progress& progress, std::optional<double> fps) {
  CheckOptions(options);
  const Stopwatch total;
  VideoSource video(path);
  const double width = video.width(), height = video.height();
  const std::int64_t declared = video.frame_count().value_or(0);
  TrackerReport report;

  internal::BoundedQueue<GrayImage> images(kQueued);
  internal::BoundedQueue<BlobFrame> blob_frames(4 * kQueued);
  std::exception_ptr decode_error, detect_error;
  TrackerTimings timings;
  Detector detector(options.detect);

  std::thread decoder([&] {
    try {
      GrayImage image;
      while (Timed(&timings.decode_s, [&] { return video.Read(&image); })) {
        if (!images.Push(std::move(image))) break;
        image = GrayImage();
      }
    } catch (...) {
      decode_error = std::current_exception();
    }
    images.Close();
  });
  std::thread finder([&] {
    try {
      std::vector<GrayImage> first;
      while (first.size() < kLearnImages) {
        std::optional<GrayImage> image = images.Pop();
        if (!image) break;
        first.push_back(std::move(*image));
      }
      std::vector<GrayImage> some;
      for (std::size_t k = 0; k < first.size(); k += kLearnStride) some.push_back(first[k]);
      Timed(&timings.detect_s, [&] { detector.Learn(some); });
      some.clear();
      int number = 0;
      const auto detect = [&](const GrayImage& image) {
        ++number;
        return blob_frames.Push(
            Timed(&timings.detect_s, [&] { return detector.Detect(number, image); }));
      };
      bool wanted = true;
      for (GrayImage& image : first) {
        wanted = wanted && detect(image);
        image = GrayImage();
      }
      while (wanted) {
        const std::optional<GrayImage> image = images.Pop();
        if (!image) break;
        wanted = detect(*image);
      }
    } catch (...) {
      detect_error = std::current_exception();
    }
    images.Close();
    blob_frames.Close();
  });

  Linker linker(options, width, height);
  std::exception_ptr link_error;
  try {
    while (std::optional<BlobFrame> frame = blob_frames.Pop()) {
      ++report.frames;
      report.detections += static_cast<std::int64_t>(frame->blobs.size());
      Timed(&timings.associate_s, [&] { linker.Add(std::move(*frame)); });
      Report(progress, report.frames, declared);
    }
  } catch (...) {
    link_error = std::current_exception();
  }
  blob_frames.Close();
  images.Close();
  finder.join();
  decoder.join();
  for (const std::exception_ptr& error : {decode_error, detect_error, link_error}) {
    if (error) std::rethrow_exception(error);
  }

  report.timings = timings;
  report.usual_length_px = detector.usual_length();
  report.usual_contrast = detector.usual_contrast();
  report.dark = detector.finds_dark();
  report.bright = detector.finds_bright();
  if (report.frames < declared) {
    report.warnings.push_back("the video declares " + std::to_string(declared) +
                              " frames, but only " + std::to_string(report.frames) +
                              " could be read");
  }
  TrackerResult result =
      FinishAll(options, &linker, width, height, fps ? fps : video.fps(), std::move(report));
  result.report.timings.total_s = total.Seconds();
  return result;
}

TrackerResult TrackDetections(const TrackerOptions& options, std::span<const DetectionFrame> frames,
                              double image_width, double image_height, std::optional<double> fps) {
  CheckOptions(options);
  Check(image_width > 0 && image_height > 0, "the picture has no size");
  const Stopwatch total;
  TrackerReport report;
  Linker linker(options, image_width, image_height);
  int last = 0;
  for (const DetectionFrame& frame : frames) {
    Check(report.frames == 0 || frame.frame > last, "the frames are not by increasing number");
    last = frame.frame;
    BlobFrame blobs;
    blobs.frame = frame.frame;
    for (const Detection& detection : frame.detections) AppendBlob(detection, &blobs);
    ++report.frames;
    report.detections += static_cast<std::int64_t>(blobs.blobs.size());
    Timed(&report.timings.associate_s, [&] { linker.Add(std::move(blobs)); });
  }
  TrackerResult result =
      FinishAll(options, &linker, image_width, image_height, fps, std::move(report));
  result.report.timings.total_s = total.Seconds();
  return result;
}

}  // namespace flocklift
