// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/fit/fit_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reconstruct/fit/whitened_rows.h"

namespace flocklift {
namespace {

constexpr double kSpeedSlack = 0.05;  // beyond the 1st and 99th percentile of speeds

double SpeedAt(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

void WidenSpeedLimits(const FitProblem& problem, const ObservedFlock& flock, ModelSpec* model,
                      std::vector<std::string>* warnings) {
  if (!model->parameters.contains("s_max") || !model->parameters.contains("time_unit")) return;
  std::vector<double> speeds;
  const FrameSpan span = flock.span();
  const int stride = std::max(1, (span.last - span.first) / 200);
  for (int f = span.first; f <= span.last; f += stride) {
    for (const Vec3d& v : flock.Between(f, 0, 1, 0).velocity) speeds.push_back(Norm(v));
  }
  if (speeds.empty()) return;
  std::sort(speeds.begin(), speeds.end());
  const double unit = model->parameters.at("time_unit");
  const double low = unit * SpeedAt(speeds, 0.01) * (1 - kSpeedSlack);
  const double high = unit * SpeedAt(speeds, 0.99) * (1 + kSpeedSlack);
  const auto widen = [&](const char* name, double wanted, bool needed) {
    if (problem.model.parameters.contains(name) || !needed) return;
    warnings->push_back(fmt::format(
        "{} is {:.3g} instead of the model's {:.3g}: the animals fly at {:.3g} to "
        "{:.3g} m/s",
        name, wanted, model->parameters.at(name), SpeedAt(speeds, 0.01), SpeedAt(speeds, 0.99)));
    model->parameters[name] = wanted;
  };
  widen("s_min", low, low < (1 - 2 * kSpeedSlack) * model->parameters.at("s_min"));
  widen("s_max", high, high > (1 + 2 * kSpeedSlack) * model->parameters.at("s_max"));
}

double MeanSpeed(const ObservedFlock& flock) {
  double sum = 0, count = 0;
  for (int f = flock.span().first; f <= flock.span().last; ++f) {
    for (const Vec3d& v : flock.Between(f, 0, 1, 0).velocity) {
      sum += Norm(v);
      count += 1;
    }
  }
  return count > 0 ? sum / count : 0;
}

std::vector<int> Middles(const ObservedFlock& flock, int window, int stride) {
  const FrameSpan span = flock.span();
  std::vector<int> middles;
  for (int f = span.first; f <= span.last; ++f) {
    if (f % stride != 0) continue;
    for (const int before : FramesBefore(window, true)) middles.push_back(f - before);
    middles.push_back(f);
  }
  std::sort(middles.begin(), middles.end());
  middles.erase(std::unique(middles.begin(), middles.end()), middles.end());
  std::erase_if(middles, [&](int f) { return f < span.first || f > span.last; });
  return middles;
}

}  // namespace flocklift
