// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a person who mistyped a name probably meant.

#ifndef FLOCKLIFT_SIMULATE_CORE_SUGGEST_H_
#define FLOCKLIFT_SIMULATE_CORE_SUGGEST_H_

#include <span>
#include <string>
#include <string_view>

namespace flocklift {

// Fewest insertions, deletions, substitutions and swaps of neighbouring characters that turn `a`
// into `b` (optimal string alignment).
int EditDistance(std::string_view a, std::string_view b);

// The mend of an unknown name: "did you mean `speed`?" when one of `known` is near (a third of its
// length may differ, upper case counts as lower), otherwise "known are a, b, c".
std::string SuggestName(std::string_view unknown, std::span<const std::string> known);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_SUGGEST_H_
