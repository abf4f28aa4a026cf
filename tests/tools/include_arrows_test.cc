// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Who may include whom: the arrows between the rooms, and where the heavy libraries may appear.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// What each room may include besides itself. A room is a folder; the longest that fits counts.
const std::map<std::string, std::set<std::string>> kArrows = {
    {"simulate/core", {}},
    {"simulate/camera", {"simulate/core"}},
    {"simulate/forces", {"simulate/core"}},
    {"simulate/fields", {"simulate/core"}},
    {"simulate/shapes", {"simulate/core"}},
    {"simulate/flock", {"simulate/core", "simulate/forces", "simulate/fields", "simulate/shapes"}},
    {"simulate/media", {"simulate/core"}},
    {"simulate/render", {"simulate/core", "simulate/camera", "simulate/media"}},
    {"simulate",  // what stands beside the rooms puts them together
     {"simulate/core", "simulate/camera", "simulate/forces", "simulate/fields", "simulate/shapes",
      "simulate/flock", "simulate/media", "simulate/render"}},
    {"track", {"simulate/core", "simulate/camera", "simulate/media"}},
    {"reconstruct",
     {"simulate/core", "simulate/camera", "simulate/forces", "simulate/fields", "simulate/flock"}},
    {"tools",
     {"simulate", "simulate/core", "simulate/camera", "simulate/forces", "simulate/fields",
      "simulate/shapes", "simulate/flock", "simulate/media", "simulate/render", "track",
      "reconstruct"}},
};

// The rooms (or folders of them) in whose files a library's headers may stand.
struct Library {
  std::string name;
  std::regex header;
  std::vector<std::string> folders;
};
const std::vector<Library> kLibraries = {
    {"OpenCV", std::regex("opencv2?/.*"), {"simulate/camera", "simulate/media", "track", "tools"}},
    {"Ceres", std::regex("ceres/.*"), {"reconstruct"}},
    {"NLopt", std::regex("nlopt.*"), {"reconstruct"}},
    {"Eigen", std::regex("Eigen/.*"), {"reconstruct"}},
    {"SIMD", std::regex("(xsimd/.*|.*intrin\\.h)"), {"simulate/flock"}},
    {"HDF5", std::regex("(hdf5|H5.*)\\.h"), {"simulate/core"}},
    {"assimp", std::regex("assimp/.*"), {"simulate/shapes"}},
    {"FLANN", std::regex("flann/.*"), {"simulate/shapes", "simulate/flock", "track"}},
    {"TetGen", std::regex("tetgen\\.h"), {"simulate/shapes"}},
    {"CLI11", std::regex("CLI/.*"), {"tools"}},
    {"FFmpeg", std::regex("lib(av|sw).*/.*"), {"simulate/media", "track"}},
    {"cpp-httplib", std::regex("httplib\\.h"), {"tools/view"}},
};

std::string RoomOf(const std::string& path) {
  std::string best;
  for (const auto& [room, others] : kArrows) {
    if (path.starts_with(room + "/") && room.size() > best.size()) best = room;
  }
  return best;
}

// Why `path` may not include `header` (written with quotes or angles); nothing when it may.
std::optional<std::string> Fault(const std::string& path, const std::string& header, bool quoted) {
  const std::string room = RoomOf(path);
  if (quoted) {
    const std::string other = RoomOf(header);
    if (other.empty()) {
      return header == "tools/version.h" ? std::nullopt
                                         : std::optional("does not start at the root");
    }
    if (other == room || kArrows.at(room).contains(other)) return std::nullopt;
    return room + " must not know " + other;
  }
  for (const Library& library : kLibraries) {
    if (!std::regex_match(header, library.header)) continue;
    const bool allowed =
        std::any_of(library.folders.begin(), library.folders.end(),
                    [&path](const std::string& folder) { return path.starts_with(folder + "/"); });
    if (!allowed) return library.name + " does not belong into " + room;
    // Readers of a header of simulate or track must not need OpenCV to understand it.
    if (library.name == "OpenCV" && path.ends_with(".h") && !path.starts_with("tools/")) {
      return "OpenCV does not belong into a public header";
    }
  }
  return std::nullopt;
}

std::vector<std::string> SourceFiles(const fs::path& root) {
  std::vector<std::string> files;
  for (const char* top : {"simulate", "track", "reconstruct", "tools"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension == ".h" || extension == ".cc") {
        files.push_back(fs::relative(entry.path(), root).generic_string());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(IncludeArrows, TheRulesSeeAFault) {
  EXPECT_TRUE(Fault("track/tracker.cc", "simulate/flock/engine.h", true));
  EXPECT_TRUE(Fault("track/tracker.cc", "reconstruct/reconstruct.h", true));
  EXPECT_TRUE(Fault("reconstruct/solve/batch.cc", "track/tracker.h", true));
  EXPECT_TRUE(Fault("reconstruct/solve/batch.cc", "simulate/media/video_writer.h", true));
  EXPECT_TRUE(Fault("simulate/core/vec3.h", "simulate/camera/camera.h", true));
  EXPECT_TRUE(Fault("simulate/flock/engine.cc", "simulate/render/renderer.h", true));
  EXPECT_TRUE(Fault("simulate/core/io.cc", "io.h", true));
  EXPECT_TRUE(Fault("simulate/forces/separation.h", "ceres/jet.h", false));
  EXPECT_TRUE(Fault("simulate/flock/kernels/boids.cc", "Eigen/Core", false));
  EXPECT_TRUE(Fault("simulate/camera/camera.h", "opencv2/core.hpp", false));
  EXPECT_FALSE(Fault("simulate/camera/board.cc", "opencv2/core.hpp", false));
  EXPECT_FALSE(Fault("track/tracker.cc", "simulate/core/vec3.h", true));
  EXPECT_FALSE(Fault("reconstruct/fit/fit.cc", "simulate/flock/engine.h", true));
  EXPECT_FALSE(Fault("tools/main.cc", "track/tracker.h", true));
}

TEST(IncludeArrows, NoFileKnowsWhatItMustNot) {
  const fs::path root = FLOCKLIFT_SOURCE_DIR;
  const std::regex include("^\\s*#\\s*include\\s*([<\"])([^>\"]+)[>\"].*");
  const std::vector<std::string> files = SourceFiles(root);
  ASSERT_GT(files.size(), 50u);
  int includes = 0;
  for (const std::string& file : files) {
    std::ifstream stream(root / file);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      std::smatch match;
      if (!std::regex_match(line, match, include)) continue;
      ++includes;
      const auto fault = Fault(file, match[2], match[1] == "\"");
      EXPECT_FALSE(fault) << file << ":" << number << ": " << line << ": " << fault.value_or("");
    }
  }
  EXPECT_GT(includes, 200);
}

}  // namespace
