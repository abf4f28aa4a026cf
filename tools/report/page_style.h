// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The look of the page. Series colours --c0 .. --c7 follow Okabe and Ito (2008) and Tol (2021):
// apart for colour-blind eyes, readable on white and, lightened, on dark.

#ifndef FLOCKLIFT_TOOLS_REPORT_PAGE_STYLE_H_
#define FLOCKLIFT_TOOLS_REPORT_PAGE_STYLE_H_

#include <string_view>

namespace flocklift {

inline constexpr std::string_view kPageStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #f6f7f9; --panel: #ffffff; --ink: #1b2330; --muted: #5d6877; --line: #dfe3e8;
  --grid: #e8ebef; --accent: #0072b2; --note: #fff6e0; --note-line: #e69f00;
  --c0: #0072b2; --c1: #d55e00; --c2: #009e73; --c3: #b3589a; --c4: #c98a00; --c5: #3f9bd4;
  --c6: #882255; --c7: #7d7d22;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #11151b; --panel: #1a2028; --ink: #e6eaf0; --muted: #9aa6b5; --line: #2d3641;
    --grid: #29323d; --accent: #5ab4ee; --note: #2d2616; --note-line: #c98a00;
    --c0: #4fa8e0; --c1: #ff8a4c; --c2: #2cc79b; --c3: #e29bc6; --c4: #f2b733; --c5: #8ccbf2;
    --c6: #d97bab; --c7: #c2c24f;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0; background: var(--page); color: var(--ink);
  font: 15px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans",
    sans-serif;
}
header, nav, main { max-width: 1140px; margin: 0 auto; padding: 0 24px; }
header { padding-top: 36px; }
h1 { font-size: 28px; line-height: 1.2; margin: 0; letter-spacing: -0.01em; }
header p { margin: 6px 0 0; color: var(--muted); font-size: 16px; }
nav {
  position: sticky; top: 0; z-index: 1; display: flex; flex-wrap: wrap; gap: 2px 18px;
  padding-top: 12px; padding-bottom: 12px; margin-top: 14px; background: var(--page);
  border-bottom: 1px solid var(--line); font-size: 14px;
}
nav a { color: var(--muted); text-decoration: none; }
nav a:hover { color: var(--accent); }
section { margin: 26px 0 40px; scroll-margin-top: 56px; }
h2 { font-size: 20px; margin: 0 0 10px; letter-spacing: -0.005em; }
p { margin: 0 0 12px; max-width: 78ch; }
.note {
  background: var(--note); border-left: 4px solid var(--note-line); border-radius: 4px;
  padding: 8px 14px; max-width: none;
}
figure {
  margin: 0 0 18px; padding: 14px 16px 12px; background: var(--panel);
  border: 1px solid var(--line); border-radius: 8px; overflow-x: auto;
}
figcaption { margin-top: 8px; color: var(--muted); font-size: 13.5px; max-width: 100ch; }
.grid { display: grid; gap: 16px; margin-bottom: 18px; }
.grid > figure { margin: 0; }
.grid2 { grid-template-columns: repeat(auto-fit, minmax(min(100%, 440px), 1fr)); }
.grid3 { grid-template-columns: repeat(auto-fit, minmax(min(100%, 300px), 1fr)); }
.grid4 { grid-template-columns: repeat(auto-fit, minmax(min(100%, 225px), 1fr)); gap: 12px; }
.grid4 > figure { padding: 10px 10px 6px; }
.cards {
  display: grid; gap: 12px; margin-bottom: 18px;
  grid-template-columns: repeat(auto-fill, minmax(165px, 1fr));
}
.card {
  background: var(--panel); border: 1px solid var(--line); border-radius: 8px;
  padding: 12px 16px 11px;
}
.card .name { color: var(--muted); font-size: 13px; }
.card .value { font-size: 25px; line-height: 1.25; font-weight: 600; letter-spacing: -0.01em;
  font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
.card .more { color: var(--muted); font-size: 12.5px; line-height: 1.4; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 14px; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 18px 4px 0; text-align: right; border-bottom: 1px solid var(--line);
  vertical-align: top; }
th { color: var(--muted); font-weight: 500; }
th:first-child, td:first-child { text-align: left; }
tbody tr:last-child td { border-bottom: 0; }
.bars {
  display: grid; grid-template-columns: max-content 1fr max-content; gap: 6px 14px;
  align-items: center; font-size: 14px; font-variant-numeric: tabular-nums;
}
.bars .track { background: var(--grid); border-radius: 4px; height: 14px; overflow: hidden; }
.bars .fill { display: block; height: 100%; min-width: 2px; border-radius: 4px; }
.bars .value { text-align: right; color: var(--muted); }
details { margin-bottom: 14px; }
summary { cursor: pointer; color: var(--accent); margin-bottom: 8px; }
svg.plot { display: block; width: 100%; height: auto; }
svg.plot.wide { min-width: 640px; }
svg.plot text { font-family: inherit; font-size: 12px; fill: var(--ink); }
svg.plot .title { font-size: 14px; font-weight: 600; }
svg.plot .label { fill: var(--muted); }
svg.plot .tick { fill: var(--muted); font-size: 11.5px; font-variant-numeric: tabular-nums; }
svg.plot .halo { paint-order: stroke; stroke: var(--panel); stroke-width: 4px; }
svg.plot .grid { stroke: var(--grid); stroke-width: 1; fill: none; }
svg.plot .axis { stroke: var(--muted); stroke-width: 1; fill: none; }
svg.plot .arrow { stroke: var(--panel); stroke-width: 0.8; }
svg.picture { display: block; width: 100%; height: auto; border-radius: 4px; }
svg.picture text { font: 600 15px system-ui, sans-serif; paint-order: stroke;
  stroke: rgba(0, 0, 0, 0.65); stroke-width: 3px; stroke-linejoin: round; }
@media print { nav { position: static; } figure { break-inside: avoid; } }
)css";

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPORT_PAGE_STYLE_H_
