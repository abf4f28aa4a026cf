// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Text and numbers as HTML and SVG take them.

#ifndef FLOCKLIFT_TOOLS_PLOT_MARKUP_H_
#define FLOCKLIFT_TOOLS_PLOT_MARKUP_H_

#include <string>
#include <string_view>

namespace flocklift {

// Safe as element content and inside quoted attributes: & < > " ' become entities, control
// characters that XML forbids and bytes that are no UTF-8 become U+FFFD.
std::string EscapeMarkup(std::string_view text);

// A number for people: `digits` significant ones, zeros at the end of the decimals left out, no
// exponent between 1e-4 and 1e7, a true minus.
std::string NumberText(double value, int digits = 3);

// A number for people with `decimals` places.
std::string FixedText(double value, int decimals);

// A coordinate in an SVG attribute: tenths of a pixel, as short as it goes.
std::string Coordinate(double px);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_PLOT_MARKUP_H_
