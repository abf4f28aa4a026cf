// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/sensor_noise.h"

#include <algorithm>
#include <cmath>

#include "simulate/core/rng.h"

namespace flocklift {
namespace {

constexpr std::uint32_t kPlaces = 1U << 19;
constexpr std::uint64_t kBankStream = 0x6e6f697365;  // keeps bank and places apart

}  // namespace

SensorNoise::SensorNoise(double sd, int row_length, std::uint64_t seed) : seed_(seed) {
  if (!(sd > 0)) return;
  places_ = kPlaces;
  bank_.resize(kPlaces + static_cast<std::size_t>(row_length));
  Rng rng(seed, kBankStream);
  for (std::int16_t& value : bank_) {
    value =
        static_cast<std::int16_t>(std::lround(std::clamp(sd * rng.Normal(), -16000.0, 16000.0)));
  }
}

const std::int16_t* SensorNoise::Row(int v, int frame) const {
  if (bank_.empty()) return nullptr;
  Rng rng(seed_, static_cast<std::uint64_t>(v), static_cast<std::uint32_t>(frame));
  return bank_.data() + rng.Below(places_);
}

}  // namespace flocklift
