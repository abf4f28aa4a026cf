// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reads what was left in large files when a folder was opened, while somebody looks already:
//   1. the rows for curves over time, of every n-th frame
//   2. the tracks into memory, to mend them and to solve
//   3. every row of the trajectories, once, to know all animals and whether all are sound; they
//      stay in their file
// What it does is told in words as news "reading": {"text": .., "faults": [..]}; no text: done. A
// fault is told by file, line and mend, and takes away only what needs the whole: frames that are
// sound can be looked at. A file that is not by frame after all is read into memory.

#ifndef FLOCKLIFT_TOOLS_VIEW_LATE_READER_H_
#define FLOCKLIFT_TOOLS_VIEW_LATE_READER_H_

#include <shared_mutex>
#include <string>
#include <vector>

#include "simulate/core/progress.h"
#include "tools/view/event_bus.h"
#include "tools/view/run_data.h"

namespace flocklift {

// All rows, part by part; none when the file is not by frame after all.
std::optional<Tracks> ReadAllTracks(const TableByFrame& file, const Progress& progress);
// The same of trajectories, of which nothing is kept but the ids.
std::optional<std::vector<Id>> ReadAllIds(const TableByFrame& file, const Progress& progress);

class LateReader {
 public:
  // `mutex` guards `data`.
  LateReader(RunData* data, std::shared_mutex* mutex, EventBus* bus)
      : data_(data), mutex_(mutex), bus_(bus) {}

  // `alive` may throw, to end it.
  void Run(const Progress& alive);

 private:
  void DrawCurves(const std::string& what, const Progress& alive);
  void TakeTracks(const Progress& alive);
  void CheckFlock(const std::string& what, const Progress& alive);
  Progress Telling(const std::string& words, const Progress& alive);
  void Tell(const std::string& text);
  void TellFault(const std::string& fault);
  // Changes the data by work(data) and tells the new versions.
  template <typename Work>
  void Change(const Work& work);

  RunData* data_;
  std::shared_mutex* mutex_;
  EventBus* bus_;
  std::string text_;
  std::vector<std::string> faults_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_LATE_READER_H_
