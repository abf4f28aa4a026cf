// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers as the text of tables, fast. The digits are those of printf, correctly rounded: with
// 10^k a power that doubles hold exactly, x 10^k is off by half a unit in the last place at most,
// so its nearest integer holds the digits of x unless it lies within that error of half-way
// between two of them. Those, and numbers of unusual size, take the slow way.

#ifndef FLOCKLIFT_SIMULATE_CORE_NUMBER_TEXT_H_
#define FLOCKLIFT_SIMULATE_CORE_NUMBER_TEXT_H_

#include <fmt/format.h>

#include <cstdint>

namespace flocklift::internal {

// As {:.9g}.
void AppendNineDigits(double value, fmt::memory_buffer* text);

// As {:.Nf} with N = decimals, at least 0.
void AppendFixed(double value, int decimals, fmt::memory_buffer* text);

void AppendInteger(std::int64_t value, fmt::memory_buffer* text);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_NUMBER_TEXT_H_
