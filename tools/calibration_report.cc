// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/calibration_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulate/camera/depth_sensitivity.h"

namespace flocklift {
namespace {

// One way to fix the scale of a reconstruction, and what a relative error of the focal length
// does to it.
struct ScaleCase {
  const char* key;
  const char* text;
  StretchError error;
};

std::array<ScaleCase, 5> ScaleCases(double focal_error) {
  return {{{"size", "size (wingspan)", StretchFromSize(focal_error)},
           {"speed_across", "speed, flight across the view", StretchFromSpeed(focal_error, 0)},
           {"speed_all_ways", "speed, flight in all directions",
            StretchFromSpeed(focal_error, 1.0 / 3)},
           {"speed_head_on", "speed, flight along the view", StretchFromSpeed(focal_error, 1)},
           {"distances", "distances (near and far)", StretchFromDistances(focal_error)}}};
}

struct Parameter {
  const char* name;
  double value, sd;
};

// Those that were fitted: a coefficient that was not has no standard deviation.
std::vector<Parameter> ParametersOf(const Calibration& calibration) {
  constexpr const char* kNames[] = {"k1", "k2", "p1", "p2", "k3", "k4",
                                    "k5", "k6", "s1", "s2", "s3", "s4"};
  const Intrinsics &k = calibration.camera.intrinsics, &sd = calibration.sd;
  std::vector<Parameter> parameters = {
      {"fx", k.fx, sd.fx}, {"fy", k.fy, sd.fy}, {"cx", k.cx, sd.cx}, {"cy", k.cy, sd.cy}};
  for (std::size_t i = 0; i < k.distortion.size(); ++i) {
    if (sd.distortion[i] > 0) parameters.push_back({kNames[i], k.distortion[i], sd.distortion[i]});
  }
  return parameters;
}

// How far the principal point's sd tilts the whole scene [deg].
double TiltOf(const Calibration& calibration) {
  return std::hypot(calibration.sd.cx / calibration.camera.intrinsics.fx,
                    calibration.sd.cy / calibration.camera.intrinsics.fy) *
         180 / std::numbers::pi;
}

double Percent(double relative) { return 100 * std::abs(relative); }

}  // namespace

std::string CalibrationTables(const Calibration& calibration) {
  std::string text = fmt::format("{:<10}{:>14}{:>12}\n", "parameter", "value", "sd");
  for (const Parameter& p : ParametersOf(calibration)) {
    text += fmt::format("{:<10}{:>14.6g}{:>12.2g}\n", p.name, p.value, p.sd);
  }
  const double sd = calibration.focal_sd;
  text += fmt::format(
      "\nWhat the focal length's sd of {:.3f} % does to a reconstruction (1 sigma), and what 1 % "
      "would:\n{:<33}{:>10}{:>13}{:>12}{:>13}\n",
      Percent(sd), "where its scale comes from", "depth", "across view", "1 %: depth",
      "across view");
  for (const ScaleCase& c : ScaleCases(1)) {
    text += fmt::format("{:<33}{:>8.3f} %{:>11.3f} %{:>10.2f} %{:>11.2f} %\n", c.text,
                        Percent(sd * c.error.depth), Percent(sd * c.error.across),
                        std::abs(c.error.depth), std::abs(c.error.across));
  }
  return text + fmt::format("The principal point's sd tilts the whole scene by {:.3f} degrees.\n",
                            TiltOf(calibration));
}

nlohmann::ordered_json CalibrationFigures(const Calibration& calibration) {
  const auto& kept = calibration.view_kept;
  nlohmann::ordered_json figures = {{"reprojection_rms_px", calibration.reprojection_rms},
                                    {"views_found", kept.size()},
                                    {"views_used", std::count(kept.begin(), kept.end(), true)},
                                    {"coverage", calibration.coverage},
                                    {"focal_sd_percent", Percent(calibration.focal_sd)},
                                    {"tilt_sd_deg", TiltOf(calibration)}};
  for (const Parameter& p : ParametersOf(calibration)) {
    figures["parameters"][p.name] = {{"value", p.value}, {"sd", p.sd}};
  }
  for (const ScaleCase& c : ScaleCases(calibration.focal_sd)) {
    figures["depth_error_percent"][c.key] = Percent(c.error.depth);
    figures["across_error_percent"][c.key] = Percent(c.error.across);
  }
  return figures;
}

}  // namespace flocklift
