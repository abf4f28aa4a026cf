// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/suggest.h"

#include <algorithm>
#include <vector>

#include "simulate/core/text.h"

namespace flocklift {
namespace {

std::string Lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

}  // namespace

int EditDistance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<int> two_above(width), above(width), row(width);
  for (std::size_t k = 0; k < width; ++k) row[k] = static_cast<int>(k);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(two_above, above);
    std::swap(above, row);
    row[0] = static_cast<int>(i);
    for (std::size_t k = 1; k < width; ++k) {
      const int substituted = above[k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1);
      row[k] = std::min({above[k] + 1, row[k - 1] + 1, substituted});
      const bool swapped = i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1];
      if (swapped) row[k] = std::min(row[k], two_above[k - 2] + 1);
    }
  }
  return row.back();
}

std::string SuggestName(std::string_view unknown, std::span<const std::string> known) {
  // A name longer than any other by far is not a slip of the finger, and costs time to compare.
  constexpr std::size_t kLongest = 64;
  const std::string wanted = Lower(unknown.substr(0, kLongest));
  const std::string* nearest = nullptr;
  int smallest = 0;
  for (const std::string& name : known) {
    const int distance = EditDistance(wanted, Lower(name));
    if (nearest == nullptr || distance < smallest) {
      nearest = &name;
      smallest = distance;
    }
  }
  if (nearest == nullptr) return "there are none";
  if (smallest <= std::max<int>(1, static_cast<int>(nearest->size()) / 3)) {
    return "did you mean " + Quoted(*nearest) + "?";
  }
  constexpr std::size_t kMostListed = 40;
  std::string list = "known are " + Printable(known.front());
  for (const std::string& name : known.first(std::min(known.size(), kMostListed)).subspan(1)) {
    list += ", " + Printable(name);
  }
  if (known.size() > kMostListed) list += ", ...";
  return list;
}

}  // namespace flocklift
