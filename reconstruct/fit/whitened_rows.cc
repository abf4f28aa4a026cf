// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/whitened_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flocklift {
namespace {

constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();

// One whitened row.
struct Row {
  std::size_t source = 0;  // index into the motion rows
  Vec3d response;
  std::vector<Vec3d> features, instruments;
  Vec3d past_factor;  // n of a foreseen state
};

std::array<Vec3d, 3> AxesAlong(const Vec3d& direction) {
  const Vec3d first = Normalized(direction);
  if (first == Vec3d{}) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const Vec3d helper = std::abs(first.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  const Vec3d second = Normalized(Cross(helper, first));
  return {{first, second, Cross(first, second)}};
}

// y_k - X_k theta; theta may end with the factor of n.
Vec3d Residual(const MotionRows& rows, std::size_t k, const std::vector<double>& theta) {
  Vec3d u = rows.response[k] - rows.known[k];
  for (std::size_t c = 0; c < theta.size(); ++c) {
    u -= theta[c] * rows.features[k * (rows.terms + 1) + c];
  }
  return u;
}

// Row indices of each animal, by increasing frame.
std::vector<std::vector<std::size_t>> ByAnimal(const std::vector<Row>& rows,
                                               const MotionRows& source) {
  std::vector<std::vector<std::size_t>> result;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto animal = static_cast<std::size_t>(source.animal[rows[k].source]);
    if (animal >= result.size()) result.resize(animal + 1);
    result[animal].push_back(k);
  }
  return result;
}

// Takes off an animal's instruments what they had along n over its earlier rows.
void DemeanInstruments(const std::vector<std::size_t>& indices, std::size_t own_column,
                       std::vector<Row>* rows) {
  const std::size_t count = rows->at(indices.front()).instruments.size();
  std::vector<double> sums(count, 0.0);
  double squares = 0;
  for (const std::size_t k : indices) {
    Row& row = (*rows)[k];
    for (std::size_t c = 0; c < count; ++c) {
      if (c == own_column) continue;
      const double along = Dot(row.past_factor, row.instruments[c]);
      // n is a unit vector, or next to nothing where the clamp acted; an animal's first row, with
      // no earlier one, speaks across n alone.
      const double mean = squares > 0.5 ? sums[c] / squares : along;
      row.instruments[c] -= mean * row.past_factor;
      sums[c] += along;
    }
    squares += SquaredNorm(row.past_factor);
  }
}

// Takes each frame's mean off response, features and instruments; rows come frame by frame.
void RemoveFrameMeans(const MotionRows& motion, std::vector<Row>* rows) {
  for (std::size_t first = 0, last = 0; first < rows->size(); first = last) {
    const int frame = motion.frame[(*rows)[first].source];
    while (last < rows->size() && motion.frame[(*rows)[last].source] == frame) ++last;
    const auto center = [&](const auto& value_of) {
      Vec3d mean;
      for (std::size_t k = first; k < last; ++k) mean += value_of((*rows)[k]);
      mean = mean / static_cast<double>(last - first);
      for (std::size_t k = first; k < last; ++k) value_of((*rows)[k]) -= mean;
    };
    center([](Row& row) -> Vec3d& { return row.response; });
    for (std::size_t c = 0; c < (*rows)[first].features.size(); ++c) {
      center([c](Row& row) -> Vec3d& { return row.features[c]; });
      center([c](Row& row) -> Vec3d& { return row.instruments[c]; });
    }
  }
}

}  // namespace

std::vector<int> FramesBefore(int window, bool with_rho) {
  if (!with_rho) return {};
  return {3 * window + 3, window};
}

RegressionRows WhitenRows(const WhiteningOptions& options, const MotionRows& motion,
                          const std::vector<double>& theta, double rho, bool with_rho,
                          std::vector<double>* depth_sd) {
  const std::size_t width = motion.terms + 1, p = motion.terms + (HasMeanOwn(options) ? 1 : 0);
  const int shift = motion.window, lag = 3 * motion.window + 3;
  const auto feature = [&](std::size_t k, std::size_t c) { return motion.features[k * width + c]; };
  const std::vector<Vec3d>& near = options.lagged ? motion.near : motion.features;
  const std::vector<Vec3d>& far = options.lagged ? motion.far : motion.features;
  std::vector<Row> rows;
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const int frame = motion.frame[k], animal = motion.animal[k];
    if (frame % options.stride != 0) continue;
    Row row{.source = k,
            .response = Residual(motion, k, theta),
            .features = {},
            .instruments = {},
            .past_factor = near[k * width + motion.terms]};
    if (!with_rho) {
      for (std::size_t c = 0; c < p; ++c) {
        row.features.push_back(feature(k, c));
        row.instruments.push_back(near[k * width + c]);
      }
    } else {
      const std::int64_t one = motion.Find(frame - shift, animal);
      const std::int64_t old = motion.Find(frame - lag, animal);
      if (one < 0 || old < 0) continue;
      const auto k1 = static_cast<std::size_t>(one);
      if (motion.clamped[k] != motion.clamped[k1]) continue;
      const Vec3d before = Residual(motion, k1, theta);
      row.response -= rho * before;
      for (std::size_t c = 0; c < p; ++c) {
        row.features.push_back(feature(k, c) - rho * feature(k1, c));
        row.instruments.push_back(far[k * width + c] - rho * near[k1 * width + c]);
      }
      row.features.push_back(before);
      row.instruments.push_back(Residual(motion, static_cast<std::size_t>(old), theta));
      row.past_factor = near[k1 * width + motion.terms];
    }
    rows.push_back(std::move(row));
  }
  if (options.own_speed && options.lagged) {
    const std::size_t own_column = HasMeanOwn(options) ? motion.terms : kNoColumn;
    for (const auto& indices : ByAnimal(rows, motion)) {
      if (!indices.empty()) DemeanInstruments(indices, own_column, &rows);
    }
  }
  if (options.frame_effects) RemoveFrameMeans(motion, &rows);

  RegressionRows out;
  out.terms = static_cast<int>(p + (with_rho ? 1 : 0));
  if (depth_sd != nullptr) depth_sd->clear();
  for (const Row& row : rows) {
    const std::size_t k = row.source;
    const auto axes =
        AxesAlong(options.sight ? options.sight(motion.frame[k], motion.position[k]) : Vec3d{});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double sd = options.sight && axis == 0 ? motion.depth_sd[k] : 0;
      out.response.push_back(Dot(row.response, axes[axis]));
      for (const Vec3d& f : row.features) out.features.push_back(Dot(f, axes[axis]));
      for (const Vec3d& z : row.instruments) out.instruments.push_back(Dot(z, axes[axis]));
      out.weight.push_back(1 / (1 + options.depth_variance * sd * sd));
      out.time.push_back(motion.frame[k] / options.stride);
      out.group.push_back(motion.animal[k]);
      if (depth_sd != nullptr) depth_sd->push_back(sd);
    }
  }
  return out;
}

std::vector<Vec3d> Unexplained(const MotionRows& rows, const std::vector<double>& theta,
                               bool own_speed) {
  std::vector<Vec3d> u(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) u[k] = Residual(rows, k, theta);
  if (!own_speed) return u;
  const std::size_t width = rows.terms + 1;
  std::vector<double> products, squares;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto animal = static_cast<std::size_t>(rows.animal[k]);
    if (animal >= products.size()) {
      products.resize(animal + 1);
      squares.resize(animal + 1);
    }
    const Vec3d& n = rows.features[k * width + rows.terms];
    products[animal] += Dot(n, u[k]);
    squares[animal] += SquaredNorm(n);
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto animal = static_cast<std::size_t>(rows.animal[k]);
    if (squares[animal] == 0) continue;
    u[k] -= (products[animal] / squares[animal]) * rows.features[k * width + rows.terms];
  }
  return u;
}

void RemoveFrameMeans(const MotionRows& rows, std::vector<Vec3d>* u) {
  for (std::size_t first = 0, last = 0; first < rows.size(); first = last) {
    Vec3d mean;
    for (; last < rows.size() && rows.frame[last] == rows.frame[first]; ++last) mean += (*u)[last];
    mean = mean / static_cast<double>(last - first);
    for (std::size_t k = first; k < last; ++k) (*u)[k] -= mean;
  }
}

LagCorrelation CorrelationAtLag(const MotionRows& rows, const std::vector<Vec3d>& u, int lag) {
  LagCorrelation result;
  double products = 0, squares = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::int64_t before = rows.Find(rows.frame[k] - lag, rows.animal[k]);
    if (before < 0) continue;
    products += Dot(u[k], u[static_cast<std::size_t>(before)]);
    squares += SquaredNorm(u[k]);
    ++result.pairs;
  }
  if (result.pairs == 0 || squares == 0) return result;
  result.value = products / squares;
  result.covariance = products / (3.0 * static_cast<double>(result.pairs));
  return result;
}

}  // namespace flocklift
