// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/suspects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "simulate/core/trajectory.h"

namespace flocklift {
namespace {

constexpr double kLeastJump = 8;     // robust sds
constexpr double kJumpOfSize = 0.4;  // and so much of the box
constexpr int kLook = 4;             // frames before and after a meeting
constexpr int kSameEvent = 15;       // frames
constexpr int kBandsPerPicture = 256;

// The middle of its box, with z = 0.
Vec3d PlaceOf(const Detection& d) {
  const Vec2d p = d.box.Center();
  return {p.x, p.y, 0};
}

double SizeOf(const Detection& d) { return std::max(d.box.width, d.box.height); }

const Detection* RowAt(const Tracklet& tracklet, int frame) {
  const auto& d = tracklet.detections;
  const auto at = std::lower_bound(d.begin(), d.end(), frame,
                                   [](const Detection& a, int f) { return a.frame < f; });
  return at != d.end() && at->frame == frame ? &*at : nullptr;
}

double Median(std::vector<double>* values) {
  if (values->empty()) return 0;
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

// Change of the motion at row k of a track: |x[k+1] - 2 x[k] + x[k-1]|, where frames follow.
std::optional<double> Bend(const Tracklet& t, std::size_t k) {
  if (k == 0 || k + 1 >= t.detections.size()) return std::nullopt;
  const Detection &a = t.detections[k - 1], &b = t.detections[k], &c = t.detections[k + 1];
  if (b.frame - a.frame != 1 || c.frame - b.frame != 1) return std::nullopt;
  return Norm(PlaceOf(c) - 2.0 * PlaceOf(b) + PlaceOf(a));
}

void FindJumps(const TrackList& tracks, std::vector<Suspect>* suspects) {
  std::vector<double> bends;
  for (const auto& shared : tracks) {
    const Tracklet& t = *shared;
    for (std::size_t k = 1; k + 1 < t.detections.size(); ++k) {
      if (const auto bend = Bend(t, k)) bends.push_back(*bend);
    }
  }
  // Of a two-dimensional normal vector the median length is 1.18 sds.
  const double sd = std::max(Median(&bends) / 1.1774, 1e-3);
  for (const auto& shared : tracks) {
    const Tracklet& t = *shared;
    for (std::size_t k = 1; k + 1 < t.detections.size(); ++k) {
      const auto bend = Bend(t, k);
      if (!bend || *bend < kLeastJump * sd || *bend < kJumpOfSize * SizeOf(t.detections[k])) {
        continue;
      }
      suspects->push_back(
          {t.detections[k].frame, t.id, 0, "jump", 0.75 * (1 - kLeastJump * sd / *bend)});
    }
  }
}

void FindGaps(const TrackList& tracks, std::vector<Suspect>* suspects) {
  for (const auto& shared : tracks) {
    const Tracklet& t = *shared;
    int run = 0;
    for (std::size_t k = 0; k <= t.detections.size(); ++k) {
      if (k < t.detections.size() && t.detections[k].confidence < kMeasuredConfidence) {
        ++run;
        continue;
      }
      if (run > 0) {
        const Detection& middle = t.detections[k - 1 - static_cast<std::size_t>(run) / 2];
        suspects->push_back({middle.frame, t.id, 0, "gap", 0.7 * (1 - std::exp(-run / 8.0))});
      }
      run = 0;
    }
  }
}

void FindEnds(const TrackList& tracks, double width, double height,
              std::vector<Suspect>* suspects) {
  FrameSpan span;
  for (const auto& t : tracks) {
    if (t->detections.empty()) continue;
    const int first = t->detections.front().frame, last = t->detections.back().frame;
    span = span.last < span.first
               ? FrameSpan{first, last}
               : FrameSpan{std::min(span.first, first), std::max(span.last, last)};
  }
  const auto add = [&](const Tracklet& t, const Detection& d, const char* what) {
    const Vec2d p = d.box.Center();
    const double to_edge = std::min({p.x, p.y, width - 1 - p.x, height - 1 - p.y});
    const double doubt =
        0.5 * (1 - std::exp(-std::max(0.0, to_edge / std::max(SizeOf(d), 1.0) - 1) / 2));
    if (doubt > 0.02) suspects->push_back({d.frame, t.id, 0, what, doubt});
  };
  for (const auto& shared : tracks) {
    const Tracklet& t = *shared;
    if (t.detections.empty()) continue;
    if (t.detections.front().frame > span.first) add(t, t.detections.front(), "start");
    if (t.detections.back().frame < span.last) add(t, t.detections.back(), "end");
  }
}

// How much straighter the two paths become when they change places at `frame`, in [0, 1].
double GainOfExchange(const Tracklet& a, const Tracklet& b, int frame) {
  const Detection *a0 = RowAt(a, frame - kLook), *a1 = RowAt(a, frame),
                  *a2 = RowAt(a, frame + kLook);
  const Detection *b0 = RowAt(b, frame - kLook), *b1 = RowAt(b, frame),
                  *b2 = RowAt(b, frame + kLook);
  if (!a0 || !a1 || !a2 || !b0 || !b1 || !b2) return 0;
  const auto bend = [](const Detection* x, const Detection* y, const Detection* z) {
    return Norm(PlaceOf(*z) - 2.0 * PlaceOf(*y) + PlaceOf(*x));
  };
  const double kept = bend(a0, a1, a2) + bend(b0, b1, b2);
  const double exchanged = bend(a0, a1, b2) + bend(b0, b1, a2);
  return kept > 0 ? std::clamp(1 - exchanged / kept, 0.0, 1.0) : 0;
}

// Pairs that are near in a frame, by bands of columns: not all against all.
void FindMeetings(const TrackList& tracks, double width, const Progress& alive,
                  std::vector<Suspect>* suspects) {
  struct Row {
    double u = 0;
    const Detection* detection = nullptr;
    const Tracklet* tracklet = nullptr;
  };
  std::map<int, std::vector<Row>> frames;
  for (const auto& t : tracks) {
    for (const Detection& d : t->detections) {
      frames[d.frame].push_back({d.box.Center().x, &d, t.get()});
    }
  }
  struct Nearest {
    double ratio = 2;
    int frame = 0, last = -kSameEvent;
  };
  std::map<std::pair<Id, Id>, Nearest> meetings;
  std::map<Id, const Tracklet*> by_id;
  for (const auto& t : tracks) by_id[t->id] = t.get();
  const auto close = [&](const std::pair<Id, Id>& pair, const Nearest& n) {
    const double gain = GainOfExchange(*by_id[pair.first], *by_id[pair.second], n.frame);
    const double near = 0.9 * std::exp(-2 * n.ratio);
    suspects->push_back({n.frame, pair.first, pair.second, "meeting", near + (1 - near) * gain});
  };
  const double widest = width / kBandsPerPicture;
  for (auto& [frame, rows] : frames) {
    if (alive) alive(frame, frames.rbegin()->first);
    std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
      return std::tie(a.u, a.tracklet->id) < std::tie(b.u, b.tracklet->id);
    });
    double largest = widest;
    for (const Row& row : rows) largest = std::max(largest, SizeOf(*row.detection));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = i + 1; j < rows.size() && rows[j].u - rows[i].u < largest; ++j) {
        const Detection &a = *rows[i].detection, &b = *rows[j].detection;
        const double size = std::max({SizeOf(a), SizeOf(b), 1.0});
        const double ratio = Norm(PlaceOf(a) - PlaceOf(b)) / size;
        if (ratio >= 1) continue;
        const auto [low, high] = std::minmax(rows[i].tracklet->id, rows[j].tracklet->id);
        Nearest& nearest = meetings[{low, high}];
        if (frame - nearest.last > kSameEvent) {
          if (nearest.frame > 0) close({low, high}, nearest);
          nearest = {};
        }
        nearest.last = frame;
        if (ratio < nearest.ratio) {
          nearest.ratio = ratio;
          nearest.frame = frame;
        }
      }
    }
  }
  for (const auto& [pair, nearest] : meetings) close(pair, nearest);
}

// Whether a correction answers the doubt, which lasts until frame `last`; else its ids become those
// that its animals have now.
bool DealtWith(const std::vector<Correction>& corrections, int last, Suspect* s) {
  using Kind = Correction::Kind;
  for (const Correction& c : corrections) {
    const auto is_of = [&](Id id) { return id != 0 && (id == s->id || id == s->other_id); };
    const bool is_near =
        c.first_frame >= s->frame - kSameEvent && c.first_frame <= last + kSameEvent;
    switch (c.kind) {
      case Kind::kSwap:
        if (is_near && is_of(c.id) && is_of(c.other_id)) return true;
        if (s->frame >= c.first_frame) {
          const auto now = [&](Id id) {
            return id == c.id ? c.other_id : id == c.other_id ? c.id : id;
          };
          s->id = now(s->id);
          s->other_id = now(s->other_id);
        }
        break;
      case Kind::kJoin:
        if (is_of(c.id) && is_of(c.other_id)) return true;
        if (s->id == c.other_id) s->id = c.id;
        if (s->other_id == c.other_id) s->other_id = c.id;
        break;
      case Kind::kDelete:
        if (is_of(c.id) &&
            (c.first_frame == 0 || (c.first_frame <= last && c.last_frame >= s->frame)))
          return true;
        break;
      case Kind::kSplit:
      case Kind::kPin:
        if (is_near && is_of(c.id)) return true;
        break;
      case Kind::kAdd:
        break;
    }
  }
  return false;
}

}  // namespace

std::vector<Suspect> FindSuspects(const TrackList& tracks, double image_width, double image_height,
                                  const Progress& alive, std::size_t most) {
  std::vector<Suspect> all;
  FindMeetings(tracks, image_width, alive, &all);
  FindJumps(tracks, &all);
  FindGaps(tracks, &all);
  FindEnds(tracks, image_width, image_height, &all);
  std::sort(all.begin(), all.end(), [](const Suspect& a, const Suspect& b) {
    return std::tie(b.doubt, a.frame, a.id, a.other_id) <
           std::tie(a.doubt, b.frame, b.id, b.other_id);
  });
  std::vector<Suspect> kept;
  std::map<Id, std::vector<int>> taken;  // frames of what is kept
  for (const Suspect& s : all) {
    if (kept.size() == most) break;
    const auto known = [&](Id id) {
      const auto& frames = taken[id];
      return std::any_of(frames.begin(), frames.end(),
                         [&](int f) { return std::abs(f - s.frame) <= kSameEvent; });
    };
    if (known(s.id) && (s.other_id == 0 || known(s.other_id))) continue;
    kept.push_back(s);
    taken[s.id].push_back(s.frame);
    if (s.other_id != 0) taken[s.other_id].push_back(s.frame);
  }
  return kept;
}

std::vector<Suspect> SuspectsOfTracker(const nlohmann::ordered_json& list,
                                       const std::vector<Correction>& corrections) {
  std::vector<Suspect> suspects;
  for (const auto& entry : list) {
    Suspect s;
    int last = 0;
    try {
      const auto& ids = entry.at("ids");
      s = {.frame = entry.at("frame").get<int>(),
           .id = ids.at(0).get<Id>(),
           .other_id = ids.size() > 1 ? ids.at(1).get<Id>() : 0,
           .what = entry.at("kind").get<std::string>(),
           .doubt = entry.at("chance").get<double>()};
      last = entry.value("last_frame", s.frame);
    } catch (const nlohmann::json::exception&) {
      continue;  // of another version
    }
    if (!DealtWith(corrections, last, &s)) suspects.push_back(s);
  }
  return suspects;
}

}  // namespace flocklift
