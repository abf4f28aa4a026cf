// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/plot/markup.h"
#include "tools/report/sections.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;

const Json* SummaryOf(const RunFolder& run, const std::string& stage) {
  for (const StageSummary& summary : run.summaries) {
    if (summary.stage == stage && summary.json.is_object()) return &summary.json;
  }
  return nullptr;
}

// A list of objects with the same keys as one table; anything else stays words.
bool IsTable(const Json& value) {
  return value.is_array() && !value.empty() && value.front().is_object();
}

void AddJsonTable(const std::string& caption, const Json& rows, Page* page) {
  Table table;
  for (const auto& [key, element] : rows.front().items()) table.header.push_back(key);
  for (const Json& row : rows) {
    std::vector<std::string> cells;
    for (const std::string& key : table.header) {
      cells.push_back(row.is_object() && row.contains(key) ? JsonText(row.at(key)) : "");
    }
    table.rows.push_back(std::move(cells));
  }
  page->AddTable(table, caption);
}

std::string Words(const Json& value) { return value.is_null() ? "" : JsonText(value); }

}  // namespace

void AddScaleSection(const ReportData& data, Page* page, Missing* missing) {
  const RunFolder& run = data.run;
  const Json* summary = SummaryOf(run, "reconstruct");
  if (summary == nullptr) {
    missing->push_back("What fixed the scale: the folder has no summary.reconstruct.json.");
    return;
  }
  page->BeginSection("scale", "What fixed the scale");
  page->AddText(
      "One camera cannot see how large a scene is: twice as large, twice as far and twice as fast "
      "looks the same. The scale comes from what was known beforehand.");
  const Json& scale_sd = run.Figure("reconstruct", "scale_sd");
  std::vector<Card> cards;
  const std::string from = Words(run.Figure("reconstruct", "scale_from"));
  if (!from.empty()) cards.push_back({from, "The scale comes from", ""});
  if (scale_sd.is_number()) {
    const bool known = scale_sd.get<double>() > 0;
    cards.push_back(
        {known ? "\xC2\xB1 " + NumberText(100 * scale_sd.get<double>(), 2) + " %" : "not known",
         "Uncertainty of the common scale",
         known ? "all distances and speeds together, 1 sd" : "this method gives no error bars"});
  }
  const Json& relative_sd = run.Figure("reconstruct", "relative_sd");
  if (relative_sd.is_number() && relative_sd.get<double>() > 0) {
    cards.push_back({"\xC2\xB1 " + NumberText(100 * relative_sd.get<double>(), 2) + " %",
                     "Uncertainty of relative depth",
                     "median of the animals, common scale taken out"});
  }
  const std::string method = Words(run.Figure("reconstruct", "method"));
  if (!method.empty()) cards.push_back({method, "Method", ""});
  if (!cards.empty()) page->AddCards(cards);
  const std::string observability = Words(run.Figure("reconstruct", "observability"));
  if (!observability.empty()) page->AddText("Observability: " + observability);

  const Json figures = summary->value("figures", Json::object());
  if (!figures.is_object() || figures.empty()) return;
  page->BeginDetails("All figures of the reconstruction");
  Table table;
  for (const auto& [name, value] : figures.items()) {
    if (IsTable(value)) {
      AddJsonTable(name, value, page);
    } else {
      table.rows.push_back({name, JsonText(value)});
    }
  }
  page->AddTable(table);
  page->EndDetails();
}

void AddParametersSection(const ReportData& data, Page* page, Missing* missing) {
  if (!data.run.parameters) {
    if (!data.run.kernels_picture.empty()) return;  // kernels were fitted instead
    missing->push_back("Fitted parameters: the folder has no parameters.toml.");
    return;
  }
  const Parameters& parameters = *data.run.parameters;
  const ParameterPosterior& posterior = parameters.posterior;
  page->BeginSection("parameters", "Fitted model: " + parameters.model.name);
  Table free{{"free parameter", "value", "1 sd", "sd / value", "do the data determine it?"}, {}};
  Table fixed{{"held fixed", "value"}, {}};
  for (const auto& [name, value] : parameters.model.parameters) {
    const auto found = std::find(posterior.free.begin(), posterior.free.end(), name);
    if (found == posterior.free.end()) {
      fixed.rows.push_back({name, NumberText(value, 4)});
      continue;
    }
    const auto k = static_cast<std::size_t>(found - posterior.free.begin());
    const double sd = posterior.sd.at(k);
    const bool has_ratio = value != 0 && std::isfinite(sd);
    free.rows.push_back({name, NumberText(value, 4), NumberText(sd),
                         has_ratio ? NumberText(100 * sd / std::abs(value), 2) + " %" : "",
                         posterior.determined.at(k) ? "yes" : "no"});
  }
  page->AddTable(
      free,
      "As fitted to the reconstructed paths, in SI units. What the data do not determine "
      "may be almost anything.");
  if (!fixed.rows.empty()) {
    page->BeginDetails("Parameters that were held fixed");
    page->AddTable(fixed);
    page->EndDetails();
  }
  const std::size_t n = posterior.free.size();
  if (n < 2 || n > 16 || posterior.correlation.size() != n * n) return;
  page->BeginDetails("Correlation of the free parameters");
  Table matrix;
  matrix.header.push_back("");
  for (const std::string& name : posterior.free) matrix.header.push_back(name);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::string> row = {posterior.free[i]};
    for (std::size_t j = 0; j < n; ++j) {
      row.push_back(FixedText(posterior.correlation[i * n + j], 2));
    }
    matrix.rows.push_back(std::move(row));
  }
  page->AddTable(matrix, "Near 1 or -1, the data tell only a combination of the two.");
  page->EndDetails();
}

}  // namespace flocklift
