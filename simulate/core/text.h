// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reading numbers and words out of text that somebody else wrote.

#ifndef FLOCKLIFT_SIMULATE_CORE_TEXT_H_
#define FLOCKLIFT_SIMULATE_CORE_TEXT_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace flocklift {

// Without the spaces and tabs at both ends.
std::string_view Trim(std::string_view text);

// The whole of `text` as a finite number, or as a whole number ("3", "3.0" and "3e0" are all 3).
// Nothing when it is anything else. Locale-free.
std::optional<double> ParseReal(std::string_view text);
std::optional<std::int64_t> ParseInteger(std::string_view text);

// Foreign text for a message: on one line, shortened, printable; and the same in quotes.
std::string Printable(std::string_view text);
std::string Quoted(std::string_view text);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_TEXT_H_
