// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the errors of depth grow with what goes wrong: identity switches, misses, noise of positions,
// a mean speed or a focal length told wrongly. Curves of the methods, side by side in one picture.

#ifndef FLOCKLIFT_TOOLS_DEPTH_CURVES_H_
#define FLOCKLIFT_TOOLS_DEPTH_CURVES_H_

#include <string>
#include <vector>

#include "tools/depth_case.h"
#include "tools/depth_table.h"

namespace flocklift {

// One kind of trouble, and its amounts.
struct DepthSweep {
  std::string name;  // of the panel, with unit
  std::vector<double> amounts;
  void (*apply)(double amount, DepthCase* depth_case) = nullptr;
};

// Identity switches (0 to 10 per 1000 rows), misses (0 to 20 %), position noise (0 to 2 px), the
// told speed and focal length (-20 to 20 and -10 to 10 % off).
const std::vector<DepthSweep>& DepthSweeps();

// A method's errors along a sweep, means over the seeds, in the order of its amounts.
struct DepthCurve {
  std::string method;
  std::vector<double> absolute, scaled;  // median |error|, as it is and after one global scale
};

struct DepthPanel {
  DepthSweep sweep;
  std::vector<DepthCurve> curves;
};

// An SVG file of its own: a panel for each sweep, absolute errors as lines, those after one global
// scale dashed.
std::string DepthCurvesPicture(const std::vector<DepthPanel>& panels);

// The same figures as a table in Markdown, in %.
std::string DepthCurvesTable(const std::vector<DepthPanel>& panels);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_DEPTH_CURVES_H_
