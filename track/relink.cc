// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/relink.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

namespace flocklift::internal {
namespace {

constexpr double kFilledConfidence = 0.4;
constexpr double kLeastReach = 2;     // [px]: a click is no better
constexpr double kReachOverStep = 3;  // an animal may move so many times faster than it does
constexpr double kBreakCost = 9;      // of 3 sds
constexpr int kMotionFrames = 4;      // rows before a frame that tell the motion there

double SizeOf(const Detection& d) { return std::max(std::hypot(d.box.width, d.box.height), 1.0); }

double Distance(const Vec2d& a, const Vec2d& b) { return std::hypot(a.x - b.x, a.y - b.y); }

// Where an animal is that is clicked at `p`.
bool Holds(const Detection& d, const Vec2d& p) {
  return Distance(d.box.Center(), p) <= std::max(0.5 * SizeOf(d), kLeastReach);
}

// Squared distance, in sizes and frames, of `to`'s first row from frame `f` on from where `from`'s
// motion before `f` leads. A path that only begins costs nothing, one that breaks off does.
double CostOfTurn(const TrackRows& from, const TrackRows& to, int f) {
  const auto next = to.lower_bound(f);
  auto last = from.lower_bound(f);
  if (last == from.begin()) return 0;
  if (next == to.end()) return kBreakCost;
  --last;
  auto first = last;
  for (int k = 1; k < kMotionFrames && first != from.begin(); ++k) --first;
  Vec2d v{};
  if (first != last) {
    const double frames = last->first - first->first;
    const Vec2d p = first->second.box.Center(), q = last->second.box.Center();
    v = {(q.x - p.x) / frames, (q.y - p.y) / frames};
  }
  const double gap = next->first - last->first;
  const Vec2d at = last->second.box.Center();
  const double d = Distance(next->second.box.Center(), {at.x + v.x * gap, at.y + v.y * gap});
  const double sd = 0.5 * SizeOf(last->second) * gap;
  return d * d / (sd * sd);
}

// The frame in first .. last at which a and b exchange places at the least cost; the latest one
// where several are equal.
int BestExchange(const TrackRows& a, const TrackRows& b, int first, int last) {
  int best = last;
  double least = std::numeric_limits<double>::infinity();
  for (int f = last; f >= first; --f) {
    const double cost = CostOfTurn(a, b, f) + CostOfTurn(b, a, f);
    if (cost >= least) continue;
    least = cost;
    best = f;
  }
  return best;
}

// Median distance between rows of consecutive frames [px].
double UsualStep(const TrackRows& rows) {
  std::vector<double> steps;
  for (auto it = rows.begin(); it != rows.end() && std::next(it) != rows.end(); ++it) {
    const auto next = std::next(it);
    if (next->first == it->first + 1) {
      steps.push_back(Distance(it->second.box.Center(), next->second.box.Center()));
    }
  }
  if (steps.empty()) return 0;
  std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
  return steps[steps.size() / 2];
}

// Takes the rows beside the pin from which it cannot be reached, up to the pins before and after.
void GiveUnreachable(const Pin& pin, int before, int after, TrackRows* rows, TrackRows* others) {
  const double step = kReachOverStep * UsualStep(*rows);
  const auto is_reachable = [&](const Detection& d) {
    const double reach = std::max(step * std::abs(d.frame - pin.frame), SizeOf(d));
    return Distance(d.box.Center(), pin.point) <= reach;
  };
  std::vector<int> given;
  for (auto it = std::make_reverse_iterator(rows->lower_bound(pin.frame));
       it != rows->rend() && it->first > before && !is_reachable(it->second); ++it) {
    given.push_back(it->first);
  }
  for (auto it = rows->upper_bound(pin.frame);
       it != rows->end() && it->first < after && !is_reachable(it->second); ++it) {
    given.push_back(it->first);
  }
  const auto own = rows->find(pin.frame);
  if (own != rows->end() && !given.empty() && !is_reachable(own->second)) {
    given.push_back(pin.frame);
  }
  for (const int frame : given) {
    const Detection& d = rows->at(frame);
    if (d.confidence >= kMeasuredConfidence) others->emplace(frame, d);
    rows->erase(frame);
  }
}

// The other animal that stands where the pin is.
std::optional<Id> WhoIsThere(Id id, const Pin& pin, const std::map<Id, TrackRows>& tracks) {
  std::optional<Id> who;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [other, rows] : tracks) {
    const auto row = rows.find(pin.frame);
    if (other == id || row == rows.end() || !Holds(row->second, pin.point)) continue;
    const double d = Distance(row->second.box.Center(), pin.point);
    if (d >= nearest) continue;
    nearest = d;
    who = other;
  }
  return who;
}

const Detection& NearestRow(const TrackRows& rows, int frame) {
  const auto after = rows.lower_bound(frame);
  if (after == rows.end()) return rows.rbegin()->second;
  if (after == rows.begin()) return after->second;
  const auto before = std::prev(after);
  return frame - before->first <= after->first - frame ? before->second : after->second;
}

}  // namespace

void SwapRows(int frame, TrackRows* a, TrackRows* b) {
  const auto cut = [frame](TrackRows* rows) {
    TrackRows tail(rows->lower_bound(frame), rows->end());
    rows->erase(rows->lower_bound(frame), rows->end());
    return tail;
  };
  TrackRows tail_a = cut(a), tail_b = cut(b);
  a->merge(tail_b);
  b->merge(tail_a);
}

void FillBeside(int frame, TrackRows* rows) {
  const auto at = rows->find(frame);
  if (at == rows->end()) return;
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

void Relink(Id id, const Pin& pin, const std::set<int>& pinned, std::map<Id, TrackRows>* tracks,
            Id* next_id) {
  TrackRows& rows = tracks->at(id);
  const auto next_pin = pinned.upper_bound(pin.frame);
  const auto this_pin = pinned.lower_bound(pin.frame);
  const int before = this_pin == pinned.begin() ? 0 : *std::prev(this_pin);
  const int after = next_pin == pinned.end() ? std::numeric_limits<int>::max() : *next_pin;

  const auto own = rows.find(pin.frame);
  const bool is_near = own != rows.end() && Holds(own->second, pin.point);
  const std::optional<Id> other = is_near ? std::nullopt : WhoIsThere(id, pin, *tracks);
  std::optional<Detection> like;
  if (other) {
    TrackRows& theirs = tracks->at(*other);
    like = theirs.at(pin.frame);
    const int earliest = std::max({before + 1, rows.begin()->first + 1, theirs.begin()->first});
    const int there = BestExchange(rows, theirs, std::min(earliest, pin.frame), pin.frame);
    SwapRows(there, &rows, &theirs);
    FillBeside(pin.frame, &rows);
    if (rows.contains(there)) FillBeside(there, &rows);
    if (after != std::numeric_limits<int>::max()) {
      const int back = BestExchange(rows, theirs, pin.frame + 1, after);
      SwapRows(back, &rows, &theirs);
    }
    if (theirs.empty()) tracks->erase(*other);
  } else if (!is_near) {
    TrackRows others;
    GiveUnreachable(pin, before, after, &rows, &others);
    if (!others.empty()) (*tracks)[(*next_id)++] = std::move(others);
  }
  TrackRows& mended = tracks->at(id);
  if (!like && !mended.empty()) like = NearestRow(mended, pin.frame);
  Detection row;
  row.frame = pin.frame;
  row.box = Box::Around(pin.point, like ? like->box.width : 8, like ? like->box.height : 8);
  mended[pin.frame] = row;
  FillBeside(pin.frame, &mended);
}

}  // namespace flocklift::internal
