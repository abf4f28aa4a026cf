// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where an animal was seen, frame by frame: hours of video have more sightings than memory holds.
// They are kept as stretches, in memory or in a file, of which memory holds the place alone. To
// look at some they are read again; to give an animal the rest of another's, stretches change
// hands.

#ifndef FLOCKLIFT_TRACK_ASSOCIATE_SIGHTINGS_H_
#define FLOCKLIFT_TRACK_ASSOCIATE_SIGHTINGS_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "simulate/core/observations.h"
#include "track/detect/blob.h"
#include "track/scratch_file.h"

namespace flocklift {

// An animal as it was seen in one frame.
struct TrackPoint {
  int frame = 0;
  Vec2d position;       // [px]
  double variance = 1;  // per axis [px^2]
  double agility = 1;   // factor on the process noise up to this frame
  Box box;              // of the blob; of an animal like it where the blob is shared [px]
  Edges edges = {};     // of the picture that the blob touches
  Shape shape = {};
  bool shared = false;          // the blob held others too,
  bool hidden = false;          // and could not be told from them
  int blob = -1;                // its number in the frame's blobs
  double given_confidence = 1;  // of a row that somebody else made
};

// The stretches of all animals, one after another.
class SightingFile {
 public:
  explicit SightingFile(const std::filesystem::path& path)
      : file_(path, internal::ScratchFile::Name::kKept) {}

  // Returns where the rows begin. `animal` is its number.
  std::uint64_t Append(std::uint64_t animal, std::span<const TrackPoint> rows);
  void Read(std::uint64_t at, std::span<TrackPoint> rows) const;

  std::uint64_t size() const { return file_.size(); }  // bytes
  // Takes the first `size` bytes of the file for its own. Throws std::runtime_error where they do
  // not end with a stretch.
  using TakeStretch =
      std::function<void(std::uint64_t animal, std::uint64_t at, std::size_t count)>;
  void GoOn(std::uint64_t size, const TakeStretch& take);

 private:
  internal::ScratchFile file_;
};

// One animal's sightings by increasing frame.
class Sightings {
 public:
  Sightings() = default;
  explicit Sightings(std::vector<TrackPoint> rows) { Append(std::move(rows)); }

  // Later ones. The file must outlive what is in it.
  void Append(std::vector<TrackPoint> rows);
  void Append(std::span<const TrackPoint> rows, std::uint64_t animal, SightingFile* file);
  void AppendStored(const SightingFile& file, std::uint64_t at, std::size_t count);
  void Append(Sightings later);
  // Takes what is from `frame` on away.
  Sightings CutFrom(int frame);

  bool empty() const { return stretches_.empty(); }
  std::size_t size() const { return size_; }
  int first_frame() const { return stretches_.front().first; }  // not of none
  int last_frame() const { return stretches_.back().last; }

  std::vector<TrackPoint> All() const;
  std::vector<TrackPoint> Between(int first_frame, int last_frame) const;
  // The last `most` before a frame; the first `most` from a frame on.
  std::vector<TrackPoint> Before(int frame, std::size_t most) const;
  std::vector<TrackPoint> From(int frame, std::size_t most) const;
  std::vector<TrackPoint> First(std::size_t most) const;
  std::vector<TrackPoint> Last(std::size_t most) const;

 private:
  friend class SightingReader;
  struct Stretch {
    int first = 0, last = 0;  // frames
    std::size_t count = 0;
    std::uint64_t at = 0;               // in the file,
    std::vector<TrackPoint> rows = {};  // or in memory
  };

  void Add(Stretch stretch);
  // The rows of a stretch; `buffer` is used where they are in the file.
  std::span<const TrackPoint> RowsOf(const Stretch& stretch, std::vector<TrackPoint>* buffer) const;
  std::size_t FirstStretch(int frame) const;  // of those that reach the frame

  std::vector<Stretch> stretches_;
  std::size_t size_ = 0;
  const SightingFile* file_ = nullptr;
};

// Reads sightings one after another, holding a stretch at a time, as ForEachByFrame
// (simulate/core/animal_rows.h) wants rows. `sightings`, not empty, must outlive it.
class SightingReader {
 public:
  explicit SightingReader(const Sightings& sightings) : sightings_(&sightings) {}

  struct Start {
    int frame = 0;
  };
  bool empty() const { return sightings_->empty(); }
  std::size_t size() const { return sightings_->size(); }
  Start front() const { return {sightings_->first_frame()}; }
  // `k` never decreases.
  const TrackPoint& operator[](std::size_t k) const;
  void Release() const { std::vector<TrackPoint>().swap(buffer_); }

 private:
  const Sightings* sightings_;
  mutable std::vector<TrackPoint> buffer_;
  mutable std::span<const TrackPoint> rows_;      // of the stretch
  mutable std::size_t stretch_ = 0, before_ = 0;  // rows before it
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TRACK_ASSOCIATE_SIGHTINGS_H_
