// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/tracker.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/state_archive.h"
#include "track/bounded_queue.h"
#include "track/linker.h"
#include "track/stopwatch.h"
#include "track/track_checkpoint.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

using internal::BoundedQueue;
using internal::Linker;
using internal::Stopwatch;
using internal::Timed;
using internal::TrackCheckpoint;

constexpr std::size_t kLearnImages = 24;  // at the start, for the detector
constexpr std::size_t kLearnStride = 2;   // of these, every second one
constexpr std::size_t kBatch = 8;         // frames that are looked at together
constexpr std::size_t kQueued = 8;        // pictures between two threads
constexpr std::size_t kFound = 96;        // frames' blobs, which are much less: as the linker looks
                                          // at some seconds of them before it begins
constexpr int kSaveStride = 50;           // frames at least from one that can be gone on from to
                                          // the next

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

// What was found in a frame; in one of some frames, what the finder knows after it.
struct Found {
  BlobFrame blobs;
  std::string state;
};

// Detector and camera motion, frame by frame.
class Finder {
 public:
  Finder(const TrackerOptions& options, bool is_saved, TrackerTimings* timings)
      : detector(options.detect), is_saved_(is_saved), timings_(timings), camera_(options.camera) {}

  void Learn(const std::vector<GrayImage>& images) {
    std::vector<GrayImage> some;
    for (std::size_t k = 0; k < images.size(); k += kLearnStride) some.push_back(images[k]);
    Timed(&timings_->detect_s, [&] { detector.Learn(some, &pool_); });
  }
  std::vector<Found> Find(std::span<const GrayImage> images) {
    std::vector<BlobFrame> blobs =
        Timed(&timings_->detect_s, [&] { return detector.DetectAll(frame_ + 1, images, &pool_); });
    std::vector<Found> all;
    for (std::size_t k = 0; k < images.size(); ++k) {
      ++frame_;
      blobs[k].world_from_image =
          Timed(&timings_->camera_s, [&] { return camera_.Next(images[k], blobs[k]); });
      all.push_back({std::move(blobs[k]), {}});
    }
    if (is_saved_ && frame_ - saved_frame_ >= kSaveStride) all.back().state = Save();
    return all;
  }
  void Load(StateReader* state) {
    state->Take(&frame_);
    saved_frame_ = frame_;
    detector.Load(state);
    camera_.Load(state);
  }

  Detector detector;

 private:
  std::string Save() {
    saved_frame_ = frame_;
    StateWriter state;
    state.Put(frame_);
    detector.Save(&state);
    camera_.Save(&state);
    return state.bytes();
  }

  bool is_saved_;
  TrackerTimings* timings_;
  CameraMotion camera_;
  ThreadPool pool_{0};
  int frame_ = 0, saved_frame_ = 0;
};

// The next frames, until there are none or nobody wants them.
void Decode(VideoSource* video, TrackerTimings* timings, SparePictures* spare,
            BoundedQueue<GrayImage>* images) {
  GrayImage image;
  while (Timed(&timings->decode_s, [&] { return video->Read(&image); })) {
    if (!images->Push(std::move(image))) return;
    image = spare->Take();
  }
}

void FindAll(bool has_learned, BoundedQueue<GrayImage>* images, SparePictures* spare,
             Finder* finder, BoundedQueue<Found>* found) {
  std::vector<GrayImage> first;
  if (!has_learned) {
    while (first.size() < kLearnImages) {
      std::optional<GrayImage> image = images->Pop();
      if (!image) break;
      first.push_back(std::move(*image));
    }
    finder->Learn(first);
  }
  std::vector<GrayImage> batch = std::move(first);
  while (true) {
    while (batch.size() < kBatch) {
      std::optional<GrayImage> image = images->Pop();
      if (!image) break;
      batch.push_back(std::move(*image));
    }
    if (batch.empty()) return;
    for (Found& one : finder->Find(batch)) {
      if (!found->Push(std::move(one))) return;
    }
    for (GrayImage& image : batch) spare->Give(std::move(image));
    batch.clear();
  }
}

// Runs `work` in a thread; `error` gets what it throws. `last` is done in any case.
std::thread Run(std::exception_ptr* error, std::function<void()> work, std::function<void()> last) {
  return std::thread([error, work = std::move(work), last = std::move(last)] {
    try {
      work();
    } catch (...) {
      *error = std::current_exception();
    }
    last();
  });
}

// Sets all to where the checkpoint stands.
void GoOn(const TrackCheckpoint::Saved& saved, VideoSource* video, Finder* finder, Linker* linker,
          TrackerReport* report) {
  StateReader state(saved.state);
  finder->Load(&state);
  state.Take(&report->detections);
  linker->Load(&state);
  report->frames = saved.frame;
  video->Skip(saved.frame);
}

void Save(const std::string& finder_state, const TrackerReport& report, const Linker& linker,
          TrackCheckpoint* checkpoint) {
  StateWriter state;
  state.Put(report.detections);
  linker.Save(&state);
  checkpoint->Keep(report.frames, finder_state + state.bytes());
}

}  // namespace

TrackerReport StreamTracks(const TrackerOptions& options, const std::filesystem::path& path,
                           const TakeTracklet& take, const Progress& progress,
                           std::optional<double> fps, const CheckpointPlace& place) {
  CheckOptions(options);
  const Stopwatch total;
  VideoSource video(path);
  const std::int64_t declared = video.frame_count().value_or(0);
  TrackerReport report;
  TrackerTimings timings;
  const bool is_saved = !place.folder.empty();
  TrackCheckpoint checkpoint(place, is_saved ? internal::FingerprintOf(options, path) : "");
  Finder finder(options, is_saved, &timings);
  Linker linker(options, video.width(), video.height(), checkpoint.sightings());
  const std::optional<TrackCheckpoint::Saved> saved = checkpoint.Load();
  if (saved) GoOn(*saved, &video, &finder, &linker, &report);
  const std::int64_t frames_before = report.frames;

  SparePictures spare;
  BoundedQueue<GrayImage> images(kQueued);
  BoundedQueue<Found> all_found(kFound);
  std::exception_ptr decode_error, find_error, link_error;
  std::thread decoder = Run(
      &decode_error, [&] { Decode(&video, &timings, &spare, &images); }, [&] { images.Close(); });
  std::thread find_thread = Run(
      &find_error, [&] { FindAll(saved.has_value(), &images, &spare, &finder, &all_found); },
      [&] {
        images.Close();
        all_found.Close();
      });
  try {
    while (std::optional<Found> found = all_found.Pop()) {
      ++report.frames;
      report.detections += static_cast<std::int64_t>(found->blobs.blobs.size());
      Timed(&timings.associate_s, [&] { linker.Add(std::move(found->blobs)); });
      if (!found->state.empty() && linker.CanSave() && checkpoint.IsDue()) {
        Save(found->state, report, linker, &checkpoint);
      }
      Report(progress, report.frames, declared);
    }
  } catch (...) {
    link_error = std::current_exception();
  }
  all_found.Close();
  images.Close();
  find_thread.join();
  decoder.join();
  for (const std::exception_ptr& error : {decode_error, find_error, link_error}) {
    if (error) std::rethrow_exception(error);
  }

  const Detector& detector = finder.detector;
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
  report.fps = fps ? fps : video.fps();
  linker.Finish(take, &report);
  checkpoint.Remove();
  report.timings.total_s = total.Seconds();
  report.frames_before = frames_before;
  return report;
}

TrackerResult TrackVideo(const TrackerOptions& options, const std::filesystem::path& path,
                         const Progress& progress, std::optional<double> fps,
                         const CheckpointPlace& place) {
  return internal::Gather({}, [&](const TakeTracklet& take, TrackerReport* report) {
    *report = StreamTracks(options, path, take, progress, fps, place);
  });
}

}  // namespace flocklift
