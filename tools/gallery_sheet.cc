// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/gallery_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "simulate/core/check.h"
#include "simulate/core/input_file.h"
#include "simulate/core/text.h"
#include "simulate/media/draw.h"
#include "simulate/media/image_codec.h"

namespace flocklift {
namespace {

constexpr int kGap = 6;        // between pictures [px]
constexpr int kCaption = 26;   // height of the line below a picture [px]
constexpr double kTextPx = 9;  // height of its capitals
constexpr std::uint8_t kPaper = 30;

// 12345678 as "12 345 678".
std::string Grouped(std::int64_t number) {
  std::string digits = std::to_string(number), text;
  for (std::size_t k = 0; k < digits.size(); ++k) {
    if (k > 0 && (digits.size() - k) % 3 == 0) text += ' ';
    text += digits[k];
  }
  return text;
}

// Three digits are worth showing.
std::string Rate(double per_second) {
  if (per_second >= 1000) {
    const auto whole = static_cast<std::int64_t>(per_second);
    std::int64_t unit = 1;
    while (whole / unit >= 1000) unit *= 10;
    return Grouped((whole + unit / 2) / unit * unit);
  }
  return fmt::format("{:.3g}", per_second);
}

std::string Share(double share) { return share > 0 ? fmt::format("{:.2g} %", 100 * share) : "0"; }

double PhaseTime(const nlohmann::json& summary, const std::string& name) {
  for (const auto& phase : summary.at("phases")) {
    if (phase.at("name") == name) return phase.at("cpu_s");
  }
  return 0;
}

}  // namespace

GalleryEntry ReadGalleryEntry(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path file = folder / "summary.simulate.json";
  GalleryEntry entry;
  entry.name = name;
  try {
    const auto summary = nlohmann::json::parse(ReadTextFile(file));
    const auto& figures = summary.at("figures");
    entry.agents = figures.at("agents");
    entry.mde_share = figures.at("mde_share");
    const double seconds = PhaseTime(summary, "step");
    if (seconds > 0) entry.steps_per_second = figures.at("steps").get<double>() / seconds;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file.string(), 0,
                     fmt::format("this is no summary of simulate ({})", error.what()),
                     "run `flocklift simulate` again");
  }
  entry.still = ReadImage(folder / "still.png");
  return entry;
}

std::vector<PaperFigures> ReadPaperFigures(const std::filesystem::path& path) {
  std::ifstream stream = OpenInput(path);
  std::vector<PaperFigures> papers;
  std::string line;
  bool is_header = true;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.empty() || line[0] == '#') continue;
    const auto first = line.find(','), second = line.find(',', first + 1);
    if (first == std::string::npos || second == std::string::npos) {
      throw InputError(path.string(), number, "there are fewer than three columns",
                       "write scene,frames per second,MDE");
    }
    if (!is_header) {
      papers.push_back({line.substr(0, first), line.substr(first + 1, second - first - 1),
                        line.substr(second + 1)});
    }
    is_header = false;
  }
  return papers;
}

Image ContactSheet(std::span<const GalleryEntry> entries, int columns) {
  Check(!entries.empty() && columns > 0, "a contact sheet needs pictures and columns");
  const int width = entries[0].still.width, height = entries[0].still.height;
  const int count = static_cast<int>(entries.size());
  columns = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  Image sheet(columns * (width + kGap) + kGap, rows * (height + kCaption + kGap) + kGap);
  std::fill(sheet.bgr.begin(), sheet.bgr.end(), kPaper);
  for (int k = 0; k < count; ++k) {
    const GalleryEntry& entry = entries[static_cast<std::size_t>(k)];
    Check(entry.still.width == width && entry.still.height == height,
          "the pictures of a contact sheet must be of one size");
    const int left = kGap + k % columns * (width + kGap);
    const int top = kGap + k / columns * (height + kCaption + kGap);
    for (int v = 0; v < height; ++v) {
      std::copy_n(entry.still.Row(v), 3 * width, sheet.Row(top + v) + 3 * left);
    }
    std::string caption = fmt::format("{}: {} agents", entry.name, Grouped(entry.agents));
    if (entry.steps_per_second > 0) {
      caption += fmt::format(", {} steps/s", Rate(entry.steps_per_second));
    }
    DrawText({left + 3.0, top + height + 18.0}, caption, {255, 255, 255}, kTextPx, &sheet);
  }
  return sheet;
}

std::string GalleryTable(std::span<const GalleryEntry> entries) {
  std::string table =
      "| scene | agents | steps/s, one core | the paper's frames/s | MDE share | the paper's |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: |\n";
  const auto or_none = [](const std::string& text) { return text.empty() ? "-" : text; };
  for (const GalleryEntry& entry : entries) {
    table +=
        fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", entry.name, Grouped(entry.agents),
                    entry.steps_per_second > 0 ? Rate(entry.steps_per_second) : "-",
                    or_none(entry.paper_rate), Share(entry.mde_share), or_none(entry.paper_mde));
  }
  return table;
}

}  // namespace flocklift
