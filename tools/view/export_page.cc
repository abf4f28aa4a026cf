// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/export_page.h"

#include <algorithm>

#include "tools/view/flock_series.h"
#include "tools/view/page_text.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kWindow = 64;  // frames; the page's WINDOW_OF_EXPORT
constexpr int kLeastWidth = 320;
constexpr int kSamples = 5;

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
  const PageText text(page);
  return text.With(
      json, "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; " +
                text.policy() +
                "; img-src blob: data:; font-src data:; base-uri 'none'; form-action 'none'\">\n");
}

}  // namespace flocklift
