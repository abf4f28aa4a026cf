// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/report/report.h"

#include <fmt/format.h>

#include <utility>

#include "tools/plot/markup.h"
#include "tools/report/page.h"
#include "tools/report/sections.h"

namespace flocklift {
namespace {

// "30 animals over 300 frames, 10.0 s at 30 frames/s".
std::string Subtitle(const RunFolder& run) {
  const FrameSpan span = run.trajectories ? SpanOf(*run.trajectories) : SpanOf(*run.tracks);
  const std::size_t animals =
      run.trajectories ? run.trajectories->trajectories.size() : run.tracks->tracklets.size();
  const int frames = span.last - span.first + 1;
  std::string text = fmt::format("{} {} over {} frames", animals,
                                 animals == 1 ? "identity" : "identities", frames);
  if (run.fps) {
    text += fmt::format(", {} s at {} frames/s", NumberText(frames / *run.fps),
                        NumberText(*run.fps, 4));
  }
  return text;
}

// The folder's own name, and its parent's where that says more ("demo/result").
std::string NameOf(const std::filesystem::path& folder) {
  const auto full = std::filesystem::canonical(folder);
  const std::string own = full.filename().string();
  const std::string parent = full.parent_path().filename().string();
  return own == "result" && !parent.empty() ? parent + "/" + own : own;
}

}  // namespace

std::string MakeReport(RunFolder run) {
  Page page("Flock report: " + NameOf(run.folder), Subtitle(run));
  const ReportData data = PrepareReport(std::move(run));
  Missing missing;
  AddSummarySection(data, &page);
  AddWarnings(data, &page);
  AddPictureSection(data, &page, &missing);
  AddSuspicionSection(data, &page, &missing);
  AddSpaceSection(data, &page, &missing);
  AddDepthSection(data, &page, &missing);
  AddFlockSection(data, &page, &missing);
  AddTruthSection(data, &page, &missing);
  AddResidualSection(data, &page, &missing);
  AddScaleSection(data, &page, &missing);
  AddParametersSection(data, &page, &missing);
  AddKernelsSection(data, &page);
  AddReplaySection(data, &page, &missing);
  AddRoundTripSection(data, &page);
  AddTimingSection(data, &page, &missing);
  if (!missing.empty()) {
    page.BeginSection("missing", "Not shown");
    for (const std::string& line : missing) page.AddText(line);
  }
  AddProvenanceSection(data, &page);
  return page.Html();
}

}  // namespace flocklift
