// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/tracklet_file.h"

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

#include "simulate/core/animal_rows.h"
#include "simulate/core/check.h"
#include "simulate/core/io.h"

namespace flocklift {
namespace {

constexpr std::size_t kBlock = 64;  // rows that are read together

static_assert(std::is_trivially_copyable_v<Detection>);

}  // namespace

// The rows of one tracklet, a block at a time, as ForEachByFrame (simulate/core/animal_rows.h)
// wants them.
class TrackletFile::Rows {
 public:
  Rows(const internal::ScratchFile& file, const Place& place)
      : id(place.id), file_(&file), place_(&place) {}

  struct Start {
    int frame = 0;
  };
  bool empty() const { return place_->count == 0; }
  std::size_t size() const { return place_->count; }
  Start front() const { return {place_->first_frame}; }
  // `k` never decreases.
  const Detection& operator[](std::size_t k) const {
    if (block_.empty() || k >= first_ + block_.size()) {
      first_ = k;
      block_.resize(std::min(kBlock, place_->count - k));
      file_->Read(place_->at + k * sizeof(Detection), std::as_writable_bytes(std::span(block_)));
    }
    return block_[k - first_];
  }
  void Release() const { std::vector<Detection>().swap(block_); }

  Id id;

 private:
  const internal::ScratchFile* file_;
  const Place* place_;
  mutable std::vector<Detection> block_;
  mutable std::size_t first_ = 0;  // of the block
};

void TrackletFile::Add(const Tracklet& tracklet) {
  FLOCKLIFT_DCHECK(places_.empty() || places_.back().id < tracklet.id);
  Place place{tracklet.id, 0, tracklet.detections.size()};
  if (place.count > 0) {
    place.at = file_.Append(std::as_bytes(std::span(tracklet.detections)));
    place.first_frame = tracklet.detections.front().frame;
    place.last_frame = tracklet.detections.back().frame;
    last_frame_ = std::max(last_frame_, place.last_frame);
  }
  places_.push_back(place);
}

void TrackletFile::Clear() {
  file_.GoOn(0);
  places_.clear();
  last_frame_ = 0;
}

void TrackletFile::ForEachByFrame(const std::function<void(Id, const Detection&)>& take) const {
  std::vector<Rows> all;
  all.reserve(places_.size());
  for (const Place& place : places_) all.emplace_back(file_, place);
  internal::ForEachByFrame(
      all, [](const Rows& rows) -> const Rows& { return rows; }, take);
}

std::size_t TrackletFile::FirstFrom(const Place& place, int frame) const {
  std::size_t low = 0, high = place.count;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    Detection row;
    file_.Read(place.at + middle * sizeof row, std::as_writable_bytes(std::span(&row, 1)));
    if (row.frame < frame) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

Tracks TrackletFile::Between(int first_frame, int last_frame) const {
  Tracks tracks;
  for (const Place& place : places_) {
    if (place.count == 0 || place.last_frame < first_frame || place.first_frame > last_frame) {
      continue;
    }
    Tracklet tracklet{place.id, {}};
    const Rows rows(file_, place);
    for (std::size_t k = FirstFrom(place, first_frame);
         k < rows.size() && rows[k].frame <= last_frame; ++k) {
      tracklet.detections.push_back(rows[k]);
    }
    if (!tracklet.detections.empty()) tracks.tracklets.push_back(std::move(tracklet));
  }
  return tracks;
}

std::vector<Tracklet> TrackletFile::All() const {
  std::vector<Tracklet> tracklets;
  for (const Place& place : places_) {
    tracklets.push_back({place.id, std::vector<Detection>(place.count)});
    file_.Read(place.at, std::as_writable_bytes(std::span(tracklets.back().detections)));
  }
  return tracklets;
}

void WriteTracksAndShapes(const std::filesystem::path& tracks, const std::filesystem::path& shapes,
                          std::optional<double> fps, const TrackletFile& file) {
  TrackWriter track_writer(tracks, fps);
  ShapeWriter shape_writer(shapes, fps);
  file.ForEachByFrame([&](Id id, const Detection& detection) {
    track_writer.Add(id, detection);
    shape_writer.Add(id, detection);
  });
  track_writer.Commit();
  shape_writer.Commit();
}

}  // namespace flocklift
