// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/scene_checkpoint.h"

#include <fmt/format.h>

#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "simulate/core/build_id.h"
#include "simulate/core/scene_io.h"
#include "simulate/core/state_archive.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr int kLayout = 2;  // of the saved state: another whenever something else is saved

struct Motion6 {
  Vec3d position, velocity;
};

std::string BytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Whether a file holds at least so much.
bool Holds(const fs::path& path, std::uintmax_t bytes) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  return bytes == 0 || (!error && size >= bytes);
}

// The parts of `state`.
struct SavedState {
  std::int64_t frame = 0;
  std::uint64_t frames = 0;
  std::string_view engine;
};

// Nothing when the bytes are not of `fingerprint`.
bool Parse(std::string_view bytes, const std::string& fingerprint, SavedState* state) {
  if (!bytes.starts_with(fingerprint)) return false;
  bytes.remove_prefix(fingerprint.size());
  if (bytes.size() < sizeof state->frame + sizeof state->frames) return false;
  StateReader in(bytes);
  in.Take(&state->frame);
  in.Take(&state->frames);
  state->engine = bytes.substr(sizeof state->frame + sizeof state->frames);
  return true;
}

}  // namespace

SceneCheckpoint::SceneCheckpoint(fs::path folder, std::chrono::seconds every, const Scene& scene)
    : folder_(std::move(folder)), every_(every), last_(std::chrono::steady_clock::now()) {
  if (!folder_.empty()) {
    fingerprint_ = fmt::format("{} state {}\n", ProgramIdentity(), kLayout) + FormatScene(scene);
  }
}

void SceneCheckpoint::Resume(Engine* engine, std::int64_t* frame, Trajectories* truth,
                             AnimatedMeshWriter* tetrahedra, std::size_t corners) {
  if (folder_.empty()) return;
  const std::string bytes = BytesOf(folder_ / "state");
  SavedState state;
  const std::size_t animals = truth->trajectories.size();
  const std::uintmax_t frame_size = animals * sizeof(Motion6);
  const std::uintmax_t corners_size = tetrahedra != nullptr ? corners * sizeof(Vec3<float>) : 0;
  if (!Parse(bytes, fingerprint_, &state) ||
      !Holds(folder_ / "frames", state.frames * frame_size) ||
      !Holds(folder_ / "corners", state.frames * corners_size)) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    return;
  }
  engine->Load(state.engine);
  std::ifstream file(folder_ / "frames", std::ios::binary);
  std::vector<Motion6> row(animals);
  for (std::uint64_t f = 1; f <= state.frames; ++f) {
    file.read(reinterpret_cast<char*>(row.data()), static_cast<std::streamsize>(frame_size));
    for (std::size_t k = 0; k < animals; ++k) {
      TrajectoryPoint point;
      point.frame = static_cast<int>(f);
      point.position = row[k].position;
      point.velocity = row[k].velocity;
      truth->trajectories[k].points.push_back(point);
    }
  }
  if (!file) throw std::runtime_error((folder_ / "frames").string() + " cannot be read");
  if (state.frames > 0) fs::resize_file(folder_ / "frames", state.frames * frame_size);
  kept_frames_ = state.frames;
  *frame = state.frame + 1;
  if (tetrahedra != nullptr && state.frames > 0) {
    std::ifstream shapes(folder_ / "corners", std::ios::binary);
    std::vector<Vec3<float>> shape(corners);
    for (std::uint64_t f = 0; f < state.frames; ++f) {
      shapes.read(reinterpret_cast<char*>(shape.data()),
                  static_cast<std::streamsize>(corners_size));
      if (!shapes) throw std::runtime_error((folder_ / "corners").string() + " cannot be read");
      tetrahedra->AddFrame(shape);
    }
    fs::resize_file(folder_ / "corners", state.frames * corners_size);
  }
}

void SceneCheckpoint::AddCorners(std::span<const Vec3<float>> corners) {
  if (folder_.empty()) return;
  if (!corners_.is_open()) {
    fs::create_directories(folder_);
    // Whatever was there before this run's first frame and is not of it is gone.
    corners_.open(folder_ / "corners",
                  std::ios::binary | (kept_frames_ > 0 ? std::ios::app : std::ios::trunc));
  }
  corners_.write(reinterpret_cast<const char*>(corners.data()),
                 static_cast<std::streamsize>(corners.size_bytes()));
}

bool SceneCheckpoint::Due() const {
  return !folder_.empty() && std::chrono::steady_clock::now() - last_ >= every_;
}

void SceneCheckpoint::Keep(const Engine& engine, std::int64_t frame, const Trajectories& truth) {
  if (folder_.empty()) return;
  fs::create_directories(folder_);
  const std::size_t frames =
      truth.trajectories.empty() ? 0 : truth.trajectories.front().points.size();
  std::ofstream file(folder_ / "frames", std::ios::binary | std::ios::app);
  std::vector<Motion6> row(truth.trajectories.size());
  for (; kept_frames_ < frames; ++kept_frames_) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      const TrajectoryPoint& point = truth.trajectories[k].points[kept_frames_];
      row[k] = {point.position, point.velocity};
    }
    file.write(reinterpret_cast<const char*>(row.data()),
               static_cast<std::streamsize>(row.size() * sizeof(Motion6)));
  }
  file.close();
  if (!file) throw std::runtime_error((folder_ / "frames").string() + " cannot be written");
  if (corners_.is_open() && !corners_.flush()) {
    throw std::runtime_error((folder_ / "corners").string() + " cannot be written");
  }
  StateWriter header;
  header.Put(frame);
  header.Put(static_cast<std::uint64_t>(frames));
  WriteTextFile(folder_ / "state", fingerprint_ + header.bytes() + engine.Save());
  last_ = std::chrono::steady_clock::now();
}

void SceneCheckpoint::Remove() {
  if (folder_.empty()) return;
  corners_.close();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

}  // namespace flocklift
