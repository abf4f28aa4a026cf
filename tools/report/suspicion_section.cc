// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include "tools/report/sections.h"

namespace flocklift {
namespace {

constexpr std::size_t kMostRows = 20;

std::string Member(const nlohmann::ordered_json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? "" : JsonText(*found);
}

}  // namespace

void AddSuspicionSection(const ReportData& data, Page* page, Missing* missing) {
  const auto& suspicious = data.run.Figure("track", "suspicious");
  if (!suspicious.is_array()) {
    missing->push_back("Frames to look at: the folder has no summary.track.json that lists them.");
    return;
  }
  page->BeginSection("suspicious", "Frames to look at");
  if (suspicious.empty()) {
    page->AddText("No decision of the tracker was a close one.");
    return;
  }
  Table table{{"what", "frame", "to", "tracks", "chance of a mistake", "--picture"}, {}};
  for (const auto& s : suspicious) {
    if (table.rows.size() == kMostRows) break;
    if (!s.is_object()) continue;
    table.rows.push_back({Member(s, "kind"), Member(s, "frame"), Member(s, "last_frame"),
                          Member(s, "ids"), Member(s, "chance"), Member(s, "picture")});
  }
  page->AddTable(
      table,
      fmt::format("The likeliest mistakes first, {} of {}. `flocklift track` with "
                  "--picture and the last column draws the frames; swap, split, join, "
                  "pin or delete in a file for --corrections mends them.",
                  table.rows.size(), JsonText(data.run.Figure("track", "suspicious_count"))));
}

}  // namespace flocklift
