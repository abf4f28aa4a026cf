// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/correct.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr double kFilledConfidence = 0.4;

using Rows = std::map<int, Detection>;  // by frame

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
        Swap(&RowsOf(c.id), &RowsOf(c.other_id), Frame(c.first_frame));
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
      case Correction::Kind::kPin: {
        Rows& rows = RowsOf(c.id);
        const Detection& like = Nearest(rows, Frame(c.first_frame));
        Put(c, like.box.width, like.box.height, &rows);
        Fill(&rows, c.first_frame);
        break;
      }
      case Correction::Kind::kAdd: {
        const auto [width, height] = UsualSize(Frame(c.first_frame));
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

  static void Swap(Rows* a, Rows* b, int frame) {
    const auto cut = [frame](Rows* rows) {
      Rows tail(rows->lower_bound(frame), rows->end());
      rows->erase(rows->lower_bound(frame), rows->end());
      return tail;
    };
    Rows tail_a = cut(a), tail_b = cut(b);
    a->merge(tail_b);
    b->merge(tail_a);
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
    Fill(&rows, from);
    Fill(&rows, to);
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

  static const Detection& Nearest(const Rows& rows, int frame) {
    auto after = rows.lower_bound(frame);
    if (after == rows.end()) return rows.rbegin()->second;
    if (after == rows.begin()) return after->second;
    const auto before = std::prev(after);
    return frame - before->first <= after->first - frame ? before->second : after->second;
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

  // Interpolates between the row of `frame` and the rows before and after it.
  static void Fill(Rows* rows, int frame) {
    const auto at = rows->find(frame);
    const auto between = [rows](const Detection& a, const Detection& b) {
      for (int f = a.frame + 1; f < b.frame; ++f) {
        const double w = static_cast<double>(f - a.frame) / (b.frame - a.frame);
        Detection row;
        row.frame = f;
        row.box = {a.box.left + w * (b.box.left - a.box.left),
                   a.box.top + w * (b.box.top - a.box.top),
                   a.box.width + w * (b.box.width - a.box.width),
                   a.box.height + w * (b.box.height - a.box.height)};
        row.confidence = kFilledConfidence;
        rows->emplace(f, row);
      }
    };
    const Detection here = at->second;
    if (at != rows->begin()) between(std::prev(at)->second, here);
    const auto after = rows->upper_bound(frame);
    if (after != rows->end()) between(here, after->second);
  }

  std::string file_;
  int frame_count_ = 0;
  int line_ = 0;
  Id next_id_;
  std::map<Id, Rows> rows_;
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
