// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Many animals, frame by frame: predict, share blobs, gate, assign, update. Costs are negative log
// likelihoods: animal i sighted as observation j costs
//   -ln p(position | prediction) + ln(density) - ln P_D + mass term,
// where density is that of observations which belong to nobody [1/px^2], and a missed animal costs
// -ln(1 - P_D). A blob in which several animals are expected is shared among them (share_blob.h).

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_FLOCK_TRACKER_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_FLOCK_TRACKER_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulate/core/options.h"
#include "simulate/core/state_archive.h"
#include "track/associate/doubt.h"
#include "track/associate/share_blob.h"
#include "track/associate/sightings.h"
#include "track/detect/blob.h"
#include "track/predict/motion_filter.h"
#include "track/predict/motion_noise.h"

namespace flocklift {

struct AssociationOptions {
  double gate_probability = 0.9999;  // chi-square mass inside the gate
  double detection_probability = 0.95;
  int max_missed_frames = 10;
  int confirm_hits = 3;
  int confirm_frames = 5;
};

template <typename Visitor>
void Describe(Visitor& visit, AssociationOptions& o) {
  visit("gate-probability", o.gate_probability, {.low = 0.5, .high = 0.999999}, "",
        "share of true sightings inside the association gate");
  visit("detection-probability", o.detection_probability, {.low = 0.05, .high = 0.9999}, "",
        "chance that an animal in the picture is detected");
  visit("max-missed-frames", o.max_missed_frames, {.low = 0, .high = 1000}, "frames",
        "an animal that is missed for longer is given up (stitching may find it again)");
  visit("confirm-hits", o.confirm_hits, {.low = 1, .high = 100}, "",
        "sightings that make a track, among its first confirm-frames frames");
  visit("confirm-frames", o.confirm_frames, {.low = 1, .high = 1000}, "frames", "see confirm-hits");
}

// An animal, as far as it was followed.
struct TrackRecord {
  double size = 1;  // usual, square root of area [px]
  double mass = 0;  // usual
  Sightings sightings;
  std::vector<Doubt> doubts;
  Id given_id = kNoId;  // of a track that somebody else made: its rows stay as they are
};

class FlockTracker {
 public:
  // `file`, if any, must outlive the tracker and its records: there go all sightings but each
  // animal's newest.
  FlockTracker(const AssociationOptions& options, const MotionNoise& noise, double image_width,
               double image_height, SightingFile* file = nullptr);

  // Frames by increasing number; those left out count as missed.
  void Step(const BlobFrame& blobs);

  // All that was confirmed, by first frame.
  std::vector<TrackRecord> Finish();

  // What the confirmed animals did lately, each while it had a blob of its own: paths of at least
  // `least` frames, up to this one, to learn the motion noise from.
  std::vector<Path> RecentPaths(int least) const;
  void SetNoise(const MotionNoise& noise) { noise_ = noise; }

  // The state, to go on from later, without what is in the file, which must be as it was then.
  void Save(StateWriter* state) const;
  // Throws std::runtime_error where the two do not fit together.
  void Load(StateReader* state);

 private:
  static constexpr int kRemembered = 64;  // frames of an animal's own blobs, one by one

  struct Animal {
    std::uint64_t number = 0;  // from 1 on
    MotionFilter motion;
    Moments moments;
    TrackRecord record;
    std::vector<TrackPoint> newest;  // sightings, after those of the record
    int hits = 0, missed = 0, age = 0;
    int hidden = 0;                        // frames in a row
    int first_alone = 0, last_alone = -1;  // frames in which it had a whole blob of its own
    std::uint64_t alone = 0;               // bit k: so it had k frames ago
    bool confirmed = false;
  };
  // A blob, or one animal's share of a blob.
  struct Observation {
    Vec2d position;
    double variance = 0;
    bool hidden = false;
    int blob = 0;
    int owner = -1;  // a share can be taken by its animal alone
  };

  void PredictAll(int frames);
  std::vector<Observation> Observe(const BlobFrame& blobs);
  void KeepSeenApart(int frame, std::vector<int>* inside) const;
  Expectation ExpectationOf(const Animal& animal) const;
  void DropAbsent(const Blob& blob, std::vector<int>* inside) const;
  std::vector<std::vector<int>> ExpectedInBlobs(const BlobFrame& blobs) const;
  std::vector<int> AssignAll(const BlobFrame& blobs, const std::vector<Observation>& observations);
  void UpdateAll(const BlobFrame& blobs, const std::vector<Observation>& observations,
                 const std::vector<int>& taken);
  void WaitIfHidden(std::vector<int>* inside) const;
  void PutAside(std::size_t count, Animal* animal);
  void End(Animal* animal);
  static void NoteAlone(int frame, Animal* animal);
  void Sight(const BlobFrame& blobs, const Observation& observation, Animal* animal);
  void EndAndBegin(const BlobFrame& blobs, const std::vector<Observation>& observations,
                   const std::vector<int>& taken);

  AssociationOptions options_;
  MotionNoise noise_;
  double width_, height_, gate_;
  double strays_ = 1;  // observations a frame that belong to nobody, running mean
  int last_frame_ = 0;
  bool started_ = false;
  std::vector<Animal> animals_;
  std::vector<TrackRecord> finished_;
  std::vector<std::uint64_t> finished_numbers_;  // one each
  std::uint64_t begun_ = 0;                      // animals
  SightingFile* file_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_FLOCK_TRACKER_H_
