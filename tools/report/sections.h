// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sections of the report. Each adds itself to the page, or, where its inputs are missing, a
// line to `missing` that says what would bring it.

#ifndef FLOCKLIFT_TOOLS_REPORT_SECTIONS_H_
#define FLOCKLIFT_TOOLS_REPORT_SECTIONS_H_

#include <optional>
#include <string>
#include <vector>

#include "reconstruct/metrics/flock_statistics.h"
#include "reconstruct/metrics/matched_points.h"
#include "tools/report/page.h"
#include "tools/report/run_folder.h"

namespace flocklift {

// The run, and what several sections compute from it.
struct ReportData {
  RunFolder run;
  std::vector<FlockStatistics> flock;          // of the reconstruction; thinned out when it is long
  std::vector<FlockStatistics> true_flock;     // of the truth
  std::optional<MatchedTrajectories> matched;  // truth and reconstruction, by image
};
ReportData PrepareReport(RunFolder run);

using Missing = std::vector<std::string>;

void AddSummarySection(const ReportData& data, Page* page);
void AddWarnings(const ReportData& data, Page* page);
void AddPictureSection(const ReportData& data, Page* page, Missing* missing);
void AddSuspicionSection(const ReportData& data, Page* page, Missing* missing);
void AddSpaceSection(const ReportData& data, Page* page, Missing* missing);
void AddDepthSection(const ReportData& data, Page* page, Missing* missing);
void AddFlockSection(const ReportData& data, Page* page, Missing* missing);
void AddTruthSection(const ReportData& data, Page* page, Missing* missing);
void AddResidualSection(const ReportData& data, Page* page, Missing* missing);
void AddScaleSection(const ReportData& data, Page* page, Missing* missing);
void AddParametersSection(const ReportData& data, Page* page, Missing* missing);
void AddKernelsSection(const ReportData& data, Page* page);
void AddReplaySection(const ReportData& data, Page* page, Missing* missing);
void AddRoundTripSection(const ReportData& data, Page* page);
void AddTimingSection(const ReportData& data, Page* page, Missing* missing);
void AddProvenanceSection(const ReportData& data, Page* page);

// A JSON value in words: numbers rounded, lists and objects in one line.
std::string JsonText(const nlohmann::ordered_json& value);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPORT_SECTIONS_H_
