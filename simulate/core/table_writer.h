// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Writes the tables of table.h row by row, as text or HDF5 by the file's name.

#ifndef FLOCKLIFT_SIMULATE_CORE_TABLE_WRITER_H_
#define FLOCKLIFT_SIMULATE_CORE_TABLE_WRITER_H_

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulate/core/table.h"

namespace flocklift::internal {

// How a table looks as text.
struct TextStyle {
  int decimals = -1;       // after the point; -1: nine significant digits
  std::string end_of_row;  // after the last column
};

class TableWriter {
 public:
  // The columns of `layout` whose optional group is in `has` are written.
  static std::unique_ptr<TableWriter> Create(const std::filesystem::path& path,
                                             const TableLayout& layout,
                                             const std::vector<bool>& has,
                                             std::optional<double> fps, const TextStyle& style);
  virtual ~TableWriter() = default;

  // `values`: one per column that is written. In text, `end_of_row` stands for the style's, unless
  // it is empty.
  virtual void Add(int frame, Id id, std::span<const double> values,
                   std::string_view end_of_row) = 0;
  void Add(int frame, Id id, std::span<const double> values) { Add(frame, id, values, {}); }
  virtual void Commit() = 0;
};

std::unique_ptr<TableWriter> CreateCsvWriter(const std::filesystem::path& path,
                                             const std::vector<std::string>& columns,
                                             bool has_header, std::optional<double> fps,
                                             const TextStyle& style);
std::unique_ptr<TableWriter> CreateHdf5Writer(const std::filesystem::path& path,
                                              const std::string& group,
                                              const std::vector<std::string>& columns,
                                              std::optional<double> fps);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_TABLE_WRITER_H_
