// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/table_writer.h"

#include "simulate/core/hdf5_table.h"

namespace flocklift::internal {

std::unique_ptr<TableWriter> TableWriter::Create(const std::filesystem::path& path,
                                                 const TableLayout& layout,
                                                 const std::vector<bool>& has,
                                                 std::optional<double> fps,
                                                 const TextStyle& style) {
  std::vector<std::string> columns;
  for (const TableColumn& column : layout.columns) {
    if (has[static_cast<std::size_t>(column.group)]) columns.push_back(column.name);
  }
  if (IsHdf5Name(path)) return CreateHdf5Writer(path, layout.name, columns, fps);
  return CreateCsvWriter(path, columns, layout.has_header, fps, style);
}

}  // namespace flocklift::internal
