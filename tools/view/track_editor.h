// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tracks that a person mends: corrections one by one (track/correct.h), undone and redone. Each
// touches only the tracks that it names, however many there are, and each is at once a line of the
// corrections file, which `flocklift track --corrections` applies with the same result.

#ifndef FLOCKLIFT_TOOLS_VIEW_TRACK_EDITOR_H_
#define FLOCKLIFT_TOOLS_VIEW_TRACK_EDITOR_H_

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulate/core/io.h"
#include "simulate/core/observations.h"
#include "tools/view/cut.h"

namespace flocklift {

// The corrections file as it stands: `applied` are the lines that the tracks have already seen.
struct CorrectionsFile {
  std::filesystem::path path;
  std::string applied;              // ends with a newline, or is empty
  std::vector<Correction> pending;  // the lines after them
};

// `path` need not exist. `applied_sha256` is of the file that the tracks were made with, empty when
// they were made without one: the beginning of the file that has it is what was applied. Throws
// InputError for a file that is damaged, or of which no beginning is what was applied.
CorrectionsFile ReadCorrectionsFile(const std::filesystem::path& path,
                                    const std::string& applied_sha256);

// "swap 3 7 120": the correction's line.
std::string LineOf(const Correction& correction);

class TrackEditor {
 public:
  // Applies what is pending in the file; throws as ApplyCorrections does.
  TrackEditor(const TrackList& tracks, std::optional<double> fps, int frame_count,
              CorrectionsFile file);

  // Writes the file, then changes the tracks; throws InputError and changes nothing when the
  // correction does not fit. What was undone cannot be redone after it.
  void Apply(const Correction& correction);
  // False when there is nothing to undo or redo.
  bool Undo();
  bool Redo();

  Tracks Result() const;
  TrackList Current() const;  // the same without a copy
  std::size_t track_count() const { return tracks_.size(); }
  // The lines that are in force besides those applied before, and how many can be redone.
  std::vector<std::string> Lines() const;
  std::vector<Correction> Corrections() const;
  std::size_t redo_count() const { return undone_.size(); }
  // Ids that the last change made, changed or removed.
  const std::vector<Id>& touched() const { return touched_; }

 private:
  using TrackMap = std::map<Id, std::shared_ptr<const Tracklet>>;
  struct Step {
    Correction correction;
    TrackMap before;        // of the tracks it changed
    std::vector<Id> after;  // ids that it changed or made
    Id next_id_before = 1;
  };
  Step Change(const Correction& correction);
  Step ChangeFromTheStart(const Correction& correction);
  void Revert(const Step& step);
  void WriteFile(const std::vector<const Correction*>& corrections) const;
  std::vector<const Correction*> InForce() const;

  TrackMap first_;  // as they were before the corrections in force
  std::optional<double> fps_;
  int frame_count_;
  CorrectionsFile file_;
  TrackMap tracks_;
  Id next_id_ = 1;
  std::vector<Step> done_;
  std::vector<Correction> undone_;  // the one to redo first at the back
  std::vector<Id> touched_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_TRACK_EDITOR_H_
