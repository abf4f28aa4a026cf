// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/solve/batch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "reconstruct/initialize/persistence.h"
#include "reconstruct/solve/fingerprint.h"
#include "reconstruct/solve/window_solver.h"
#include "reconstruct/solve/window_store.h"
#include "reconstruct/solve/windows.h"
#include "simulate/core/check.h"

namespace flocklift {
namespace {

using namespace internal;  // NOLINT: the method's own parts

// How much is known in a window: anchors first, then sightings.
std::pair<long, long> KnownIn(const WindowPart& part, const Knowledge& knowledge) {
  long anchors = 0;
  for (const Segment& segment : part.segments.segments) {
    for (const Anchor& anchor : knowledge.anchors) {
      anchors += anchor.id == segment.id && anchor.frame >= segment.sightings.front().frame &&
                 anchor.frame <= segment.sightings.back().frame;
    }
  }
  return {anchors, part.segments.rows};
}

// The order of the windows: first the one where most is known, then forwards to the end, then
// backwards from there.
std::vector<std::size_t> OrderOf(const std::vector<std::pair<long, long>>& known) {
  const std::size_t best =
      static_cast<std::size_t>(std::max_element(known.begin(), known.end()) - known.begin());
  std::vector<std::size_t> order;
  for (std::size_t w = best; w < known.size(); ++w) order.push_back(w);
  for (std::size_t w = best; w-- > 0;) order.push_back(w);
  return order;
}

// Adds a window's points with their weights; every sighting's weights add up to 1.
void Blend(const Segments& segments, const Window& window, const WindowPart& part,
           const std::vector<SolvedPath>& solved, std::vector<SolvedPath>* paths) {
  for (std::size_t i = 0; i < solved.size(); ++i) {
    for (std::size_t k = 0; k < solved[i].size(); ++k) {
      const std::size_t place = part.sighting[i] + k;
      const double weight = window.Weight(segments.segments[part.segment[i]].sightings[place].time);
      SolvedPoint& point = (*paths)[part.segment[i]][place];
      point.position_in_cam += weight * solved[i][k].position_in_cam;
      point.velocity_in_cam += weight * solved[i][k].velocity_in_cam;
      point.acceleration_in_cam += weight * solved[i][k].acceleration_in_cam;
      point.sd_log_depth += weight * solved[i][k].sd_log_depth;
    }
  }
}

// Adds the report of a window with so many of all rows.
void Merge(const BatchReport& window, double share, BatchReport* report) {
  report->initial_cost += window.initial_cost;
  report->final_cost += window.final_cost;
  report->iterations += window.iterations;
  report->converged = report->converged && window.converged;
  report->scale_sd += share * window.scale_sd;
  for (const auto& spread : window.spreads) {
    const auto same = std::find_if(report->spreads.begin(), report->spreads.end(),
                                   [&](const auto& s) { return s.first == spread.first; });
    if (same == report->spreads.end()) {
      report->spreads.push_back({spread.first, share * spread.second});
    } else {
      same->second += share * spread.second;
    }
  }
  for (const TermStatistics& term : window.terms) {
    const auto same = std::find_if(report->terms.begin(), report->terms.end(),
                                   [&](const TermStatistics& t) { return t.name == term.name; });
    if (same == report->terms.end()) {
      report->terms.push_back(term);
      continue;
    }
    const double n = static_cast<double>(same->count), m = static_cast<double>(term.count);
    same->rms = std::sqrt((n * same->rms * same->rms + m * term.rms * term.rms) / (n + m));
    same->outliers = (n * same->outliers + m * term.outliers) / (n + m);
    same->count += term.count;
  }
  Merge(window.dynamics, &report->dynamics);
}

}  // namespace

BatchResult SolveBatch(const BatchOptions& options, const Knowledge& knowledge,
                       const Segments& segments, double fps, int threads, const Progress& progress,
                       const std::filesystem::path& checkpoint, const Refinement& refinement) {
  BatchResult result;
  if (segments.segments.empty()) return result;
  Check(options.overlap < options.window, "solve-overlap must be less than solve-window");
  int first_frame = segments.segments.front().sightings.front().frame;
  for (const Segment& segment : segments.segments) {
    first_frame = std::min(first_frame, segment.sightings.front().frame);
    result.paths.emplace_back(segment.sightings.size());
  }
  const std::vector<Window> windows = CutIntoWindows(segments, options.window, options.overlap);
  std::vector<std::pair<long, long>> known;
  double rows = 0;  // those in an overlap count twice
  for (const Window& window : windows) {
    known.push_back(KnownIn(PartOf(segments, window, fps, first_frame), knowledge));
    rows += static_cast<double>(known.back().second);
  }
  const std::int64_t iterations = kStartIterations + kSpreadRounds * kSpreadIterations +
                                  options.max_iterations + refinement.iterations;
  const std::int64_t total = static_cast<std::int64_t>(windows.size()) * iterations;
  std::int64_t done = 0;
  std::optional<Belief> belief;
  const bool is_long = windows.size() > 1 && !checkpoint.empty();
  WindowStore store(
      is_long ? checkpoint : std::filesystem::path{},
      is_long ? FingerprintOf(options, knowledge, segments, fps, refinement.fingerprint) : 0);
  result.report.converged = true;
  result.report.erratic = options.erratic_flight && IsErratic(segments.persistence);
  for (const std::size_t w : OrderOf(known)) {
    const WindowPart part = PartOf(segments, windows[w], fps, first_frame);
    if (part.segments.segments.empty()) continue;
    std::int64_t here = 0;
    std::optional<SolvedWindow> kept = store.Find(w);
    if (!kept) {
      kept = SolveWindow(
          options, knowledge, part.segments, belief, part.first_frame, fps, threads,
          [&] { Report(progress, done + std::min(here++, iterations), total); }, refinement.refine);
      store.Keep(w, *kept);
    }
    const SolvedWindow& solved = *kept;
    done += iterations;
    if (!belief) {
      result.report.speed_against_size = solved.result.report.speed_against_size;
      result.report.stiff_boxes = solved.result.report.stiff_boxes;
      result.report.weak_perspective = solved.result.report.weak_perspective;
    }
    belief = solved.belief;
    result.report.flock_speed = solved.result.report.flock_speed;
    result.report.size_ratio = solved.result.report.size_ratio;
    result.report.lean = solved.result.report.lean;
    Blend(segments, windows[w], part, solved.result.paths, &result.paths);
    Merge(solved.result.report, part.segments.rows / rows, &result.report);
  }
  store.Remove();
  Report(progress, total, total);
  return result;
}

}  // namespace flocklift
