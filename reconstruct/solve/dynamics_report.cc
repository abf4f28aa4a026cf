// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/dynamics_report.h"

namespace flocklift {

void Merge(const DynamicsReport& window, DynamicsReport* report) {
  const auto add = [](double value, double count, double before, double* mean) {
    if (before + count > 0) *mean = (before * *mean + count * value) / (before + count);
  };
  add(window.weight, window.kept, report->kept, &report->weight);
  const double hidden = static_cast<double>(window.hidden);
  const double before = static_cast<double>(report->hidden);
  add(window.batch_error, hidden, before, &report->batch_error);
  add(window.dynamics_error, hidden, before, &report->dynamics_error);
  report->windows += window.windows;
  report->kept += window.kept;
  report->hidden += window.hidden;
  if (!window.forces.empty()) report->forces = window.forces;
}

}  // namespace flocklift
