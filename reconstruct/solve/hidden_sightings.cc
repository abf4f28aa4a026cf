// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/hidden_sightings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reconstruct/solve/batch_start.h"

namespace flocklift::internal {

HiddenSightings::HiddenSightings(double share, double duration, double fps,
                                 const Segments& segments, int fold)
    : rest_(segments) {
  const int frames = std::max(1, static_cast<int>(std::lround(duration * fps)));
  const int period = std::max(frames, static_cast<int>(std::lround(duration / share * fps)));
  for (std::size_t i = 0; i < segments.segments.size(); ++i) {
    const auto& all = segments.segments[i].sightings;
    auto& kept = rest_.segments[i].sightings;
    // Pieces begin at shifted multiples of the period; the first and the last sightings stay.
    const double stagger = std::fmod(0.25 + 0.618 * static_cast<double>(i), 1.0);
    const int shift = static_cast<int>(std::lround(stagger * period)) + fold * frames;
    std::vector<Sighting> rest;
    Piece piece{i, {}};
    const auto close = [&] {
      if (!piece.sightings.empty()) pieces_.push_back(piece);
      piece.sightings.clear();
    };
    for (std::size_t k = 0; k < all.size(); ++k) {
      const int into = (static_cast<int>(std::lround(all[k].time * fps)) + shift) % period;
      const bool inside = all[k].time - all.front().time > 0.5 * duration &&
                          all.back().time - all[k].time > 0.5 * duration;
      const bool hide = into < frames && inside;
      if (hide) {
        piece.sightings.push_back(all[k]);
      } else {
        close();
        rest.push_back(all[k]);
      }
    }
    close();
    // What a second camera sees meanwhile would give the place away.
    std::erase_if(rest_.segments[i].views, [&](const View& view) {
      const int into = (static_cast<int>(std::lround(view.time * fps)) + shift) % period;
      return into < frames;
    });
    kept = std::move(rest);
    rest_.rows -= static_cast<int>(all.size() - kept.size());
    count_ += static_cast<long>(all.size() - kept.size());
  }
}

std::vector<double> HiddenSightings::ErrorsOf(const std::vector<Bird>& birds,
                                              double knot_interval) const {
  std::vector<double> errors;
  BatchModel model;
  model.knot_interval = knot_interval;
  for (const Piece& piece : pieces_) {
    const Bird& bird = birds[piece.segment];
    double sum = 0;
    for (const Sighting& s : piece.sightings) {
      const Bird::Place place = PlaceAt(model, bird, s.time);
      double x = 0, y = 0;
      for (int a = 0; a < 4; ++a) {
        const double* c = &bird.path[3 * static_cast<std::size_t>(place.interval + a)];
        x += place.weights[static_cast<std::size_t>(a)] * c[0];
        y += place.weights[static_cast<std::size_t>(a)] * c[1];
      }
      sum += std::sqrt(std::hypot(x - s.ray.x, y - s.ray.y) / s.ray_sd);
    }
    errors.push_back(sum / static_cast<double>(piece.sightings.size()));
  }
  return errors;
}

double MeanOf(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double ProbabilityOfBetter(const std::vector<double>& errors, const std::vector<double>& others,
                           double odds) {
  if (errors.empty() || errors.size() != others.size()) return odds / (odds + 1);
  // What is averaged are square roots: the scale is their mean squared.
  const double log_scales = 2 * std::log(MeanOf(others) / MeanOf(errors));
  return odds / (odds + std::exp(-2 * static_cast<double>(errors.size()) * log_scales));
}

}  // namespace flocklift::internal
