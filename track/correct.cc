// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/correct.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "simulate/core/check.h"
#include "track/relink.h"

namespace flocklift {
namespace {

using Rows = internal::TrackRows;

class Corrector {
 public:
  Corrector(const std::string& file, int frame_count, Id next_id, const Tracks& tracks)
      : file_(file), frame_count_(frame_count), next_id_(next_id) {
    for (const Tracklet& tracklet : tracks.tracklets) {
      Rows& rows = rows_[tracklet.id];
      for (const Detection& detection : tracklet.detections) {
        rows.emplace(detection.frame, detection);
      }
      next_id_ = std::max(next_id_, tracklet.id + 1);
    }
  }

  void Apply(const Correction& c) {
    line_ = c.line;
    switch (c.kind) {
      case Correction::Kind::kSwap:
        Swap(c.id, c.other_id, Frame(c.first_frame));
        break;
      case Correction::Kind::kSplit:
        Split(c.id, Frame(c.first_frame));
        break;
      case Correction::Kind::kJoin:
        Join(c.id, c.other_id);
        break;
      case Correction::Kind::kDelete:
        Delete(c);
        break;
      case Correction::Kind::kPin:
        RowsOf(c.id);
        internal::Relink(c.id, {Frame(c.first_frame), c.point}, pinned_[c.id], &rows_, &next_id_);
        pinned_[c.id].insert(c.first_frame);
        break;
      case Correction::Kind::kAdd: {
        const auto [width, height] = UsualSize(Frame(c.first_frame));
        pinned_[next_id_].insert(c.first_frame);
        Put(c, width, height, &rows_[next_id_++]);
        break;
      }
    }
  }

  Id next_id() const { return next_id_; }

  Tracks Result(std::optional<double> fps) const {
    Tracks tracks;
    tracks.fps = fps;
    for (const auto& [id, rows] : rows_) {
      if (rows.empty()) continue;
      Tracklet tracklet{id, {}};
      for (const auto& [frame, detection] : rows) tracklet.detections.push_back(detection);
      tracks.tracklets.push_back(std::move(tracklet));
    }
    return tracks;
  }

 private:
  [[noreturn]] void Fail(const std::string& fault, const std::string& mend) const {
    throw InputError(file_, line_, fault, mend);
  }

  Rows& RowsOf(Id id) {
    const auto it = rows_.find(id);
    if (it == rows_.end() || it->second.empty()) {
      Fail("there is no track " + std::to_string(id),
           "name a track of tracks.csv, or one made above");
    }
    return it->second;
  }

  int Frame(int frame) const {
    if (frame < 1 || frame > frame_count_) {
      Fail("there is no frame " + std::to_string(frame),
           "the footage has frames 1 to " + std::to_string(frame_count_));
    }
    return frame;
  }

  void Swap(Id a, Id b, int frame) {
    internal::SwapRows(frame, &RowsOf(a), &RowsOf(b));
    const auto cut = [frame](std::set<int>* pins) {
      const std::set<int> tail(pins->lower_bound(frame), pins->end());
      pins->erase(pins->lower_bound(frame), pins->end());
      return tail;
    };
    std::set<int>&pins_a = pinned_[a], &pins_b = pinned_[b];
    const std::set<int> tail_a = cut(&pins_a), tail_b = cut(&pins_b);
    pins_a.insert(tail_b.begin(), tail_b.end());
    pins_b.insert(tail_a.begin(), tail_a.end());
  }

  void Split(Id id, int frame) {
    Rows& rows = RowsOf(id);
    if (frame <= rows.begin()->first || frame > rows.rbegin()->first) {
      Fail("track " + std::to_string(id) + " cannot be split at frame " + std::to_string(frame),
           "it has frames " + std::to_string(rows.begin()->first) + " to " +
               std::to_string(rows.rbegin()->first));
    }
    Rows& tail = rows_[next_id_++];
    Rows& head = rows_[id];
    tail = Rows(head.lower_bound(frame), head.end());
    head.erase(head.lower_bound(frame), head.end());
    std::set<int>& pins = pinned_[id];
    pinned_[next_id_ - 1].insert(pins.lower_bound(frame), pins.end());
    pins.erase(pins.lower_bound(frame), pins.end());
  }

  void Join(Id id, Id other_id) {
    Rows& rows = RowsOf(id);
    Rows& other = RowsOf(other_id);
    const int from = other.begin()->first, to = other.rbegin()->first;
    for (auto& [frame, detection] : other) {
      const auto [it, is_new] = rows.emplace(frame, detection);
      if (is_new || detection.confidence < kMeasuredConfidence) continue;
      if (it->second.confidence >= kMeasuredConfidence) {
        Fail("tracks " + std::to_string(id) + " and " + std::to_string(other_id) +
                 " were both seen in frame " + std::to_string(frame),
             "split or delete one of them there first");
      }
      it->second = detection;
    }
    other.clear();
    internal::FillBeside(from, &rows);
    internal::FillBeside(to, &rows);
    pinned_[id].merge(pinned_[other_id]);
  }

  void Delete(const Correction& c) {
    Rows& rows = RowsOf(c.id);
    if (c.first_frame == 0) {
      rows.clear();
      return;
    }
    const auto first = rows.lower_bound(Frame(c.first_frame));
    const auto end = rows.upper_bound(Frame(c.last_frame));
    if (first == end) {
      Fail("track " + std::to_string(c.id) + " has no row in frames " +
               std::to_string(c.first_frame) + " to " + std::to_string(c.last_frame),
           "it has frames " + std::to_string(rows.begin()->first) + " to " +
               std::to_string(rows.rbegin()->first));
    }
    rows.erase(first, end);
  }

  // Median box of the frame's animals; of all animals where the frame has none.
  std::pair<double, double> UsualSize(int frame) const {
    std::vector<double> widths, heights;
    for (const bool anywhere : {false, true}) {
      for (const auto& [id, rows] : rows_) {
        for (const auto& [f, detection] : rows) {
          if (!anywhere && f != frame) continue;
          widths.push_back(detection.box.width);
          heights.push_back(detection.box.height);
        }
      }
      if (!widths.empty()) break;
    }
    const auto median = [](std::vector<double>* values) {
      if (values->empty()) return 8.0;
      std::nth_element(values->begin(), values->begin() + values->size() / 2, values->end());
      return (*values)[values->size() / 2];
    };
    return {median(&widths), median(&heights)};
  }

  static void Put(const Correction& c, double width, double height, Rows* rows) {
    Detection detection;
    detection.frame = c.first_frame;
    detection.box = Box::Around(c.point, width, height);
    (*rows)[c.first_frame] = detection;
  }

  std::string file_;
  int frame_count_ = 0;
  int line_ = 0;
  Id next_id_;
  std::map<Id, Rows> rows_;
  std::map<Id, std::set<int>> pinned_;  // frames in which a person has said where the animal is
};

}  // namespace

void ApplyCorrections(std::span<const Correction> corrections, const std::string& file,
                      int frame_count, Tracks* tracks, Id* next_id) {
  Corrector corrector(file, frame_count, next_id != nullptr ? *next_id : 1, *tracks);
  for (const Correction& correction : corrections) corrector.Apply(correction);
  if (next_id != nullptr) *next_id = corrector.next_id();
  *tracks = corrector.Result(tracks->fps);
}

}  // namespace flocklift
