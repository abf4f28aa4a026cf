// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/page_text.h"

#include <cstdint>
#include <span>
#include <vector>

#include "tools/report/video_frame.h"
#include "tools/stage.h"

namespace flocklift {
namespace {

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

}  // namespace

std::string AsBase64(std::string_view bytes) {
  return Base64(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

// None may end its element from within.
PageText::PageText(const PageFiles& page)
    : script_(Replaced(std::string(page.script), "</script", "<\\/script")),
      later_(Replaced(std::string(page.later), "</script", "<\\/script")),
      style_(Replaced(std::string(page.style), "</style", "<\\/style")),
      policy_("script-src " + PolicyHash(script_) + " " + PolicyHash(later_) + "; style-src " +
              PolicyHash(style_)) {}

std::string PageText::With(const nlohmann::ordered_json& data, std::string_view head) const {
  const std::string text = Replaced(
      data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace), "<", "\\u003c");
  std::string html = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  html += head;
  html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += "<link rel=\"icon\" href=\"data:,\">\n";
  html += "<title>flocklift</title>\n<style>" + style_ + "</style>\n</head>\n<body>\n";
  html += "<div id=\"app\"><noscript>This page needs JavaScript.</noscript></div>\n";
  html += "<script type=\"application/json\" id=\"flocklift-data\">" + text + "</script>\n";
  html += "<script>" + script_ + "</script>\n";
  // The page runs it when it has shown something.
  html += "<script type=\"text/plain\" id=\"flocklift-later\">" + later_ + "</script>\n";
  html += "</body>\n</html>\n";
  return html;
}

}  // namespace flocklift
