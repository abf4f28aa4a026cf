// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/export_page.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tools/report/video_frame.h"
#include "tools/stage.h"
#include "tools/view/flock_series.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kWindow = 64;  // frames; the page's WINDOW_OF_EXPORT
constexpr int kLeastWidth = 320;
constexpr int kSamples = 5;

std::string AsBase64(std::string_view bytes) {
  return Base64(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

// What a content security policy calls a script or style by: its SHA-256 in base 64.
std::string PolicyHash(std::string_view text) {
  const std::string hex = Sha256OfText(text);
  std::vector<std::uint8_t> bytes;
  for (std::size_t k = 0; k < hex.size(); k += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(k, 2), nullptr, 16)));
  }
  return "'sha256-" + Base64(bytes) + "'";
}

std::string Replaced(std::string text, std::string_view what, std::string_view with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size()) {
    text.replace(at, what.size(), with);
  }
  return text;
}

Json WindowsOf(const RunData& data, const std::string& what) {
  Json list = Json::array();
  for (int first = 0, last = data.Span().last; first <= last; first += kWindow) {
    list.push_back(AsBase64(data.Window(what, first, first + kWindow - 1)));
  }
  return list;
}

// Width and stride with which the pictures stay within the bytes, from a few of them.
struct PicturePlan {
  int width = 0, stride = 1;
};
PicturePlan PlanPictures(Footage* footage, const ExportOptions& options) {
  PicturePlan plan{.width = std::min(options.picture_width, footage->width())};
  while (true) {
    std::size_t sampled = 0;
    for (int k = 0; k < kSamples; ++k) {
      sampled += footage->Jpeg(1 + (footage->frame_count() - 1) * k / kSamples, plan.width).size();
    }
    const double total = static_cast<double>(sampled) / kSamples * footage->frame_count();
    const double share = total / static_cast<double>(options.most_picture_bytes);
    if (share <= 1) return plan;
    if (plan.width * 3 / 4 < kLeastWidth) {
      plan.stride = static_cast<int>(share) + 1;
      return plan;
    }
    plan.width = plan.width * 3 / 4;
  }
}

}  // namespace

std::string MakeExportPage(const PageFiles& page, const RunData& data,
                           const ExportOptions& options) {
  Json json;
  json["session"] = data.Session();
  json["session"].erase("solve");  // options and file names are nobody's business
  json["session"]["solve"] = {{"values", {{"wingspan", data.Command().wingspan}}},
                              {"options", Json::array()},
                              {"command", ""},
                              {"reason", "exported"}};
  json["session"]["edits"] = {{"reason", "exported"}, {"lines", Json::array()}, {"redo", 0}};
  json["windowLength"] = kWindow;
  for (const char* what : {"boxes", "before", "truth"}) {
    const bool is_there = what == std::string("boxes") || data.FlockOf(what) != nullptr;
    json["windows"][what] = is_there ? WindowsOf(data, what) : Json::array();
  }
  json["series"] = FlockSeries(data.Curves("before"), data.run().camera);
  json["pictures"] = Json::array();
  json["stride"] = 1;
  if (const auto& footage = data.footage()) {
    const PicturePlan plan = PlanPictures(footage.get(), options);
    json["stride"] = plan.stride;
    for (int frame = 1; frame <= footage->frame_count(); frame += plan.stride) {
      json["pictures"].push_back(AsBase64(footage->Jpeg(frame, plan.width)));
    }
  }
  // Neither may end its element from within.
  const std::string script = Replaced(std::string(page.script), "</script", "<\\/script");
  const std::string style = Replaced(std::string(page.style), "</style", "<\\/style");
  const std::string text =
      Replaced(json.dump(-1, ' ', false, Json::error_handler_t::replace), "<", "\\u003c");
  std::string html = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  html += "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src " +
          PolicyHash(script) + "; style-src " + PolicyHash(style) +
          "; img-src blob: data:; font-src data:; base-uri 'none'; form-action 'none'\">\n";
  html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += "<link rel=\"icon\" href=\"data:,\">\n";
  html += "<title>flocklift</title>\n<style>" + style + "</style>\n</head>\n<body>\n";
  html += "<div id=\"app\"><noscript>This page needs JavaScript.</noscript></div>\n";
  html += "<script type=\"application/json\" id=\"flocklift-data\">" + text + "</script>\n";
  html += "<script>" + script + "</script>\n</body>\n</html>\n";
  return html;
}

}  // namespace flocklift
