// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <utility>

#include "simulate/core/input_file.h"
#include "simulate/core/io.h"
#include "simulate/core/table.h"

namespace flocklift {
namespace {

enum Column { kX, kY, kZ, kSd };

}  // namespace

std::vector<Anchor> ReadAnchors(std::istream& stream, const std::string& name) {
  const internal::TableLayout layout{.name = "anchors", .columns = {{"x"}, {"y"}, {"z"}, {"sd"}}};
  std::vector<Anchor> anchors;
  std::map<std::pair<int, Id>, long> lines;
  const auto take = [&](const internal::TableRow& row) {
    const double* v = row.values;
    const auto [earlier, is_new] = lines.try_emplace({row.frame, row.id}, row.line);
    if (!is_new) {
      row.Fail(fmt::format("frame {} of id {} stands in line {} already", row.frame, row.id,
                           earlier->second),
               "take one of the two out");
    }
    if (!(v[kSd] > 0)) {
      row.Fail(fmt::format("sd is {:g}", v[kSd]), "say how sure the position is, in metres");
    }
    anchors.push_back({row.frame, row.id, {v[kX], v[kY], v[kZ]}, v[kSd]});
  };
  const internal::TableContents contents = internal::ReadCsvTable(stream, name, layout, take);
  if (anchors.empty()) {
    contents.place.Fail(0, "there are no rows", "give at least one known position");
  }
  return anchors;
}

std::vector<Anchor> ReadAnchors(const std::filesystem::path& path) {
  std::ifstream stream = OpenInput(path);
  return ReadAnchors(stream, path.string());
}

}  // namespace flocklift
