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
#include "simulate/core/state_archive.h"
#include "track/video_source.h"

namespace flocklift::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kLayout = 2;  // of the saved state: another whenever something else is saved

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
  std::string text =
      fmt::format("flocklift {} state {}\n", FLOCKLIFT_VERSION, kLayout) + described.text;
  const std::vector<fs::path> pictures = FootagePictures(footage);
  if (pictures.empty()) AppendFile(fs::absolute(footage), &text);
  for (const fs::path& picture : pictures) AppendFile(fs::absolute(picture), &text);
  return text;
}

TrackCheckpoint::TrackCheckpoint(const CheckpointPlace& place, std::string fingerprint)
    : place_(place),
      fingerprint_(std::move(fingerprint)),
      last_(std::chrono::steady_clock::now()) {}

// The state file: the fingerprint, the frame, the size of the log, the state.
std::optional<TrackCheckpoint::Saved> TrackCheckpoint::Load() {
  if (place_.folder.empty()) return std::nullopt;
  Saved saved;
  saved.state = BytesOf(place_.folder / "state");
  saved.log = BytesOf(place_.folder / "sightings");
  const std::size_t head = fingerprint_.size() + sizeof saved.frame + sizeof log_size_;
  if (saved.state.starts_with(fingerprint_) && saved.state.size() >= head) {
    StateReader in(std::string_view(saved.state).substr(fingerprint_.size()));
    in.Take(&saved.frame);
    in.Take(&log_size_);
    if (saved.log.size() >= log_size_) {
      saved.state.erase(0, head);
      saved.log.resize(log_size_);
      return saved;
    }
  }
  log_size_ = 0;
  Remove();
  return std::nullopt;
}

bool TrackCheckpoint::IsDue() const {
  return !place_.folder.empty() && std::chrono::steady_clock::now() - last_ >= place_.every;
}

void TrackCheckpoint::Keep(std::int64_t frame, std::string_view state, std::string_view log) {
  fs::create_directories(place_.folder);
  const fs::path path = place_.folder / "sightings";
  if (fs::exists(path)) fs::resize_file(path, log_size_);  // what a kill left behind
  std::ofstream file(path, std::ios::binary | std::ios::app);
  file.write(log.data(), static_cast<std::streamsize>(log.size()));
  file.close();
  if (!file) throw std::runtime_error(path.string() + " cannot be written");
  log_size_ += log.size();
  StateWriter head;
  head.Put(frame);
  head.Put(log_size_);
  WriteTextFile(place_.folder / "state", fingerprint_ + head.bytes() + std::string(state));
  last_ = std::chrono::steady_clock::now();
}

void TrackCheckpoint::Remove() {
  std::error_code ignored;
  if (!place_.folder.empty()) fs::remove_all(place_.folder, ignored);
}

}  // namespace flocklift::internal
