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
#include "track/finder.h"
#include "track/linker.h"
#include "track/stopwatch.h"
#include "track/track_checkpoint.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

using internal::BoundedQueue;
using internal::Finder;
using internal::Found;
using internal::Linker;
using internal::Stopwatch;
using internal::Timed;
using internal::TrackCheckpoint;

constexpr std::size_t kBatch = 8;   // frames that are looked at together
constexpr std::size_t kQueued = 8;  // pictures between two threads
constexpr std::size_t kFound = 96;  // frames' blobs, which are much less: as the linker looks at
                                    // some seconds of them before it begins

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
    while (first.size() < Finder::kLearnImages) {
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
  state.Take(&report->clutter);
  linker->Load(&state);
  report->frames = saved.frame;
  video->Skip(saved.frame);
}

void Save(const std::string& finder_state, const TrackerReport& report, const Linker& linker,
          TrackCheckpoint* checkpoint) {
  StateWriter state;
  state.Put(report.detections);
  state.Put(report.clutter);
  linker.Save(&state);
  checkpoint->Keep(report.frames, finder_state + state.bytes());
}

// All frames through the threads, until the last one or the linker asks for a second look.
void Track(bool has_learned, const Progress& progress, VideoSource* video, Finder* finder,
           Linker* linker, TrackCheckpoint* checkpoint, TrackerReport* report) {
  TrackerTimings* timings = &report->timings;
  const std::int64_t declared = video->frame_count().value_or(0);
  SparePictures spare;
  BoundedQueue<GrayImage> images(kQueued);
  BoundedQueue<Found> all_found(kFound);
  std::exception_ptr decode_error, find_error, link_error;
  std::thread decoder = Run(
      &decode_error, [&] { Decode(video, timings, &spare, &images); }, [&] { images.Close(); });
  std::thread find_thread = Run(
      &find_error, [&] { FindAll(has_learned, &images, &spare, finder, &all_found); },
      [&] {
        images.Close();
        all_found.Close();
      });
  try {
    while (std::optional<Found> found = all_found.Pop()) {
      ++report->frames;
      report->detections += static_cast<std::int64_t>(found->blobs.blobs.size());
      Timed(&timings->associate_s, [&] { linker->Add(std::move(found->blobs)); });
      if (linker->asks_for_second_look()) break;
      if (!found->state.empty() && linker->CanSave() && checkpoint->IsDue()) {
        Save(found->state, *report, *linker, checkpoint);
      }
      Report(progress, report->frames, declared);
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
}

}  // namespace

TrackerReport StreamTracks(const TrackerOptions& options, const std::filesystem::path& path,
                           const TakeTracklet& take, const Progress& progress,
                           std::optional<double> fps, const CheckpointPlace& place) {
  CheckOptions(options);
  const Stopwatch total;
  std::optional<VideoSource> video(std::in_place, path);
  TrackerReport report;
  const bool is_saved = !place.folder.empty();
  TrackCheckpoint checkpoint(place, is_saved ? internal::FingerprintOf(options, path) : "");
  Finder finder(options, is_saved, &report.timings);
  const auto new_linker = [&] {
    return Linker(options, video->width(), video->height(), checkpoint.sightings());
  };
  std::optional<Linker> linker(new_linker());
  const std::optional<TrackCheckpoint::Saved> saved = checkpoint.Load();
  if (saved) GoOn(*saved, &*video, &finder, &*linker, &report);
  const std::int64_t frames_before = report.frames;

  linker->set_may_ask(!saved && finder.detector.CanTakeOutStill());
  Track(saved.has_value(), progress, &*video, &finder, &*linker, &checkpoint, &report);
  if (linker->asks_for_second_look()) {
    report.clutter = linker->clutter();
    video.emplace(path);
    finder.Restart(path);
    linker.emplace(new_linker());
    report.frames = report.detections = 0;
    Track(false, progress, &*video, &finder, &*linker, &checkpoint, &report);
  }

  const Detector& detector = finder.detector;
  report.usual_length_px = detector.usual_length();
  report.usual_contrast = detector.usual_contrast();
  report.dark = detector.finds_dark();
  report.bright = detector.finds_bright();
  const std::int64_t declared = video->frame_count().value_or(0);
  if (report.frames < declared) {
    report.warnings.push_back("the video declares " + std::to_string(declared) +
                              " frames, but only " + std::to_string(report.frames) +
                              " could be read");
  }
  report.fps = fps ? fps : video->fps();
  linker->Finish(take, &report);
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
