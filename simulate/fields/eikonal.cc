// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/fields/eikonal.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

// A local solution costs up to three times as much per node as a full one.
constexpr std::size_t kLocalShare = 4;

// Width of the front's buckets, in the smallest cost of a step.
constexpr float kBucketSteps = 0.05F;

// The u above for the smaller neighbours a, b, c along the axes and f = s l. A neighbour takes part
// when it is below what the smaller ones alone give, and the result is above all that take part.
float Upwind(float a, float b, float c, float f) {
  const auto order = [](float& low, float& high) {  // without a branch, which none can foretell
    const float least = std::min(low, high);
    high = std::max(low, high);
    low = least;
  };
  order(a, b);
  order(b, c);
  order(a, b);
  const auto above = [](float u, float m) {
    return u > m ? u : std::nextafter(m, Eikonal::kInfinite);
  };
  const float one = a + f;
  if (!(one > b)) return one;
  const float p = b - a;  // differences, so that a large C costs no digits
  const float two = above(a + 0.5F * (p + std::sqrt(2 * f * f - p * p)), b);
  if (!(two > c)) return two;
  const float q = c - a, sum = p + q;
  const float root = std::max(0.0F, sum * sum - 3 * (p * p + q * q - f * f));
  return above(a + (sum + std::sqrt(root)) / 3, c);
}

}  // namespace

Eikonal::Eikonal(const Grid& grid) : grid_(grid), row_(grid.nx + 2), slice_(row_ * (grid.ny + 2)) {
  const auto row = static_cast<std::ptrdiff_t>(row_), slice = static_cast<std::ptrdiff_t>(slice_);
  offsets_ = {-1, 1, -row, row, -slice, slice};
  const std::size_t nodes = slice_ * (grid.nz + 2);
  Check(nodes <= std::numeric_limits<std::uint32_t>::max(), "the grid has too many nodes");
  value_.assign(nodes, kInfinite);
  step_.assign(nodes, kInfinite);
  seed_.assign(nodes, kInfinite);
}

void Eikonal::SetSlowness(std::span<const float> slowness) {
  Check(slowness.size() == grid_.size(), "one slowness per node is needed");
  free_ = 0;
  float least = kInfinite;
  for (std::size_t node = 0; node < slowness.size(); ++node) {
    Check(slowness[node] > 0, "a slowness must be positive");
    const std::size_t padded = Padded(node);
    const float step = slowness[node] * static_cast<float>(grid_.spacing);
    free_ += step != kInfinite ? 1 : 0;
    least = std::min(least, step);
    if (step == step_[padded]) continue;
    step_[padded] = step;
    edited_.push_back(static_cast<std::uint32_t>(padded));
  }
  width_ = least != kInfinite ? kBucketSteps * least : 1;
}

void Eikonal::SetSeeds(std::span<const Seed> seeds) {
  // Old and new seeds count as edited; where they agree, the solution finds nothing to do.
  for (const std::uint32_t padded : seeded_) seed_[padded] = kInfinite;
  edited_.insert(edited_.end(), seeded_.begin(), seeded_.end());
  seeded_.clear();
  for (const Seed& seed : seeds) {
    Check(seed.node < grid_.size() && seed.value >= 0, "a seed lies beyond the grid");
    const auto padded = static_cast<std::uint32_t>(Padded(seed.node));
    seed_[padded] = std::min(seed_[padded], seed.value);
    seeded_.push_back(padded);
  }
  edited_.insert(edited_.end(), seeded_.begin(), seeded_.end());
}

std::array<float, 6> Eikonal::Neighbours(std::size_t node) const {
  const float* const at = &value_[Padded(node)];
  std::array<float, 6> values{};
  for (std::size_t k = 0; k < 6; ++k) values[k] = at[offsets_[k]];
  return values;
}

float Eikonal::Update(std::size_t padded) const {
  const float step = step_[padded];
  if (step == kInfinite) return kInfinite;
  const float* const at = &value_[padded];
  const auto row = static_cast<std::ptrdiff_t>(row_), slice = static_cast<std::ptrdiff_t>(slice_);
  return std::min(seed_[padded], Upwind(std::min(at[-1], at[1]), std::min(at[-row], at[row]),
                                        std::min(at[-slice], at[slice]), step));
}

// Makes infinite what stood on something that is gone, about in the order of C, so that a node is
// mostly judged when all it stands on has been; if not, it is judged again. False when that is too
// much of the grid.
bool Eikonal::Raise() {
  front_.Clear(width_);
  raised_.clear();
  for (const std::uint32_t node : edited_) {
    if (value_[node] != kInfinite) front_.Push(value_[node], node);
  }
  while (!front_.Empty()) {
    const internal::CostBuckets::Entry entry = front_.Pop();
    const std::uint32_t node = entry.node;
    if (entry.cost != value_[node] || !(Update(node) > entry.cost)) continue;
    value_[node] = kInfinite;
    raised_.push_back(node);
    if (raised_.size() > free_ / kLocalShare) return false;
    for (const std::ptrdiff_t offset : offsets_) {
      const auto other = static_cast<std::uint32_t>(node + offset);
      const float value = value_[other];
      if (value > entry.cost && value != kInfinite) front_.Push(value, other);
    }
  }
  return true;
}

// Takes one of the cheapest nodes from the front and spreads to its neighbours; when the front is
// empty, every node's equation holds. A node can change more than once (its neighbour may have been
// provisional); the front's older entries are then passed over. `change` is told of every node that
// changes.
template <typename Change>
void Eikonal::Pop(const Change& change) {
  const internal::CostBuckets::Entry entry = front_.Pop();
  if (entry.cost != value_[entry.node]) return;
  for (const std::ptrdiff_t offset : offsets_) {
    const auto other = static_cast<std::uint32_t>(entry.node + offset);
    if (!(value_[other] > entry.cost)) continue;  // does not depend on this node
    const float value = Update(other);
    if (value == value_[other]) continue;
    value_[other] = value;
    front_.Push(value, other);
    change(other);
  }
}

void Eikonal::Begin() {
  std::fill(value_.begin(), value_.end(), kInfinite);
  front_.Clear(width_);
  for (const std::uint32_t node : seeded_) {
    if (step_[node] == kInfinite || value_[node] == seed_[node]) continue;
    value_[node] = seed_[node];
    front_.Push(seed_[node], node);
  }
  complete_ = false;
}

void Eikonal::Local() {
  for (const std::uint32_t node : raised_) changed_.push_back(Unpadded(node));
  raised_.insert(raised_.end(), edited_.begin(), edited_.end());
  for (const std::uint32_t node : raised_) {
    const float value = Update(node);
    if (value == value_[node]) continue;
    value_[node] = value;
    front_.Push(value, node);
    changed_.push_back(Unpadded(node));
  }
  while (!front_.Empty()) {
    Pop([this](std::uint32_t node) { changed_.push_back(Unpadded(node)); });
  }
}

void Eikonal::Prepare() {
  changed_.clear();
  solved_all_ = !complete_ || edited_.size() > free_ / kLocalShare || !Raise();
  solved_all_ ? Begin() : Local();
  edited_.clear();
}

void Eikonal::Reach(std::size_t node) {
  if (complete_ || IsWall(node)) return;
  // What is still to come costs at least as much as the front's cheapest.
  const float& value = value_[Padded(node)];
  while (!front_.Empty() && front_.LeastCost() < value) Pop([](std::uint32_t) {});
}

void Eikonal::ReachAll() {
  while (!front_.Empty()) Pop([](std::uint32_t) {});
  complete_ = true;
}

void Eikonal::Solve() {
  Prepare();
  ReachAll();
}

}  // namespace flocklift
