// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Detection and camera motion, frame by frame, for a run that may be gone on from.

#ifndef FLOCKLIFT_TRACK_FINDER_H_
#define FLOCKLIFT_TRACK_FINDER_H_

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/core/state_archive.h"
#include "track/detect/camera_motion.h"
#include "track/detect/detector.h"
#include "track/gray_image.h"
#include "track/tracker.h"

namespace flocklift::internal {

// What was found in a frame; in one of some frames, what the finder knows after it.
struct Found {
  BlobFrame blobs;
  std::string state;
};

class Finder {
 public:
  static constexpr std::size_t kLearnImages = 24;  // at the start

  Finder(const TrackerOptions& options, bool is_saved, TrackerTimings* timings)
      : detector(options.detect),
        options_(options),
        is_saved_(is_saved),
        timings_(timings),
        camera_(options.camera) {}

  void Learn(const std::vector<GrayImage>& images);
  std::vector<Found> Find(std::span<const GrayImage> images);

  // From the first frame on again, now without what stands still there (still_picture.h).
  void Restart(const std::filesystem::path& footage);

  void Load(StateReader* state);

  Detector detector;

 private:
  std::string Save();

  TrackerOptions options_;
  bool is_saved_;
  TrackerTimings* timings_;
  CameraMotion camera_;
  ThreadPool pool_{0};
  int frame_ = 0, saved_frame_ = 0;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_FINDER_H_
