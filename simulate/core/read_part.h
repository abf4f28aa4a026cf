// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reading some frames of a table with what reads a whole one.

#ifndef FLOCKLIFT_SIMULATE_CORE_READ_PART_H_
#define FLOCKLIFT_SIMULATE_CORE_READ_PART_H_

#include <optional>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/table_by_frame.h"

namespace flocklift::internal {

// `read_with(read)` makes a value of read(layout, take), a reader of tables. Lines are counted when
// there is a fault to tell: the part is then read again.
template <typename ReadWith>
auto ReadPart(const TableByFrame& table, int first, int last, const ReadWith& read_with) {
  bool is_by_frame = true;
  const auto read_once = [&](bool counts_lines) {
    return read_with([&](const TableLayout& layout, const TakeRow& take) {
      auto contents = table.Read(layout, first, last, counts_lines, take);
      is_by_frame = contents.has_value();
      if (is_by_frame) return std::move(*contents);
      TableContents none;
      none.has.resize(static_cast<std::size_t>(layout.group_count) + 1);
      return none;
    });
  };
  const auto value_of = [&](auto value) {
    return is_by_frame ? std::optional(std::move(value)) : std::nullopt;
  };
  try {
    return value_of(read_once(false));
  } catch (const InputError&) {
    return value_of(read_once(true));
  }
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_READ_PART_H_
