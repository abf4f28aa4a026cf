// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/flock_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "track/associate/assignment.h"
#include "track/associate/occupants.h"
#include "track/associate/point_grid.h"
#include "track/associate/share_blob.h"

namespace flocklift {
namespace {

constexpr double kShareCost = 1.5;       // a shared blob is less likely than one of its own
constexpr double kMemory = 0.15;         // weight of the newest size, mass and shape
constexpr std::size_t kPathFrames = 60;  // of the past that tell how an animal moves
constexpr std::size_t kStretch = 128;    // sightings that go into the file together

double SpreadOf(const Moments& m) { return 0.5 * (m.xx + m.yy); }

}  // namespace

FlockTracker::FlockTracker(const AssociationOptions& options, const MotionNoise& noise,
                           double image_width, double image_height, SightingFile* file)
    : options_(options),
      noise_(noise),
      width_(image_width),
      height_(image_height),
      gate_(-2 * std::log(1 - options.gate_probability)),  // chi-square, 2 degrees of freedom
      file_(file) {
  CheckOptions(options);
}

void FlockTracker::Step(const BlobFrame& blobs) {
  PredictAll(started_ ? blobs.frame - last_frame_ : 1);
  const std::vector<Observation> observations = Observe(blobs);
  const std::vector<int> taken = AssignAll(blobs, observations);
  UpdateAll(blobs, observations, taken);
  EndAndBegin(blobs, observations, taken);
  last_frame_ = blobs.frame;
  started_ = true;
}

void FlockTracker::PredictAll(int frames) {
  const MotionStep step = noise_.Step();
  for (Animal& animal : animals_) {
    animal.motion.Predict(step, noise_.ProcessVariance(animal.record.size), frames);
    animal.age += frames;
    animal.alone = frames < kRemembered ? animal.alone << frames : 0;
    animal.missed += frames - 1;
  }
}

std::vector<int> FlockTracker::AssignAll(const BlobFrame& blobs,
                                         const std::vector<Observation>& observations) {
  std::vector<Vec2d> positions;
  for (const Observation& o : observations) positions.push_back(o.position);
  const PointGrid grid(positions, 32);
  const double log_density = std::log(std::max(strays_, 1.0) / (width_ * height_));
  std::vector<Candidate> candidates;
  std::vector<double> alone;
  for (std::size_t i = 0; i < animals_.size(); ++i) {
    const Animal& animal = animals_[i];
    alone.push_back(-std::log(1 - options_.detection_probability));
    const double own_noise = noise_.MeasurementVariance(animal.record.size);
    const double widest = animal.motion.widest_pp() + own_noise + 2 * SpreadOf(animal.moments);
    grid.ForEachWithin(
        animal.motion.state().position, std::sqrt(gate_ * widest), [&](int j, double d2) {
          const Observation& o = observations[j];
          if (o.owner >= 0 && o.owner != static_cast<int>(i)) return;
          const double r = o.owner >= 0 ? o.variance : own_noise;
          if (d2 > gate_ * (animal.motion.widest_pp() + r)) return;
          const double extra =
              o.owner >= 0 ? kShareCost : MassCost(blobs.blobs[o.blob].mass, animal.record.mass);
          candidates.push_back({static_cast<int>(i), j,
                                animal.motion.NegativeLogLikelihood(o.position, r) + log_density -
                                    std::log(options_.detection_probability) + extra});
        });
  }
  return Assign(static_cast<int>(observations.size()), candidates, alone);
}

void FlockTracker::NoteAlone(int frame, Animal* animal) {
  if (animal->last_alone < 0) animal->first_alone = frame;
  animal->last_alone = frame;
  animal->alone |= 1;
}

void FlockTracker::Sight(const BlobFrame& blobs, const Observation& o, Animal* animal) {
  const Blob& blob = blobs.blobs[o.blob];
  TrackRecord& record = animal->record;
  const bool shared = o.owner >= 0;
  const double variance = shared ? o.variance : noise_.MeasurementVariance(record.size);
  animal->motion.Update(o.position, variance);
  ++animal->hits;
  animal->missed = 0;
  TrackPoint sighting{.frame = blobs.frame,
                      .position = o.position,
                      .variance = variance,
                      .agility = animal->motion.agility(),
                      .box = blob.box,
                      .edges = blob.edges,
                      .shape = {},
                      .shared = shared,
                      .hidden = shared && o.hidden,
                      .blob = o.blob};
  animal->hidden = sighting.hidden ? animal->hidden + 1 : 0;
  if (shared) {
    const TrackPoint& before = animal->newest.back();
    sighting.box = Box::Around(o.position, before.box.width, before.box.height);
    sighting.edges = {};
    sighting.shape = before.shape;
  } else {
    if (!blob.cut && !blob.edges.any()) NoteAlone(blobs.frame, animal);
    const double w = std::max(kMemory, 1.0 / animal->hits);
    record.mass *= std::pow(blob.mass / record.mass, w);
    record.size *= std::pow(SizeOf(blob) / record.size, w);
    animal->moments.xx += w * (blob.moments.xx - animal->moments.xx);
    animal->moments.xy += w * (blob.moments.xy - animal->moments.xy);
    animal->moments.yy += w * (blob.moments.yy - animal->moments.yy);
    sighting.shape = ShapeOf(blob.moments, blob.mass / std::max(blob.peak, 1e-9));
  }
  animal->newest.push_back(sighting);
  if (file_ == nullptr) return;
  // What is hidden may be taken back.
  const std::size_t kept = std::max<std::size_t>(kPathFrames, animal->hidden + 1);
  if (animal->newest.size() >= kept + kStretch) PutAside(kStretch, animal);
}

// The oldest of the newest.
void FlockTracker::PutAside(std::size_t count, Animal* animal) {
  std::vector<TrackPoint>& newest = animal->newest;
  Sightings& older = animal->record.sightings;
  if (file_ == nullptr) {
    newest.resize(count);
    older.Append(std::exchange(newest, {}));
    return;
  }
  older.Append(std::span(newest).first(count), animal->number, file_);
  newest.erase(newest.begin(), newest.begin() + static_cast<std::ptrdiff_t>(count));
}

void FlockTracker::UpdateAll(const BlobFrame& blobs, const std::vector<Observation>& observations,
                             const std::vector<int>& taken) {
  std::vector<int> sharers(blobs.blobs.size(), 0);
  for (const int j : taken) {
    if (j >= 0 && observations[j].owner >= 0) ++sharers[observations[j].blob];
  }
  for (std::size_t i = 0; i < animals_.size(); ++i) {
    Animal& animal = animals_[i];
    if (taken[i] < 0) {
      ++animal.missed;
      continue;
    }
    Observation o = observations[taken[i]];
    if (o.owner >= 0 && sharers[o.blob] == 1) {  // the others turned out to be elsewhere
      o.owner = -1;
      o.position = blobs.blobs[o.blob].center;
    }
    Sight(blobs, o, &animal);
  }
}

void FlockTracker::End(Animal* animal) {
  if (!animal->confirmed) return;
  std::vector<TrackPoint>& newest = animal->newest;
  while (newest.back().hidden) newest.pop_back();  // the first never is
  PutAside(newest.size(), animal);
  finished_.push_back(std::move(animal->record));
  finished_numbers_.push_back(animal->number);
}

void FlockTracker::EndAndBegin(const BlobFrame& blobs, const std::vector<Observation>& observations,
                               const std::vector<int>& taken) {
  std::vector<char> used(blobs.blobs.size(), 0);
  for (const int j : taken) {
    if (j >= 0) used[observations[j].blob] = 1;
  }
  const bool is_moved = !blobs.world_from_image.IsIdentity();
  const Similarity image_from_world = blobs.world_from_image.Inverse();
  std::size_t kept = 0;
  for (Animal& animal : animals_) {
    if (!animal.confirmed && animal.hits >= options_.confirm_hits) animal.confirmed = true;
    const Vec2d p = is_moved ? image_from_world * animal.motion.state().position
                             : animal.motion.state().position;
    const bool outside = p.x < 0 || p.y < 0 || p.x > width_ - 1 || p.y > height_ - 1;
    const bool over =
        animal.confirmed
            ? animal.missed > options_.max_missed_frames || (outside && animal.missed > 0)
            : animal.age + 1 - animal.hits > options_.confirm_frames - options_.confirm_hits ||
                  (outside && animal.missed > 0);
    if (over) {
      End(&animal);
    } else {
      if (&animals_[kept] != &animal) animals_[kept] = std::move(animal);
      ++kept;
    }
  }
  animals_.resize(kept);

  int strays = 0;
  for (std::size_t j = 0; j < blobs.blobs.size(); ++j) {
    if (used[j]) continue;
    ++strays;
    const Blob& blob = blobs.blobs[j];
    Animal animal;
    animal.record.size = SizeOf(blob);
    animal.record.mass = blob.mass;
    animal.moments = blob.moments;
    const double variance = noise_.MeasurementVariance(animal.record.size);
    animal.motion = MotionFilter(
        noise_.Start(blob.center, variance, noise_.ProcessVariance(animal.record.size)));
    animal.hits = 1;
    animal.number = ++begun_;
    if (!blob.cut && !blob.edges.any()) NoteAlone(blobs.frame, &animal);
    animal.confirmed = options_.confirm_hits <= 1;
    animal.newest.push_back(
        {.frame = blobs.frame,
         .position = blob.center,
         .variance = variance,
         .box = blob.box,
         .edges = blob.edges,
         .shape = ShapeOf(blob.moments, blob.mass / std::max(blob.peak, 1e-9))});
    animals_.push_back(std::move(animal));
  }
  strays_ += 0.1 * (strays - strays_);
}

std::vector<Path> FlockTracker::RecentPaths(int least) const {
  std::vector<Path> paths;
  for (const Animal& animal : animals_) {
    const std::vector<TrackPoint>& all = animal.newest;
    std::size_t first = all.size();
    while (first > 0 && all.size() - first < kPathFrames && !all[first - 1].shared &&
           !all[first - 1].edges.any() &&
           (first == all.size() || all[first - 1].frame + 1 == all[first].frame)) {
      --first;
    }
    if (!animal.confirmed || static_cast<int>(all.size() - first) < least) continue;
    Path path{animal.record.size, {}};
    for (std::size_t k = first; k < all.size(); ++k) path.positions.push_back(all[k].position);
    if (ExtentOf(path.positions) >= path.size) paths.push_back(std::move(path));
  }
  return paths;
}

std::vector<TrackRecord> FlockTracker::Finish() {
  for (Animal& animal : animals_) {
    End(&animal);
  }
  animals_.clear();
  std::stable_sort(finished_.begin(), finished_.end(),
                   [](const TrackRecord& a, const TrackRecord& b) {
                     return a.sightings.first_frame() < b.sightings.first_frame();
                   });
  return std::move(finished_);
}

}  // namespace flocklift
