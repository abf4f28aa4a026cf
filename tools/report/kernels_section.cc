// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "simulate/core/text.h"
#include "tools/plot/markup.h"
#include "tools/report/sections.h"
#include "tools/report/video_frame.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLines = 12;  // of each kernel, in the table

std::string Text(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) return "";
  return found->is_number() ? NumberText(found->get<double>()) : JsonText(*found);
}

// kernels.csv by kernel: rows of distance, value, sd, low, high, density, known.
std::vector<std::pair<std::string, std::vector<std::vector<std::string>>>> ReadKernels(
    const std::string& csv) {
  std::vector<std::pair<std::string, std::vector<std::vector<std::string>>>> kernels;
  std::size_t at = 0;
  while (at < csv.size()) {
    const std::size_t end = std::min(csv.find('\n', at), csv.size());
    const std::string line = csv.substr(at, end - at);
    at = end + 1;
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> fields;
    std::size_t from = 0;
    for (std::size_t comma; from <= line.size(); from = comma + 1) {
      comma = std::min(line.find(',', from), line.size());
      fields.push_back(line.substr(from, comma - from));
    }
    if (fields.size() < 8 || !ParseReal(fields[1])) continue;  // the header
    if (kernels.empty() || kernels.back().first != fields[0]) kernels.push_back({fields[0], {}});
    kernels.back().second.emplace_back(fields.begin() + 1, fields.end());
  }
  return kernels;
}

std::string Rounded(const std::string& text) {
  const auto value = ParseReal(text);
  return value ? NumberText(*value) : "";
}

}  // namespace

void AddKernelsSection(const ReportData& data, Page* page) {
  const RunFolder& run = data.run;
  if (run.kernels_picture.empty() && run.kernels_table.empty()) return;
  page->BeginSection("kernels", "Fitted kernels");
  page->AddText(
      "What animals do to each other over distance, without a form: attraction (below 0: "
      "repulsion) "
      "and alignment, with 95 % bands. Dashed, or unknown: the data say nothing there.");
  if (!run.kernels_picture.empty()) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(run.kernels_picture.data());
    page->AddFigure(
        "<img style=\"width:100%;max-width:820px\" alt=\"fitted kernels\" "
        "src=\"data:image/svg+xml;base64," +
            Base64(std::span(bytes, run.kernels_picture.size())) + "\"/>",
        "kernels.svg: each kernel with its band, and the density of pairs.");
  }
  Table summary{{"kernel", "unit", "from [m]", "to [m]", "pairs where it is known"}, {}};
  const Json& kernels = run.Figure("fit", "kernels");
  if (kernels.is_array()) {
    for (const Json& kernel : kernels) {
      if (!kernel.is_object() || !kernel.contains("name")) continue;
      const auto share = kernel.find("known_share_of_pairs");
      const bool has_share = share != kernel.end() && share->is_number();
      summary.rows.push_back({JsonText(kernel.at("name")),
                              kernel.contains("unit") ? JsonText(kernel.at("unit")) : "",
                              Text(kernel, "nearest"), Text(kernel, "farthest"),
                              has_share ? FixedText(100 * share->get<double>(), 0) + " %" : ""});
    }
  }
  if (!summary.rows.empty()) page->AddTable(summary);
  const auto curves = ReadKernels(run.kernels_table);
  if (curves.empty()) return;
  page->BeginDetails("Their values");
  for (const auto& [name, rows] : curves) {
    Table table{{"distance [m]", name, "1 sd", "known?"}, {}};
    const std::size_t lines = std::min(kLines, rows.size());
    for (std::size_t k = 0; k < lines; ++k) {
      const std::vector<std::string>& row = rows[(2 * k + 1) * rows.size() / (2 * lines)];
      const bool known = row[6] == "1";
      table.rows.push_back({Rounded(row[0]), known ? Rounded(row[1]) : "unknown", Rounded(row[2]),
                            known ? "yes" : "no"});
    }
    page->AddTable(table, "Of kernels.csv, some lines.");
  }
  page->EndDetails();
}

}  // namespace flocklift
