// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/associate/uncross.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "simulate/core/animal_rows.h"
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

using Sharer = std::pair<int, int>;  // blob, track

// As ForEachByFrame wants an animal.
struct Told {
  Id id = 0;  // the track's place in the list
  SightingReader sightings;
};

std::vector<Encounter> FindEncounters(const std::vector<TrackRecord>& tracks) {
  std::map<std::pair<int, int>, Encounter> open;
  std::vector<Encounter> encounters;
  int now = 0;
  std::vector<Sharer> sharers;  // in the frame
  const auto meet = [&] {
    std::sort(sharers.begin(), sharers.end());
    for (std::size_t j = 1; j < sharers.size(); ++j) {
      std::size_t i = j;
      while (i > 0 && sharers[i - 1].first == sharers[j].first) --i;
      for (; i < j; ++i) {
        const int a = sharers[i].second, b = sharers[j].second;
        Encounter& e = open[{a, b}];
        if (e.last > 0 && now - e.last <= kBetween) {
          e.last = now;
          continue;
        }
        if (e.last > 0) encounters.push_back(e);
        e = {a, b, now, now};
      }
    }
    sharers.clear();
  };
  std::vector<Told> told;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    told.push_back({static_cast<Id>(t), SightingReader(tracks[t].sightings)});
  }
  internal::ForEachByFrame(
      told, [](const Told& one) -> const SightingReader& { return one.sightings; },
      [&](Id track, const TrackPoint& s) {
        if (s.frame != now) meet();
        now = s.frame;
        if (s.shared) sharers.emplace_back(s.blob, static_cast<int>(track));
      });
  meet();
  for (const auto& [pair, e] : open) encounters.push_back(e);
  std::stable_sort(encounters.begin(), encounters.end(),
                   [](const Encounter& x, const Encounter& y) { return x.last < y.last; });
  return encounters;
}

// A track's sightings just before and after an encounter.
struct Side {
  std::vector<TrackPoint> before, after;
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
  Side side;
  side.before = track.sightings.Before(e.first, kLook);
  side.after = track.sightings.From(e.last + 1, kLook);
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
  Sightings tail_a = a->sightings.CutFrom(frame), tail_b = b->sightings.CutFrom(frame);
  a->sightings.Append(std::move(tail_b));
  b->sightings.Append(std::move(tail_a));
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
  const std::vector<TrackPoint> of_b = b.sightings.Between(e.first, e.last);
  for (const TrackPoint& p : a.sightings.Between(e.first, e.last)) {
    for (const TrackPoint& q : of_b) {
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
  const std::vector<TrackPoint> then = track.sightings.Between(e.first, e.last);
  return std::any_of(then.begin(), then.end(), [](const TrackPoint& p) { return p.hidden; });
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
