// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/table_by_frame.h"

#include <algorithm>
#include <istream>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/core/hdf5_table.h"
#include "simulate/core/input_file.h"
#include "simulate/core/text_rows.h"

namespace flocklift {
namespace {

using internal::Hdf5Frames;
using internal::TableContents;
using internal::TableLayout;
using internal::TableRow;
using internal::TextHead;
using internal::TextRows;

constexpr std::uint64_t kProbes = 64;  // places where the order is looked at when a file is opened

// A row that is not where it should be ends the reading.
struct NotByFrame {};

// Where the first row of `frame` or of a later one stands, of places `begin` to `end`; `end` when
// there is none. `row_from(place)` is the first row at a place or after it, with its frame. It
// depends on nothing else, so that parts that follow each other share no row and leave none out.
template <typename RowFrom>
std::uint64_t PlaceOf(int frame, std::uint64_t begin, std::uint64_t end, const RowFrom& row_from) {
  std::uint64_t low = begin, high = end, found = end;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    const auto row = row_from(middle);
    if (row && row->frame < frame) {
      low = row->place + 1;
    } else {
      if (row) found = row->place;
      high = middle;
    }
  }
  return found;
}

// The frames of the first and of the last row, or nothing when a probe between them is out of
// order or there is no row. Places where no row can be found are passed over.
template <typename RowFrom>
std::optional<std::pair<int, int>> Probe(std::uint64_t begin, std::uint64_t end,
                                         const RowFrom& row_from) {
  int first = 0, last = 0;
  for (std::uint64_t k = 0; k < kProbes; ++k) {
    const auto row = row_from(begin + (end - begin) * k / kProbes);
    if (!row) continue;
    if (row->frame < last) return std::nullopt;
    if (first == 0) first = row->frame;
    last = row->frame;
  }
  if (last == 0) return std::nullopt;
  // To the last row, which stands nearer to the end than any step of the probes.
  const std::uint64_t from = PlaceOf(last, begin, end, row_from);
  for (std::uint64_t low = from, high = end; low < high;) {
    const std::uint64_t middle = low + (high - low) / 2;
    const auto row = row_from(middle);
    if (!row) {
      high = middle;
      continue;
    }
    if (row->frame < last) return std::nullopt;
    last = row->frame;
    low = row->place + 1;
  }
  return std::pair(first, last);
}

}  // namespace

std::optional<TableByFrame> TableByFrame::Open(const std::filesystem::path& path,
                                               const std::string& table) {
  TableByFrame result;
  result.path_ = path;
  result.table_ = table;
  result.is_text_ = !internal::IsHdf5Name(path);
  if (!(result.is_text_ ? result.OpenText() : result.OpenHdf5())) return std::nullopt;
  return result;
}

bool TableByFrame::OpenText() {
  TextRows rows(path_);
  const std::optional<TextHead> head = rows.ReadHead(/*has_header=*/table_ == "trajectories");
  if (!head) return false;
  const auto span = Probe(head->end, rows.size(), [&](std::uint64_t at) { return rows.From(at); });
  if (span) std::tie(first_frame_, last_frame_) = *span;
  return span.has_value();
}

bool TableByFrame::OpenHdf5() {
  if (!internal::Hdf5BearsThreads()) return false;
  Hdf5Frames frames(path_, table_);
  const auto span = Probe(0, frames.size(), [&](std::uint64_t at) { return frames.From(at); });
  if (span) std::tie(first_frame_, last_frame_) = *span;
  return span.has_value();
}

std::optional<TableContents> TableByFrame::Read(const TableLayout& layout, int first, int last,
                                                bool counts_lines,
                                                const internal::TakeRow& take) const {
  const int after = std::max(last, 0) + 1;
  int before_row = first;  // the frame of the row before
  const internal::TakeRow checked = [&](const TableRow& row) {
    if (row.frame < before_row || row.frame > last) throw NotByFrame();
    before_row = row.frame;
    take(row);
  };
  try {
    if (!is_text_) {
      internal::RowSpan span;
      {
        Hdf5Frames frames(path_, table_);
        const auto row_from = [&](std::uint64_t at) { return frames.From(at); };
        span.first = PlaceOf(first, 0, frames.size(), row_from);
        const std::uint64_t end = PlaceOf(after, 0, frames.size(), row_from);
        span.count = std::max(end, span.first) - span.first;
      }
      return internal::ReadHdf5Table(path_, layout, checked, span);
    }
    TextRows rows(path_);
    const std::optional<TextHead> head = rows.ReadHead(layout.has_header);
    if (!head) return std::nullopt;
    const auto row_from = [&](std::uint64_t at) { return rows.From(at); };
    // What cannot be read at the beginning belongs to the first frames.
    const std::uint64_t begin =
        first <= first_frame_ ? head->end : PlaceOf(first, head->end, rows.size(), row_from);
    const std::uint64_t end = PlaceOf(after, head->end, rows.size(), row_from);
    const long before = counts_lines ? rows.CountLines(begin) : head->lines;
    return rows.Read(*head, begin, end, before, layout, checked);
  } catch (const NotByFrame&) {
    return std::nullopt;
  }
}

}  // namespace flocklift
