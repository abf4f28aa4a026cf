// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Rows in any order, gathered by animal: by increasing id, each by increasing frame. And back:
// the rows of all animals by frame, as files list them.

#ifndef FLOCKLIFT_SIMULATE_CORE_ANIMAL_ROWS_H_
#define FLOCKLIFT_SIMULATE_CORE_ANIMAL_ROWS_H_

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "simulate/core/table.h"

namespace flocklift::internal {

// Row has a member `frame`.
template <typename Row>
class AnimalRows {
 public:
  void Add(Id id, Row row, long line) {
    const auto [entry, is_new] = index_.try_emplace(id, animals_.size());
    if (is_new) animals_.push_back({.id = id, .rows = {}, .lines = {}});
    Animal& animal = animals_[entry->second];
    animal.rows.push_back(std::move(row));
    animal.lines.push_back(line);
  }

  // Calls `take(id, rows)` for each animal; fails at the first line that repeats a (frame, id).
  template <typename Take>
  void Finish(const TablePlace& place, const Take& take) {
    std::sort(animals_.begin(), animals_.end(),
              [](const Animal& a, const Animal& b) { return a.id < b.id; });
    Repetition first;
    for (Animal& animal : animals_) {
      SortByFrame(&animal);
      for (std::size_t k = 1; k < animal.rows.size(); ++k) {
        const bool repeats = animal.rows[k].frame == animal.rows[k - 1].frame;
        if (repeats && (first.line == 0 || animal.lines[k] < first.line)) {
          first = {animal.lines[k], animal.lines[k - 1], animal.rows[k].frame, animal.id};
        }
      }
    }
    if (first.line > 0) {
      place.Fail(first.line,
                 fmt::format("frame {} of id {} stands in {} {} already", first.frame, first.id,
                             place.is_text ? "line" : "row", first.earlier_line),
                 "take one of the two out, or give one another id");
    }
    for (Animal& animal : animals_) take(animal.id, std::move(animal.rows));
  }

 private:
  struct Animal {
    Id id;
    std::vector<Row> rows;
    std::vector<long> lines;
  };
  struct Repetition {
    long line = 0, earlier_line = 0;
    int frame = 0;
    Id id = 0;
  };

  static void SortByFrame(Animal* animal) {
    const auto by_frame = [](const Row& a, const Row& b) { return a.frame < b.frame; };
    if (std::is_sorted(animal->rows.begin(), animal->rows.end(), by_frame)) return;
    std::vector<std::size_t> order(animal->rows.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return animal->rows[a].frame < animal->rows[b].frame;
    });
    Animal sorted{.id = animal->id, .rows = {}, .lines = {}};
    sorted.rows.reserve(order.size());
    sorted.lines.reserve(order.size());
    for (const std::size_t k : order) {
      sorted.rows.push_back(std::move(animal->rows[k]));
      sorted.lines.push_back(animal->lines[k]);
    }
    *animal = std::move(sorted);
  }

  std::unordered_map<Id, std::size_t> index_;
  std::vector<Animal> animals_;
};

// Calls `take(id, row)` for the rows of all animals by frame, then id. `rows_of` gives an animal's
// rows, which must be by increasing frame. Each is wanted once, and the next one's frame: rows may
// be read as they are wanted; those with a Release() are told when the last was taken.
template <typename Animals, typename RowsOf, typename Take>
void ForEachByFrame(const Animals& animals, const RowsOf& rows_of, const Take& take) {
  using Next = std::tuple<Id, std::size_t, std::size_t>;  // id, animal, row
  std::map<int, std::vector<Next>> waiting;               // by frame
  for (std::size_t k = 0; k < animals.size(); ++k) {
    const auto& rows = rows_of(animals[k]);
    if (!rows.empty()) waiting[rows.front().frame].emplace_back(animals[k].id, k, 0);
  }
  while (!waiting.empty()) {
    std::vector<Next> now = std::move(waiting.begin()->second);
    waiting.erase(waiting.begin());
    // Those that go on from one frame to the next wait in order already.
    if (!std::is_sorted(now.begin(), now.end())) std::sort(now.begin(), now.end());
    auto next = waiting.end();
    for (const auto& [id, animal, row] : now) {
      const auto& rows = rows_of(animals[animal]);
      take(id, rows[row]);
      if (row + 1 == rows.size()) {
        if constexpr (requires { rows.Release(); }) rows.Release();
        continue;
      }
      const int frame = rows[row + 1].frame;
      if (next == waiting.end() || next->first != frame) next = waiting.try_emplace(frame).first;
      next->second.emplace_back(id, animal, row + 1);
    }
  }
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_ANIMAL_ROWS_H_
