// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/uncross.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "track/associate/join_cost.h"

namespace flocklift {
namespace {

constexpr int kLongest = 40;         // frames: after a longer one, the past tells little,
                                     // and what was decided on the way stands
constexpr int kBetween = 4;          // frames apart within which shared frames are one encounter
constexpr std::size_t kLook = 12;    // sightings before and after
constexpr std::size_t kLeast = 4;    // of them
constexpr double kMargin = 3;        // by how much the exchange must be likelier (-ln)
constexpr double kLogAreaSd = 0.25;  // of the mean over some sightings
constexpr double kMostAreaCost = 4;
constexpr double kSeenApartFactor = 0.2;  // on the chance of a swap where both could be told

// Two tracks in one blob, frames first .. last.
struct Encounter {
  int a = 0, b = 0;
  int first = 0, last = 0;
};

std::vector<Encounter> FindEncounters(const std::vector<TrackRecord>& tracks) {
  std::map<std::pair<int, int>, std::vector<int>> in_blob;  // (frame, blob) to tracks
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    for (const TrackPoint& s : tracks[t].sightings) {
      if (s.shared) in_blob[{s.frame, s.blob}].push_back(static_cast<int>(t));
    }
  }
  std::map<std::pair<int, int>, Encounter> open;
  std::vector<Encounter> encounters;
  for (const auto& [where, who] : in_blob) {
    for (std::size_t j = 1; j < who.size(); ++j) {
      for (std::size_t i = 0; i < j; ++i) {
        Encounter& e = open[{who[i], who[j]}];
        if (e.last > 0 && where.first - e.last <= kBetween) {
          e.last = where.first;
          continue;
        }
        if (e.last > 0) encounters.push_back(e);
        e = {who[i], who[j], where.first, where.first};
      }
    }
  }
  for (const auto& [pair, e] : open) encounters.push_back(e);
  std::stable_sort(encounters.begin(), encounters.end(),
                   [](const Encounter& x, const Encounter& y) { return x.last < y.last; });
  return encounters;
}

// A track's sightings just before and after an encounter.
struct Side {
  std::span<const TrackPoint> before, after;
  double log_area_before = 0, log_area_after = 0;
  MotionState end, begin;

  bool IsEnough() const { return before.size() >= kLeast && after.size() >= kLeast; }
};

double MeanLogArea(std::span<const TrackPoint> sightings) {
  double sum = 0;
  for (const TrackPoint& s : sightings) sum += std::log(std::max(s.shape.area, 1.0));
  return sum / static_cast<double>(sightings.size());
}

Side Look(const TrackRecord& track, const Encounter& e, const MotionNoise& noise) {
  const auto& s = track.sightings;
  const auto earlier = [](const TrackPoint& p, int frame) { return p.frame < frame; };
  const auto begin = std::lower_bound(s.begin(), s.end(), e.first, earlier);
  const auto end = std::lower_bound(s.begin(), s.end(), e.last + 1, earlier);
  const std::size_t before = std::min<std::size_t>(kLook, begin - s.begin());
  const std::size_t after = std::min<std::size_t>(kLook, s.end() - end);
  Side side;
  side.before = std::span(s).subspan(begin - s.begin() - before, before);
  side.after = std::span(s).subspan(end - s.begin(), after);
  if (!side.IsEnough()) return side;
  side.log_area_before = MeanLogArea(side.before);
  side.log_area_after = MeanLogArea(side.after);
  side.end = StateAtLast(side.before, track.size, noise);
  side.begin = StateAtFirst(side.after, track.size, noise);
  return side;
}

double Cost(const Side& from, const Side& to, double q) {
  const double area = (from.log_area_before - to.log_area_after) / kLogAreaSd;
  return CostOfJoin(from.end, to.begin, q, to.after.front().frame - from.before.back().frame).cost +
         std::min(0.5 * area * area, kMostAreaCost);
}

// Exchanges what two tracks have from `frame` on.
void ExchangeTails(int frame, TrackRecord* a, TrackRecord* b) {
  const auto cut = [frame](std::vector<TrackPoint>* s) {
    const auto from = std::find_if(s->begin(), s->end(),
                                   [frame](const TrackPoint& p) { return p.frame >= frame; });
    std::vector<TrackPoint> tail(from, s->end());
    s->erase(from, s->end());
    return tail;
  };
  const std::vector<TrackPoint> tail_a = cut(&a->sightings), tail_b = cut(&b->sightings);
  a->sightings.insert(a->sightings.end(), tail_b.begin(), tail_b.end());
  b->sightings.insert(b->sightings.end(), tail_a.begin(), tail_a.end());
  // A doubt is about the frames that it names.
  const auto is_later = [frame](const Doubt& d) { return d.first_frame >= frame; };
  std::vector<Doubt> doubts_a, doubts_b;
  std::swap(doubts_a, a->doubts);
  std::swap(doubts_b, b->doubts);
  for (const Doubt& d : doubts_a) (is_later(d) ? b : a)->doubts.push_back(d);
  for (const Doubt& d : doubts_b) (is_later(d) ? a : b)->doubts.push_back(d);
}

// The frame of the encounter in which the two are nearest to each other.
int ClosestFrame(const TrackRecord& a, const TrackRecord& b, const Encounter& e) {
  int closest = e.last;
  double least = 1e300;
  for (const TrackPoint& p : a.sightings) {
    if (p.frame < e.first || p.frame > e.last) continue;
    for (const TrackPoint& q : b.sightings) {
      if (q.frame != p.frame) continue;
      const double d = std::hypot(p.position.x - q.position.x, p.position.y - q.position.y);
      if (d < least) {
        least = d;
        closest = p.frame;
      }
    }
  }
  return closest;
}

bool WasHidden(const TrackRecord& track, const Encounter& e) {
  return std::any_of(track.sightings.begin(), track.sightings.end(), [&e](const TrackPoint& p) {
    return p.hidden && p.frame >= e.first && p.frame <= e.last;
  });
}

// Both tracks are in doubt when the other way round is nearly as likely.
void NoteDoubt(const Encounter& e, const Vec2d& position, double chance, TrackRecord* a,
               TrackRecord* b) {
  if (!WasHidden(*a, e) && !WasHidden(*b, e)) chance *= kSeenApartFactor;
  if (chance < kLeastDoubt) return;
  for (TrackRecord* track : {a, b}) {
    track->doubts.push_back({DoubtKind::kSwap, e.first, e.last, position, chance});
  }
}

// That the other way round would have been right. The costs take sightings for independent and
// overstate it: of encounters on rendered footage with a likelihood share of 0.5, 0.75 and 0.95,
// 0.3, 0.5 and 0.75 were swaps.
double ChanceOf(double cost_taken, double cost_other) {
  const double share = 1 / (1 + std::exp(std::clamp(cost_other - cost_taken, -50.0, 50.0)));
  return 0.8 * std::pow(share, 1.5);
}

}  // namespace

int Uncross(const MotionNoise& noise, std::vector<TrackRecord>* tracks) {
  std::vector<Encounter> encounters = FindEncounters(*tracks);
  int exchanges = 0;
  for (std::size_t k = 0; k < encounters.size(); ++k) {
    const Encounter e = encounters[k];
    TrackRecord &a = (*tracks)[e.a], &b = (*tracks)[e.b];
    const Side x = Look(a, e, noise), y = Look(b, e, noise);
    if (!x.IsEnough() || !y.IsEnough()) continue;
    const double q = noise.ProcessVariance(0.5 * (a.size + b.size));
    const double kept = Cost(x, x, q) + Cost(y, y, q);
    const double exchanged = Cost(x, y, q) + Cost(y, x, q);
    const Vec2d position = x.end.position;
    if (e.last - e.first >= kLongest || exchanged + kMargin >= kept) {
      NoteDoubt(e, position, ChanceOf(kept, exchanged), &a, &b);
      continue;
    }
    ExchangeTails(ClosestFrame(a, b, e), &a, &b);
    NoteDoubt(e, position, ChanceOf(exchanged, kept), &a, &b);
    ++exchanges;
    for (std::size_t later = k + 1; later < encounters.size(); ++later) {
      for (int* who : {&encounters[later].a, &encounters[later].b}) {
        if (*who == e.a) {
          *who = e.b;
        } else if (*who == e.b) {
          *who = e.a;
        }
      }
    }
  }
  return exchanges;
}

}  // namespace flocklift
