// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a calibration found and how sure it is, and what its error does to a reconstruction
// (simulate/camera/depth_sensitivity.h): as text for a terminal and as figures for the summary.

#ifndef FLOCKLIFT_TOOLS_CALIBRATION_REPORT_H_
#define FLOCKLIFT_TOOLS_CALIBRATION_REPORT_H_

#include <nlohmann/json.hpp>
#include <string>

#include "simulate/camera/calibrate.h"

namespace flocklift {

std::string CalibrationTables(const Calibration& calibration);
nlohmann::ordered_json CalibrationFigures(const Calibration& calibration);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_CALIBRATION_REPORT_H_
