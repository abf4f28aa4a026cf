// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Detection by local contrast. A pixel is a candidate when it differs from the background
// (background.h) by more than a threshold T, of the sign of the animals; connected candidates whose
// strongest pixel passes 2 T make a blob (hysteresis); a blob with a deep saddle is cut there
// (watershed.h). With sd the local noise and C the usual contrast of the animals,
//   2 T = max(threshold * sd, relative_contrast * C).
// Sign, usual contrast and usual length are learned from the footage and follow it. Contrast is
// measured against the same frame's surroundings, so clouds that are smoother than an animal is
// long, and fades, do not fire; what stands still can be taken out beforehand (still_picture.h).

#ifndef FLOCKLIFT_TRACK_DETECT_DETECTOR_H_
#define FLOCKLIFT_TRACK_DETECT_DETECTOR_H_

#include <cstddef>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "simulate/core/options.h"
#include "simulate/core/parallel_for.h"
#include "simulate/core/state_archive.h"
#include "track/detect/background.h"
#include "track/detect/blob.h"
#include "track/detect/components.h"
#include "track/detect/patch_blobs.h"
#include "track/detect/still_picture.h"
#include "track/gray_image.h"

namespace flocklift {

struct DetectorOptions {
  std::string polarity = "auto";   // dark or bright animals, both, or learned from the footage
  double threshold = 7;            // peak contrast over noise
  double relative_contrast = 0.2;  // peak contrast over the usual peak contrast
  double window = 0;               // side of the local mean [px]; 0: learned, 3 lengths
  int min_area = 3;                // [px]
  std::string ignore = {};         // boxes in which nothing is an animal
};

template <typename Visitor>
void Describe(Visitor& visit, DetectorOptions& o) {
  visit("polarity", o.polarity, {}, "", "animals are dark, bright, both, or auto: learn it");
  visit("threshold", o.threshold, {.low = 2, .high = 100}, "sd",
        "least peak contrast, in standard deviations of the local noise");
  visit("relative-contrast", o.relative_contrast, {.low = 0, .high = 0.9}, "",
        "least peak contrast, as a share of the usual one");
  visit("window", o.window, {.low = 0, .high = 2000}, "px",
        "window of the local background; 0: three times the usual length of an animal");
  visit("min-area", o.min_area, {.low = 1, .high = 100000}, "px", "least area of an animal");
  visit("ignore", o.ignore, {}, "px",
        "regions without animals, left,top,width,height;... (a clock, a tree in the wind)");
}

class Detector {
 public:
  explicit Detector(const DetectorOptions& options);

  // Learns sign, contrast and length from frames of the footage's start.
  void Learn(std::span<const GrayImage> images, ThreadPool* pool);

  // A look at what stands still, of animals of one sign; and what was learned from all looks, which
  // is taken out from then on: Learn has to follow.
  bool CanTakeOutStill() const { return dark_ != bright_; }
  void LookForStill(const GrayImage& image, StillLooks* looks);
  void TakeOut(StillPicture still);

  // By how much each pixel differs from the sky, by the sign of the animals; 0 where that is less
  // than a candidate's. Patches count that are too large for an animal, unlike those of blobs.
  std::vector<float> ContrastOf(const GrayImage& image);

  BlobFrame Detect(int frame, const GrayImage& image);

  // The same for consecutive frames, several at a time. What is learned on the way changes once in
  // some frames, so that those in between do not wait for each other.
  std::vector<BlobFrame> DetectAll(int first_frame, std::span<const GrayImage> images,
                                   ThreadPool* pool);

  // What was learned so far, to go on from later.
  void Save(StateWriter* state) const;
  void Load(StateReader* state);

  bool finds_dark() const { return dark_; }
  bool finds_bright() const { return bright_; }
  double usual_length() const { return usual_length_; }      // 4 sd along the major axis [px]
  double usual_contrast() const { return usual_contrast_; }  // [grey levels]

 private:
  static constexpr int kSummaryInterval = 8;  // frames

  // What is remembered of a recent blob.
  struct Trace {
    double mass = 0, peak = 0, length = 0;
  };

  bool StandsOut(const Component& component, const ContrastView& view,
                 const LocalBackground& background, double least_contrast) const;
  // Memory of one thread, kept so that no frame allocates it anew.
  struct Scratch {
    PatchCutter cutter;
    GrayImage cleaned, smooth, limit, mask;
  };

  int FramesToSummary() const;
  BlobFrame Find(int frame, const GrayImage& image, Scratch* scratch) const;
  LocalBackground MarkCandidates(const GrayImage& image, bool dark, Scratch* scratch) const;
  void FindBlobs(const GrayImage& image, bool dark, Scratch* scratch, BlobFrame* found) const;
  void FollowStill(const GrayImage& image);
  void DropIgnored(std::size_t first, BlobFrame* found) const;
  void Remember(const BlobFrame& found);
  double Window(int image_height) const;
  void LearnPolarity(std::span<const GrayImage> images, ThreadPool* pool);

  DetectorOptions options_;
  std::vector<Box> ignored_;
  StillPicture still_;
  bool dark_ = true, bright_ = false;
  double usual_length_ = 0, usual_contrast_ = 0;  // 0: not known yet
  std::deque<Trace> recent_;
  int frames_since_summary_ = 0;
  std::size_t usual_pixels_ = 0;  // of a frame's blobs, to reserve memory
  std::deque<Scratch> scratch_;   // one for each frame that is looked at at a time
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_DETECT_DETECTOR_H_
