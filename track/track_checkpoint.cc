// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/track_checkpoint.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "simulate/core/build_id.h"
#include "simulate/core/state_archive.h"
#include "track/video_source.h"

namespace flocklift::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kLayout = 3;  // of the saved state: another whenever something else is saved

// As a visitor of Describe.
struct TextOfOptions {
  std::string text;

  template <typename T>
  void operator()(std::string_view name, const T& value, Range /*range*/, std::string_view /*unit*/,
                  std::string_view /*help*/) {
    text += fmt::format("{} = {}\n", name, value);
  }
};

void AppendFile(const fs::path& path, std::string* text) {
  std::error_code none;
  *text += fmt::format("{} {} {}\n", path.string(), fs::file_size(path, none),
                       fs::last_write_time(path, none).time_since_epoch().count());
}

std::string BytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::string FingerprintOf(const TrackerOptions& options, const fs::path& footage) {
  TextOfOptions described;
  TrackerOptions copy = options;
  Describe(described, copy);
  std::string text = fmt::format("{} state {}\n", ProgramIdentity(), kLayout) + described.text;
  const std::vector<fs::path> pictures = FootagePictures(footage);
  if (pictures.empty()) AppendFile(fs::absolute(footage), &text);
  for (const fs::path& picture : pictures) AppendFile(fs::absolute(picture), &text);
  return text;
}

TrackCheckpoint::TrackCheckpoint(const CheckpointPlace& place, std::string fingerprint)
    : place_(place), fingerprint_(std::move(fingerprint)), last_(std::chrono::steady_clock::now()) {
  if (!place_.folder.empty()) sightings_.emplace(place_.folder / "sightings");
}

TrackCheckpoint::~TrackCheckpoint() {
  if (!has_state_) Remove();
}

// The state file: the fingerprint, the frame, the size of the sightings' file, the state.
std::optional<TrackCheckpoint::Saved> TrackCheckpoint::Load() {
  if (place_.folder.empty()) return std::nullopt;
  Saved saved;
  saved.state = BytesOf(place_.folder / "state");
  std::uint64_t size = 0;
  const std::size_t head = fingerprint_.size() + sizeof saved.frame + sizeof size;
  if (saved.state.starts_with(fingerprint_) && saved.state.size() >= head) {
    StateReader in(std::string_view(saved.state).substr(fingerprint_.size()));
    in.Take(&saved.frame);
    in.Take(&size);
    std::error_code none;
    const std::uintmax_t there = fs::file_size(place_.folder / "sightings", none);
    if (size == 0 || (!none && there >= size)) {
      saved.state.erase(0, head);
      has_state_ = true;
      return saved;
    }
  }
  Remove();
  return std::nullopt;
}

bool TrackCheckpoint::IsDue() const {
  return !place_.folder.empty() && std::chrono::steady_clock::now() - last_ >= place_.every;
}

void TrackCheckpoint::Keep(std::int64_t frame, std::string_view state) {
  StateWriter head;
  head.Put(frame);
  head.Put(sightings_->size());
  WriteTextFile(place_.folder / "state", fingerprint_ + head.bytes() + std::string(state));
  has_state_ = true;
  last_ = std::chrono::steady_clock::now();
}

void TrackCheckpoint::Remove() {
  std::error_code ignored;
  if (!place_.folder.empty()) fs::remove_all(place_.folder, ignored);
}

}  // namespace flocklift::internal
