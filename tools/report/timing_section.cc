// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include "tools/plot/markup.h"
#include "tools/report/sections.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;

const Json& Member(const Json& object, const std::string& name) {
  static const Json kNone;
  if (!object.is_object()) return kNone;
  const auto member = object.find(name);
  return member == object.end() ? kNone : *member;
}

double Number(const Json& value) { return value.is_number() ? value.get<double>() : 0; }

std::string Text(const Json& value) { return value.is_string() ? value.get<std::string>() : ""; }

std::string Seconds(double seconds) {
  return seconds < 0.01 ? "< 0.01 s" : NumberText(seconds) + " s";
}

}  // namespace

void AddTimingSection(const ReportData& data, Page* page, Missing* missing) {
  std::vector<Bar> bars;
  double wall = 0, cpu = 0;
  std::size_t color = 0;
  for (const StageSummary& summary : data.run.summaries) {
    const Json& phases = Member(summary.json, "phases");
    if (!phases.is_array() || phases.empty()) continue;
    for (const Json& phase : phases) {
      const double seconds = Number(Member(phase, "wall_s"));
      wall += seconds;
      cpu += Number(Member(phase, "cpu_s"));
      bars.push_back(
          {summary.stage + ": " + Text(Member(phase, "name")), Seconds(seconds), seconds, color});
    }
    ++color;
  }
  if (bars.empty()) {
    missing->push_back("Timings: the folder has no summary.*.json.");
    return;
  }
  page->BeginSection("timings", "Where the time went");
  page->AddBars(bars, fmt::format("Wall-clock time of each phase; in all {}, and {} of processor "
                                  "time.",
                                  Seconds(wall), Seconds(cpu)));
}

void AddProvenanceSection(const ReportData& data, Page* page) {
  if (data.run.summaries.empty()) return;
  page->BeginSection("provenance", "How this was made");
  for (const StageSummary& summary : data.run.summaries) {
    std::string heading = "flocklift " + summary.stage;
    const std::string version = Text(Member(summary.json, "version"));
    if (!version.empty()) heading += ", version " + version;
    page->BeginDetails(heading);
    Table inputs{{"input", "SHA-256"}, {}};
    const Json& files = Member(summary.json, "inputs");
    if (files.is_array()) {
      for (const Json& file : files) {
        inputs.rows.push_back({Text(Member(file, "name")), Text(Member(file, "sha256"))});
      }
    }
    if (!inputs.rows.empty()) page->AddTable(inputs);
    Table options{{"option", "value"}, {}};
    const Json& given = Member(summary.json, "options");
    if (given.is_object()) {
      for (const auto& [name, value] : given.items()) {
        options.rows.push_back({name, JsonText(value)});
      }
    }
    if (!options.rows.empty()) page->AddTable(options);
    page->EndDetails();
  }
}

}  // namespace flocklift
