// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/scene_look.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace flocklift {
namespace {

constexpr std::uint32_t kMagic = 0x534b4c46;  // "FLKS"
constexpr double kMostUnits = 32767;

template <typename T>
void Append(const T* values, std::size_t count, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

}  // namespace

std::string PackLook(const FlockState& state, std::span<const Vec3d> goals, const LookHead& head) {
  const std::size_t n = state.size();
  double fastest = 1e-6;
  for (const Vec3d& v : state.velocity) fastest = std::max(fastest, Norm(v));
  const double unit = fastest / kMostUnits;
  std::vector<float> places;
  places.reserve(3 * (goals.size() + n));
  const auto put = [&places](const Vec3d& p) {
    places.insert(places.end(),
                  {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  };
  for (const Vec3d& p : goals) put(p);
  for (const Vec3d& p : state.position) put(p);
  std::vector<std::int16_t> velocities;
  velocities.reserve(3 * n + 1);
  for (const Vec3d& v : state.velocity) {
    for (const double x : {v.x, v.y, v.z}) {
      velocities.push_back(static_cast<std::int16_t>(std::lround(x / unit)));
    }
  }
  if (velocities.size() % 2 == 1) velocities.push_back(0);
  std::string look;
  look.reserve(32 + 4 * places.size() + 2 * velocities.size());
  const std::uint32_t numbers[] = {kMagic, static_cast<std::uint32_t>(n),
                                   static_cast<std::uint32_t>(goals.size()), head.number};
  const float rates[] = {static_cast<float>(head.time), static_cast<float>(head.looks_per_second),
                         static_cast<float>(head.steps_per_second), static_cast<float>(unit)};
  Append(numbers, std::size(numbers), &look);
  Append(rates, std::size(rates), &look);
  Append(places.data(), places.size(), &look);
  Append(velocities.data(), velocities.size(), &look);
  return look;
}

}  // namespace flocklift
