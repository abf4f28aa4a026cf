// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/track_editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "tools/stage.h"
#include "track/correct.h"

namespace flocklift {
namespace {

using Kind = Correction::Kind;

bool SameRows(const Tracklet& a, const Tracklet& b) {
  return std::equal(a.detections.begin(), a.detections.end(), b.detections.begin(),
                    b.detections.end(), [](const Detection& p, const Detection& q) {
                      return p.frame == q.frame && p.confidence == q.confidence &&
                             p.box.left == q.box.left && p.box.top == q.box.top &&
                             p.box.width == q.box.width && p.box.height == q.box.height;
                    });
}

template <typename Map>
TrackList ListOf(const Map& tracks) {
  TrackList list;
  for (const auto& [id, tracklet] : tracks) list.push_back(tracklet);
  return list;
}

// Ends of lines, the last line's included; 0 stands for nothing of the text.
std::vector<std::size_t> LineEnds(const std::string& text) {
  std::vector<std::size_t> ends = {0};
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '\n' || k + 1 == text.size()) ends.push_back(k + 1);
  }
  return ends;
}

}  // namespace

CorrectionsFile ReadCorrectionsFile(const std::filesystem::path& path,
                                    const std::string& applied_sha256) {
  CorrectionsFile file{.path = path, .applied = {}, .pending = {}};
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::size_t applied = 0;
  if (!applied_sha256.empty()) {
    const std::vector<std::size_t> ends = LineEnds(text);
    const auto end = std::find_if(ends.rbegin(), ends.rend(), [&](std::size_t at) {
      return Sha256OfText(std::string_view(text).substr(0, at)) == applied_sha256;
    });
    if (end == ends.rend()) {
      throw InputError(path.string(), 0, "is not the file that the tracks were corrected with",
                       "run `flocklift track` or `run` again with it");
    }
    applied = *end;
  }
  std::istringstream rest(text.substr(applied));
  file.pending = ReadCorrections(rest, path.string());
  file.applied = text.substr(0, applied);
  if (!file.applied.empty() && file.applied.back() != '\n') file.applied += '\n';
  return file;
}

std::string LineOf(const Correction& c) {
  switch (c.kind) {
    case Kind::kSwap:
      return fmt::format("swap {} {} {}", c.id, c.other_id, c.first_frame);
    case Kind::kSplit:
      return fmt::format("split {} {}", c.id, c.first_frame);
    case Kind::kJoin:
      return fmt::format("join {} {}", c.id, c.other_id);
    case Kind::kDelete:
      return c.first_frame == 0 ? fmt::format("delete {}", c.id)
                                : fmt::format("delete {} {} {}", c.id, c.first_frame, c.last_frame);
    case Kind::kPin:
      return fmt::format("pin {} {} {} {}", c.id, c.first_frame, c.point.x, c.point.y);
    case Kind::kAdd:
      return fmt::format("add {} {} {}", c.first_frame, c.point.x, c.point.y);
  }
  return {};
}

TrackEditor::TrackEditor(const TrackList& tracks, std::optional<double> fps, int frame_count,
                         CorrectionsFile file)
    : fps_(fps), frame_count_(frame_count), file_(std::move(file)) {
  for (const auto& tracklet : tracks) {
    next_id_ = std::max(next_id_, tracklet->id + 1);
    tracks_.emplace(tracklet->id, tracklet);
  }
  first_ = tracks_;
  for (const Correction& correction : file_.pending) done_.push_back(Change(correction));
}

TrackEditor::Step TrackEditor::Change(const Correction& correction) {
  // A pin may take rows of any track, and what follows must keep to it.
  const bool has_pins = correction.kind == Kind::kPin ||
                        std::any_of(done_.begin(), done_.end(), [](const Step& step) {
                          return step.correction.kind == Kind::kPin;
                        });
  if (has_pins) return ChangeFromTheStart(correction);
  Step step{.correction = correction, .before = {}, .after = {}, .next_id_before = next_id_};
  Tracks named;
  named.fps = fps_;
  const auto take = [&](Id id) {
    const auto found = tracks_.find(id);
    if (found != tracks_.end() && step.before.emplace(id, found->second).second) {
      named.tracklets.push_back(*found->second);
    }
  };
  if (correction.kind == Kind::kAdd) {  // it is as large as the others of the frame
    const int frame = correction.first_frame;
    named = Cut(Current(), frame, frame);
    if (named.tracklets.empty()) named = Result();
  } else {
    take(correction.id);
    if (correction.kind == Kind::kSwap || correction.kind == Kind::kJoin) {
      take(correction.other_id);
    }
  }
  Id next_id = next_id_;
  ApplyCorrections({&correction, 1}, file_.path.string(), frame_count_, &named, &next_id);
  for (const auto& [id, tracklet] : step.before) tracks_.erase(id);
  for (Tracklet& tracklet : named.tracklets) {
    const bool is_new = tracklet.id >= next_id_;
    if (!is_new && !step.before.contains(tracklet.id)) continue;  // looked at only
    step.after.push_back(tracklet.id);
    const Id id = tracklet.id;
    tracks_[id] = std::make_shared<const Tracklet>(std::move(tracklet));
  }
  next_id_ = next_id;
  touched_ = step.after;
  for (const auto& [id, tracklet] : step.before) touched_.push_back(id);
  return step;
}

TrackEditor::Step TrackEditor::ChangeFromTheStart(const Correction& correction) {
  Step step{.correction = correction, .before = {}, .after = {}, .next_id_before = next_id_};
  std::vector<Correction> in_force = Corrections();
  in_force.push_back(correction);
  Tracks now = AsTracks(ListOf(first_));
  now.fps = fps_;
  Id next_id = 1;
  ApplyCorrections(in_force, file_.path.string(), frame_count_, &now, &next_id);
  TrackMap left = std::move(tracks_);
  tracks_.clear();
  for (Tracklet& tracklet : now.tracklets) {
    const auto found = left.find(tracklet.id);
    const Id id = tracklet.id;
    if (found != left.end() && SameRows(*found->second, tracklet)) {
      tracks_[id] = std::move(found->second);
      left.erase(found);
      continue;
    }
    step.after.push_back(id);
    tracks_[id] = std::make_shared<const Tracklet>(std::move(tracklet));
  }
  step.before = std::move(left);
  next_id_ = next_id;
  touched_ = step.after;
  for (const auto& [id, tracklet] : step.before) touched_.push_back(id);
  return step;
}

void TrackEditor::Revert(const Step& step) {
  for (const Id id : step.after) tracks_.erase(id);
  for (const auto& [id, tracklet] : step.before) tracks_[id] = tracklet;
  next_id_ = step.next_id_before;
  touched_ = step.after;
  for (const auto& [id, tracklet] : step.before) touched_.push_back(id);
}

void TrackEditor::Apply(const Correction& correction) {
  Step step = Change(correction);
  std::vector<const Correction*> in_force = InForce();
  in_force.push_back(&step.correction);
  try {
    WriteFile(in_force);
  } catch (...) {
    Revert(step);
    throw;
  }
  done_.push_back(std::move(step));
  undone_.clear();
}

bool TrackEditor::Undo() {
  if (done_.empty()) return false;
  std::vector<const Correction*> in_force = InForce();
  in_force.pop_back();
  WriteFile(in_force);
  Revert(done_.back());
  undone_.push_back(done_.back().correction);
  done_.pop_back();
  return true;
}

bool TrackEditor::Redo() {
  if (undone_.empty()) return false;
  std::vector<Correction> rest = undone_;
  rest.pop_back();
  Apply(Correction(undone_.back()));
  undone_ = std::move(rest);
  return true;
}

Tracks TrackEditor::Result() const {
  Tracks tracks = AsTracks(Current());
  tracks.fps = fps_;
  return tracks;
}

TrackList TrackEditor::Current() const { return ListOf(tracks_); }

std::vector<std::string> TrackEditor::Lines() const {
  std::vector<std::string> lines;
  for (const Step& step : done_) lines.push_back(LineOf(step.correction));
  return lines;
}

std::vector<Correction> TrackEditor::Corrections() const {
  std::vector<Correction> corrections;
  for (const Step& step : done_) corrections.push_back(step.correction);
  return corrections;
}

std::vector<const Correction*> TrackEditor::InForce() const {
  std::vector<const Correction*> in_force;
  for (const Step& step : done_) in_force.push_back(&step.correction);
  return in_force;
}

void TrackEditor::WriteFile(const std::vector<const Correction*>& corrections) const {
  std::string text = file_.applied;
  for (const Correction* correction : corrections) text += LineOf(*correction) + '\n';
  if (text.empty()) {  // as it was before the first correction
    std::filesystem::remove(file_.path);
  } else {
    WriteTextFile(file_.path, text);
  }
}

}  // namespace flocklift
