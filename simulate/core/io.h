// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Readers and writers of tracks, shapes, trajectories, anchors and corrections: the files that
// every stage exchanges. A reader checks all that it reads and throws InputError (file, line,
// mend); a writer writes aside and renames, so a failure leaves no file. Names that end in .h5 are
// HDF5 tables (one dataset per column), all others CSV. Every parser also takes a stream, with a
// name for its messages.

#ifndef FLOCKLIFT_SIMULATE_CORE_IO_H_
#define FLOCKLIFT_SIMULATE_CORE_IO_H_

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulate/core/observations.h"
#include "simulate/core/trajectory.h"

namespace flocklift {

namespace internal {
class TableWriter;
}

// ---- tracks: MOTChallenge, `frame,id,left,top,width,height,confidence,-1,-1,-1`, no header ------

// One row of a tracks file. Detections have id kNoId.
struct TrackRow {
  Id id = kNoId;
  Detection detection;
};

// Calls `take` for every row as it is read: bounded memory, hence no check that a (frame, id)
// occurs only once. Returns the `# fps=` comment, if any.
std::optional<double> ForEachTrackRow(const std::filesystem::path& path,
                                      const std::function<void(const TrackRow&)>& take);
std::optional<double> ForEachTrackRow(std::istream& stream, const std::string& name,
                                      const std::function<void(const TrackRow&)>& take);

Tracks ReadTracks(const std::filesystem::path& path);
Tracks ReadTracks(std::istream& stream, const std::string& name);
// By frame, then id.
void WriteTracks(const std::filesystem::path& path, const Tracks& tracks);
// The same for the truth of a simulation. MOTChallenge's ground truth has the visibility in its
// ninth column, and scorers may leave out rows where it is low: it is the share that obstacles
// leave to be seen, so that animals behind others count.
void WriteTrueTracks(const std::filesystem::path& path, const Tracks& tracks);

// Writes rows as they come: bounded memory. Without Commit no file appears.
class TrackWriter {
 public:
  TrackWriter(const std::filesystem::path& path, std::optional<double> fps, bool is_truth = false);
  ~TrackWriter();
  void Add(Id id, const Detection& detection);
  void Commit();

 private:
  std::unique_ptr<internal::TableWriter> writer_;
  bool is_truth_;
};

// As tracks, id -1; frames that have no detection are not listed.
std::vector<DetectionFrame> ReadDetections(const std::filesystem::path& path);
std::vector<DetectionFrame> ReadDetections(std::istream& stream, const std::string& name);
void WriteDetections(const std::filesystem::path& path, const std::vector<DetectionFrame>& frames);

// ---- shapes: `frame,id,major,minor,angle,area`, with header, beside tracks ----------------------

// Attaches each shape to the detection of its frame and id; a shape without one is an error.
void ReadShapes(const std::filesystem::path& path, Tracks* tracks);
void ReadShapes(std::istream& stream, const std::string& name, Tracks* tracks);
// Writes the detections that have a shape.
void WriteShapes(const std::filesystem::path& path, const Tracks& tracks);

// Writes the shapes of rows as they come, of those that have one. Without Commit no file appears.
class ShapeWriter {
 public:
  ShapeWriter(const std::filesystem::path& path, std::optional<double> fps);
  ~ShapeWriter();
  void Add(Id id, const Detection& detection);
  void Commit();

 private:
  std::unique_ptr<internal::TableWriter> writer_;
};

// ---- trajectories: `frame,id,x,y,z` and the optional columns, with header -----------------------

Trajectories ReadTrajectories(const std::filesystem::path& path);
Trajectories ReadTrajectories(std::istream& stream, const std::string& name);
// By frame, then id; the optional columns that `trajectories` says it has.
void WriteTrajectories(const std::filesystem::path& path, const Trajectories& trajectories);

// Writes rows as they come: bounded memory. Without Commit no file appears. `like` tells fps and
// the optional columns; its points are not written.
class TrajectoryWriter {
 public:
  TrajectoryWriter(const std::filesystem::path& path, const Trajectories& like);
  ~TrajectoryWriter();
  void Add(Id id, const TrajectoryPoint& point);
  void Commit();

 private:
  bool has_velocity_, has_orientation_, has_sd_depth_;
  std::unique_ptr<internal::TableWriter> writer_;
};

// ---- anchors: `frame,id,x,y,z,sd`, with header
// ---------------------------------------------------

// A position that somebody knows, in the world frame, with its standard deviation [m].
struct Anchor {
  int frame = 0;
  Id id = 0;
  Vec3d position;
  double sd = 1;
};
std::vector<Anchor> ReadAnchors(const std::filesystem::path& path);
std::vector<Anchor> ReadAnchors(std::istream& stream, const std::string& name);

// ---- corrections: one operation a line, `#` starts a comment
// -------------------------------------

// A person's edit of tracks. Which fields mean something depends on the kind.
struct Correction {
  enum class Kind { kSwap, kSplit, kJoin, kDelete, kPin, kAdd };
  Kind kind = Kind::kSwap;
  Id id = 0;
  Id other_id = 0;      // swap, join
  int first_frame = 0;  // swap, split, pin, add; delete: 0 means all frames
  int last_frame = 0;   // delete
  Vec2d point;          // pin, add [px]
  int line = 0;         // of the file, for messages
};
std::vector<Correction> ReadCorrections(const std::filesystem::path& path);
std::vector<Correction> ReadCorrections(std::istream& stream, const std::string& name);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_IO_H_
