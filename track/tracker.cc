// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/tracker.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "simulate/core/check.h"
#include "track/bounded_queue.h"
#include "track/linker.h"
#include "track/stopwatch.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

using internal::Linker;
using internal::Stopwatch;
using internal::Timed;

constexpr std::size_t kLearnImages = 24;  // at the start, for the detector
constexpr std::size_t kLearnStride = 2;   // of these, every second one
constexpr std::size_t kQueued = 6;        // frames between two threads

// Pictures whose memory is used again.
class SparePictures {
 public:
  GrayImage Take() {
    const std::lock_guard lock(mutex_);
    if (pictures_.empty()) return {};
    GrayImage picture = std::move(pictures_.back());
    pictures_.pop_back();
    return picture;
  }
  void Give(GrayImage picture) {
    const std::lock_guard lock(mutex_);
    if (pictures_.size() < kQueued) pictures_.push_back(std::move(picture));
  }

 private:
  std::mutex mutex_;
  std::vector<GrayImage> pictures_;
};

}  // namespace

TrackerResult TrackVideo(const TrackerOptions& options, const std::filesystem::path& path,
                         const Progress& progress, std::optional<double> fps) {
  CheckOptions(options);
  const Stopwatch total;
  VideoSource video(path);
  const double width = video.width(), height = video.height();
  const std::int64_t declared = video.frame_count().value_or(0);
  TrackerReport report;

  SparePictures spare;
  internal::BoundedQueue<GrayImage> images(kQueued);
  internal::BoundedQueue<BlobFrame> blob_frames(4 * kQueued);
  std::exception_ptr decode_error, detect_error;
  TrackerTimings timings;
  Detector detector(options.detect);
  CameraMotion camera(options.camera);

  std::thread decoder([&] {
    try {
      GrayImage image;
      while (Timed(&timings.decode_s, [&] { return video.Read(&image); })) {
        if (!images.Push(std::move(image))) break;
        image = spare.Take();
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
        BlobFrame found = Timed(&timings.detect_s, [&] { return detector.Detect(number, image); });
        found.world_from_image =
            Timed(&timings.camera_s, [&] { return camera.Next(image, found); });
        return blob_frames.Push(std::move(found));
      };
      bool wanted = true;
      for (GrayImage& image : first) {
        wanted = wanted && detect(image);
        spare.Give(std::move(image));
      }
      while (wanted) {
        std::optional<GrayImage> image = images.Pop();
        if (!image) break;
        wanted = detect(*image);
        spare.Give(std::move(*image));
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
  TrackerResult result = linker.Finish(fps ? fps : video.fps(), std::move(report));
  result.report.timings.total_s = total.Seconds();
  return result;
}

}  // namespace flocklift
