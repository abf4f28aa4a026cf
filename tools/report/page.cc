// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/plot/markup.h"
#include "tools/plot/plot.h"
#include "tools/report/page_style.h"

namespace flocklift {
namespace {

std::string Caption(const std::string& text) {
  return text.empty() ? "" : fmt::format("<figcaption>{}</figcaption>", EscapeMarkup(text));
}

}  // namespace

Page::Page(std::string title, std::string subtitle)
    : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

void Page::CloseSection() {
  if (in_section_) body_ += "</section>\n";
  in_section_ = false;
}

void Page::BeginSection(const std::string& id, const std::string& heading) {
  CloseSection();
  sections_.emplace_back(id, heading);
  body_ +=
      fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", EscapeMarkup(id), EscapeMarkup(heading));
  in_section_ = true;
}

void Page::AddText(const std::string& text) {
  body_ += fmt::format("<p>{}</p>\n", EscapeMarkup(text));
}

void Page::AddNote(const std::string& text) {
  body_ += fmt::format("<p class=\"note\">{}</p>\n", EscapeMarkup(text));
}

void Page::AddCards(const std::vector<Card>& cards) {
  body_ += "<div class=\"cards\">\n";
  for (const Card& card : cards) {
    body_ += fmt::format(
        "<div class=\"card\"><div class=\"name\">{}</div><div class=\"value\">{}</div>"
        "<div class=\"more\">{}</div></div>\n",
        EscapeMarkup(card.label), EscapeMarkup(card.value), EscapeMarkup(card.note));
  }
  body_ += "</div>\n";
}

void Page::AddFigure(const std::string& markup, const std::string& caption) {
  body_ += fmt::format("<figure>{}{}</figure>\n", markup, Caption(caption));
}

void Page::BeginGrid(int columns) {
  body_ += fmt::format("<div class=\"grid grid{}\">\n", std::clamp(columns, 2, 4));
}

void Page::EndGrid() { body_ += "</div>\n"; }

void Page::AddTable(const Table& table, const std::string& caption) {
  body_ += "<figure><div class=\"scroll\"><table>";
  if (!table.header.empty()) {
    body_ += "<thead><tr>";
    for (const std::string& cell : table.header) {
      body_ += fmt::format("<th>{}</th>", EscapeMarkup(cell));
    }
    body_ += "</tr></thead>";
  }
  body_ += "<tbody>\n";
  for (const auto& row : table.rows) {
    body_ += "<tr>";
    for (const std::string& cell : row) body_ += fmt::format("<td>{}</td>", EscapeMarkup(cell));
    body_ += "</tr>\n";
  }
  body_ += fmt::format("</tbody></table></div>{}</figure>\n", Caption(caption));
}

void Page::AddBars(const std::vector<Bar>& bars, const std::string& caption) {
  double longest = 0;
  for (const Bar& bar : bars) longest = std::max(longest, bar.length);
  body_ += "<figure><div class=\"bars\">\n";
  for (const Bar& bar : bars) {
    const double percent = longest > 0 ? 100 * bar.length / longest : 0;
    body_ += fmt::format(
        "<span class=\"name\">{}</span><span class=\"track\"><span class=\"fill\" "
        "style=\"width:{:.2f}%;background:{}\"></span></span><span class=\"value\">{}</span>\n",
        EscapeMarkup(bar.label), percent, SeriesColor(bar.color), EscapeMarkup(bar.value));
  }
  body_ += fmt::format("</div>{}</figure>\n", Caption(caption));
}

void Page::BeginDetails(const std::string& summary) {
  body_ += fmt::format("<details><summary>{}</summary>\n", EscapeMarkup(summary));
}

void Page::EndDetails() { body_ += "</details>\n"; }

std::string Page::Html() const {
  std::string links;
  for (const auto& [id, heading] : sections_) {
    links += fmt::format("<a href=\"#{}\">{}</a>\n", EscapeMarkup(id), EscapeMarkup(heading));
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "style-src 'unsafe-inline'; img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}</title>\n<style>\n{1}</style>\n</head>\n<body>\n"
      "<header><h1>{0}</h1><p>{2}</p></header>\n<nav>{3}</nav>\n<main>\n{4}{5}</main>\n"
      "</body>\n</html>\n",
      EscapeMarkup(title_), kPageStyle, EscapeMarkup(subtitle_), links, body_,
      in_section_ ? "</section>\n" : "");
}

}  // namespace flocklift
