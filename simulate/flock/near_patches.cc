// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/near_patches.h"

#include <algorithm>
#include <atomic>

#include "simulate/flock/close_table.h"
#include "simulate/flock/company.h"

namespace flocklift {
namespace {

constexpr std::size_t kFewPieces = 4;                      // are one patch, if fewer
constexpr std::size_t kLeastPieces = 5, kMostPieces = 64;  // in a patch of four, of more
constexpr double kReachMargin = 1.01;                      // round-off
constexpr std::size_t kMostTouching = 8;  // pieces of others near a patch, for each of its own

// The more patches, the more of the flock is in reach of two; the fewer, the longer a thread may
// wait for the last. Even, so that two threads have as many each.
std::size_t PatchCount(std::size_t pieces) {
  if (pieces < kFewPieces) return 1;
  const std::size_t wanted =
      std::max(std::min<std::size_t>(pieces / kLeastPieces, 4), pieces / kMostPieces);
  return std::max<std::size_t>(1, wanted / 2) * 2;
}

template <typename T>
CrowdBox<T> Grown(const CrowdBox<T>& box, T by) {
  const Vec3<T> margin{by, by, by};
  return {box.low - margin, box.high + margin};
}

template <typename T>
bool Touch(const CrowdBox<T>& a, const CrowdBox<T>& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

// Animals of other patches, copied.
template <typename T>
struct Others {
  std::vector<T> x, y, z, room;
  std::vector<std::uint32_t> animal;

  void Clear() {
    for (std::vector<T>* column : {&x, &y, &z, &room}) column->clear();
    animal.clear();
  }
  // Those that are in the box.
  void Add(const Crowd<T>& some, std::uint32_t first, const CrowdBox<T>& box) {
    for (std::size_t k = 0; k < some.size; ++k) {
      const T at_x = some.x[k], at_y = some.y[k], at_z = some.z[k];
      const bool in = (at_x >= box.low.x) & (at_x <= box.high.x) & (at_y >= box.low.y) &
                      (at_y <= box.high.y) & (at_z >= box.low.z) & (at_z <= box.high.z);
      if (!in) continue;
      x.push_back(at_x);
      y.push_back(at_y);
      z.push_back(at_z);
      room.push_back(some.RoomOf(k));
      animal.push_back(first + static_cast<std::uint32_t>(k));
    }
  }
  Crowd<T> AsCrowd() { return {x.size(), x.data(), y.data(), z.data(), T(0), room.data()}; }
};

}  // namespace

// What searching one takes, kept by each thread.
template <typename T>
struct NearPatches<T>::Patch {
  std::vector<Crowd<T>> crowds;
  Others<T> others;
  Company<T> company;
  CloseTable<T> table;
};

template <typename T>
bool NearPatches<T>::Search(std::span<const CrowdBox<T>> boxes, T reach, std::size_t first,
                            std::size_t last, std::vector<ClosePair<T>>* pairs) const {
  thread_local Patch patch;
  pairs->clear();
  patch.crowds.clear();
  std::uint32_t own = 0;
  for (std::size_t k = first; k < last; ++k) {
    patch.crowds.push_back(pieces_[k].animals);
    own += static_cast<std::uint32_t>(pieces_[k].animals.size);
  }
  const CrowdBox<T> box = Grown(Around<T>(boxes.subspan(first, last - first)),
                                static_cast<T>(kReachMargin * static_cast<double>(reach)));
  Others<T>& others = patch.others;
  others.Clear();
  std::size_t touching = 0;
  for (std::size_t k = last; k < pieces_.size(); ++k) {
    if (!Touch(box, boxes[k])) continue;
    if (++touching > kMostTouching * (last - first)) return false;
    others.Add(pieces_[k].animals, pieces_[k].first, box);
  }
  if (2 * others.animal.size() > own) return false;
  patch.crowds.push_back(others.AsCrowd());

  patch.company.Find(patch.crowds, box, reach);
  patch.table.Sort(patch.company);
  patch.table.FindPairs();
  const auto animal = [&](std::uint32_t place) {
    const std::uint32_t k = patch.table.Animal(place);
    return k < own ? pieces_[first].first + k : others.animal[k - own];
  };
  for (const ClosePair<T>& pair : patch.table.pairs()) {
    if (std::min(patch.table.Animal(pair.first), patch.table.Animal(pair.second)) >= own) continue;
    pairs->push_back(
        {animal(pair.first), animal(pair.second), pair.way, pair.squared, pair.distance});
  }
  return true;
}

template <typename T>
void NearPatches<T>::FindPairs(std::span<const Crowd<T>> crowds, std::span<const CrowdBox<T>> boxes,
                               T reach, ThreadPool* pool) {
  pieces_.clear();
  std::uint32_t before = 0;
  for (const Crowd<T>& crowd : crowds) {
    for (std::size_t k = 0; k < crowd.size; k += kCrowdGrain) {
      Crowd<T> piece = crowd;
      piece.size = std::min<std::size_t>(kCrowdGrain, crowd.size - k);
      piece.x += k;
      piece.y += k;
      piece.z += k;
      if (piece.body != nullptr) piece.body += k;
      pieces_.push_back({piece, before + static_cast<std::uint32_t>(k)});
    }
    before += static_cast<std::uint32_t>(crowd.size);
  }
  const std::size_t patches = PatchCount(pieces_.size());
  pairs_.resize(patches);
  std::atomic<bool> mixed = false;
  pool->For(0, static_cast<std::int64_t>(patches), 1, [&](std::int64_t patch, std::int64_t) {
    const auto k = static_cast<std::size_t>(patch);
    if (!Search(boxes, reach, pieces_.size() * k / patches, pieces_.size() * (k + 1) / patches,
                &pairs_[k])) {
      mixed = true;
    }
  });
  if (!mixed) return;
  pairs_.resize(1);
  Search(boxes, reach, 0, pieces_.size(), &pairs_[0]);
}

template class NearPatches<float>;
template class NearPatches<double>;

}  // namespace flocklift
