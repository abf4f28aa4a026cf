// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Some frames of a large table of tracks or trajectories without the rest. Where rows stand by
// frame, as our writers leave them, the first row of a frame is found by halving: about
// log2(bytes) short reads of a text, log2(rows) of the column frame of an HDF5 table. There is no
// index to make or to keep, so a file opens as fast however long it is, and every read sees the
// file as it is then.

#ifndef FLOCKLIFT_SIMULATE_CORE_TABLE_BY_FRAME_H_
#define FLOCKLIFT_SIMULATE_CORE_TABLE_BY_FRAME_H_

#include <filesystem>
#include <optional>
#include <string>

#include "simulate/core/observations.h"
#include "simulate/core/table.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

class TableByFrame {
 public:
  // `table` is "tracks" or "trajectories". None for a file that must be read as a whole: no rows,
  // rows that do not stand by frame at the places where it is looked at, a first column other than
  // frame; and for HDF5 where the library does not bear several threads. Throws InputError when
  // the file cannot be opened.
  static std::optional<TableByFrame> Open(const std::filesystem::path& path,
                                          const std::string& table);

  const std::filesystem::path& path() const { return path_; }
  int first_frame() const { return first_frame_; }
  int last_frame() const { return last_frame_; }

  // Calls `take` for the rows of frames `first` to `last`, as ReadTable does for all. None when a
  // row among them is of another frame or out of order: the file is not by frame after all. Rows
  // are told by their line from the beginning of the text only if `counts_lines`, which reads all
  // that is before.
  std::optional<internal::TableContents> Read(const internal::TableLayout& layout, int first,
                                              int last, bool counts_lines,
                                              const internal::TakeRow& take) const;

 private:
  TableByFrame() = default;
  bool OpenText();
  bool OpenHdf5();

  std::filesystem::path path_;
  std::string table_;
  bool is_text_ = true;
  int first_frame_ = 1, last_frame_ = 0;
};

// Of frames `first` to `last` only: what ReadTracks and ReadTrajectories of the path say of them,
// faults included. Empty when there is no row; none when the file is not by frame after all.
std::optional<Tracks> ReadTracks(const TableByFrame& table, int first, int last);
std::optional<Trajectories> ReadTrajectories(const TableByFrame& table, int first, int last);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_TABLE_BY_FRAME_H_
