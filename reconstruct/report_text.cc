// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/report_text.h"

#include <algorithm>
#include <cmath>

namespace flocklift::internal {
namespace {

std::string Percent(double share) {
  const long tenths = std::lround(share * 1000);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " %";
}

// The image of a flock that flies straight past shows almost nothing of relative depth but speed.
double MedianTurn(const std::vector<SolvedPath>& paths) {
  std::vector<double> turns;
  for (const SolvedPath& path : paths) {
    if (path.size() < 2) continue;
    const Vec3d a = Normalized(path.front().velocity_in_cam);
    const Vec3d b = Normalized(path.back().velocity_in_cam);
    const Vec3d m = Normalized(path[path.size() / 2].velocity_in_cam);
    const auto angle = [](const Vec3d& u, const Vec3d& v) {
      return std::acos(std::clamp(Dot(u, v), -1.0, 1.0));
    };
    turns.push_back(std::max(angle(a, m) + angle(m, b), angle(a, b)));
  }
  if (turns.empty()) return 0;
  std::sort(turns.begin(), turns.end());
  return turns[turns.size() / 2];
}

// Which solution was kept, and by how much.
std::string DescribeDynamics(const DynamicsReport& d) {
  const auto rounded = [](double value) {
    const long hundredths = std::lround(value * 100);
    return std::to_string(hundredths / 100) + (hundredths % 100 < 10 ? ".0" : ".") +
           std::to_string(hundredths % 100);
  };
  if (d.windows == 0) return "; forces untested: no track is long enough to hide a part of it";
  return "; forces count in " + std::to_string(d.kept) + " of " + std::to_string(d.windows) +
         " windows" + (d.kept > 0 ? ", by " + Percent(d.weight) : "") + " (" +
         std::to_string(d.hidden) + " hidden sightings predicted to " + rounded(d.dynamics_error) +
         " with forces, " + rounded(d.batch_error) + " without)";
}

// By how much the two that fix the scale are apart, as the tracks tell it; sd of what sizes tell.
std::string SpeedBySizes(const Uncertain& apart) {
  return "by the sizes the flock flies " + Percent(std::abs(std::expm1(apart.mean))) +
         (apart.mean > 0 ? " faster" : " slower") + " than stated (sd " + Percent(apart.sd) + ")";
}

}  // namespace

std::string DescribeSolution(const Knowledge& knowledge, const Segments& segments,
                             const BatchResult& batch, const ReconstructReport& report) {
  bool sizes = false;
  for (const Segment& segment : segments.segments) {
    for (const Sighting& s : segment.sightings) sizes |= s.log_size.has_value();
  }
  std::string text = "relative depth rests on ";
  if (batch.report.erratic) {
    text += sizes ? "apparent size" : "how wide the flock is";
    text += "; animals keep no speed: image speed tells how far the flock is, not who is nearer";
  } else {
    constexpr double kStraight = 30 * 3.14159265358979323846 / 180;
    const bool straight = MedianTurn(batch.paths) < kStraight;
    text += sizes ? "apparent size and image speed" : "image speed";
    text += straight ? "; the paths are nearly straight, so perspective along them says little"
                     : " and on perspective along curved paths";
    if (knowledge.up_in_cam) text += "; level flight helps";
  }
  if (batch.report.stiff_boxes > 0.5) text += "; boxes are as large from every side";
  if (batch.report.weak_perspective) text += "; bodies are drawn in weak perspective";
  text += "; median relative sd " + Percent(report.relative_sd) + ", common scale " +
          Percent(report.scale_sd) + " (" + report.scale_from + ")";
  if (report.speed_by_sizes) text += "; " + SpeedBySizes(*report.speed_by_sizes);
  if (report.dynamics) {
    text += batch.report.erratic ? "; forces left out: they are those of animals that fly on"
                                 : DescribeDynamics(*report.dynamics);
  }
  return text;
}

void WarnOfDisagreement(const Uncertain& apart, std::vector<std::string>* warnings) {
  if (!(std::abs(apart.mean) > apart.sd)) return;
  warnings->push_back("speed and wingspan disagree: " + SpeedBySizes(apart) +
                      "; the scale is a compromise");
}

void WarnOfSecondCamera(const SecondCameraReport& second, std::vector<std::string>* warnings) {
  const std::string counts =
      std::to_string(second.matched) + " of the second camera's " + std::to_string(second.tracks);
  if (2 * second.matched < second.tracks) {
    warnings->push_back("only " + counts +
                        " tracks show an animal of the first; check both poses and the clocks");
  }
}

}  // namespace flocklift::internal
