// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One self-contained HTML page: sections of figures, tables and words, with its style inside and
// nothing fetched from outside. All text is escaped; the page forbids scripts altogether.

#ifndef FLOCKLIFT_TOOLS_REPORT_PAGE_H_
#define FLOCKLIFT_TOOLS_REPORT_PAGE_H_

#include <string>
#include <vector>

namespace flocklift {

// A headline figure.
struct Card {
  std::string value;  // with unit
  std::string label;
  std::string note = {};  // smaller, below
};

struct Table {
  std::vector<std::string> header;             // may be empty
  std::vector<std::vector<std::string>> rows;  // the first column is text, the others numbers
};

// A horizontal bar: a share of the longest.
struct Bar {
  std::string label;
  std::string value;
  double length = 0;
  std::size_t color = 0;
};

class Page {
 public:
  Page(std::string title, std::string subtitle);

  void BeginSection(const std::string& id, const std::string& heading);
  void AddText(const std::string& text);
  void AddNote(const std::string& text);  // something to beware of
  void AddCards(const std::vector<Card>& cards);
  // `markup` is SVG made by this program; figures between BeginGrid and EndGrid stand side by side.
  void AddFigure(const std::string& markup, const std::string& caption);
  void BeginGrid(int columns);
  void EndGrid();
  void AddTable(const Table& table, const std::string& caption = "");
  void AddBars(const std::vector<Bar>& bars, const std::string& caption);
  // Folded away until somebody opens it.
  void BeginDetails(const std::string& summary);
  void EndDetails();

  std::string Html() const;

 private:
  void CloseSection();

  std::string title_, subtitle_, body_;
  std::vector<std::pair<std::string, std::string>> sections_;  // id, heading
  bool in_section_ = false;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPORT_PAGE_H_
