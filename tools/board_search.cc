// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/board_search.h"

#include <algorithm>
#include <mutex>
#include <opencv2/core/utility.hpp>
#include <tuple>
#include <utility>

#include "simulate/camera/board_views.h"
#include "simulate/core/check.h"
#include "simulate/core/image.h"
#include "simulate/core/parallel_for.h"
#include "simulate/media/image_codec.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

bool IsPicture(const fs::path& path) { return fs::is_regular_file(path) && IsImageFile(path); }

// Does a name fit a pattern such as img_%03d.png?
bool Matches(const std::string& name, const std::string& pattern) {
  const auto percent = pattern.find('%');
  const auto d = pattern.find('d', percent);
  if (percent == std::string::npos || d == std::string::npos) return false;
  const std::string before = pattern.substr(0, percent), after = pattern.substr(d + 1);
  if (name.size() <= before.size() + after.size()) return false;
  if (!name.starts_with(before) || !name.ends_with(after)) return false;
  const auto digits = name.begin() + static_cast<std::ptrdiff_t>(before.size());
  return std::all_of(digits, name.end() - static_cast<std::ptrdiff_t>(after.size()),
                     [](char c) { return c >= '0' && c <= '9'; });
}

// The pictures of a folder for which `wanted` holds, in the natural order of their names.
template <typename Wanted>
std::vector<fs::path> List(const fs::path& folder, const Wanted& wanted) {
  std::vector<fs::path> pictures;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (wanted(entry.path().filename().string()) && IsPicture(entry.path())) {
      pictures.push_back(entry.path());
    }
  }
  std::sort(pictures.begin(), pictures.end(), [](const fs::path& a, const fs::path& b) {
    return NaturalLess(a.filename().string(), b.filename().string());
  });
  return pictures;
}

}  // namespace

std::vector<fs::path> ExpandPictures(const std::vector<fs::path>& paths) {
  std::vector<fs::path> pictures;
  for (const fs::path& path : paths) {
    const std::string name = path.filename().string();
    std::vector<fs::path> found;
    if (fs::is_directory(path)) {
      found = List(path, [](const std::string&) { return true; });
      if (found.empty()) {
        throw InputError(path.string(), 0, "the folder holds no picture",
                         "give a folder with pictures of the board");
      }
    } else if (name.find('%') != std::string::npos && !fs::exists(path)) {
      found = List(path.has_parent_path() ? path.parent_path() : fs::path("."),
                   [&name](const std::string& other) { return Matches(other, name); });
      if (found.empty()) {
        throw InputError(path.string(), 0, "no picture matches the pattern",
                         "write it as in img_%03d.png");
      }
    } else if (!fs::exists(path)) {
      throw InputError(path.string(), 0, "no such file",
                       "give pictures, a folder, a pattern such as img_%03d.png, or a video");
    } else if (IsPicture(path)) {
      found = {path};
    } else if (paths.size() > 1) {
      throw InputError(path.string(), 0, "this is no picture",
                       "give one video, or pictures and nothing else");
    }
    pictures.insert(pictures.end(), found.begin(), found.end());
  }
  return pictures;
}

BoardSearch SearchPictures(const std::vector<fs::path>& pictures, const Board& board, int threads,
                           const Progress& progress) {
  CheckBoard(board);
  const auto count = static_cast<std::int64_t>(pictures.size());
  std::vector<BoardView> views(pictures.size());
  std::vector<std::pair<int, int>> sizes(pictures.size());
  std::int64_t done = 0;
  std::mutex mutex;
  cv::setNumThreads(1);  // the pictures keep the threads busy
  ParallelFor(threads, 0, count, 1, [&](std::int64_t first, std::int64_t) {
    const auto k = static_cast<std::size_t>(first);
    const Image image = ReadImage(pictures[k]);
    sizes[k] = {image.width, image.height};
    views[k] = FindBoard(board, image, pictures[k].string());
    const std::lock_guard lock(mutex);
    Report(progress, ++done, count);
  });

  BoardSearch search;
  search.looked_at = static_cast<int>(count);
  std::tie(search.width, search.height) = sizes.front();
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    if (sizes[k] != sizes.front()) {
      throw InputError(pictures[k].string(), 0,
                       "the picture is " + std::to_string(sizes[k].first) + "x" +
                           std::to_string(sizes[k].second) + ", the first is " +
                           std::to_string(search.width) + "x" + std::to_string(search.height),
                       "give pictures of one camera in one mode");
    }
    if (views[k].found()) {
      search.views.push_back(std::move(views[k]));
    } else {
      search.without.push_back(pictures[k].string());
    }
  }
  search.views = DropRepeats(std::move(search.views));
  return search;
}

BoardSearch SearchVideo(const fs::path& video, const Board& board, int tries, int max_views,
                        int threads, const Progress& progress) {
  constexpr std::int64_t kUnknownStretch = 10;
  CheckBoard(board);
  cv::setNumThreads(ResolveThreads(threads));
  VideoSource source(video);
  const auto frames = source.frame_count();
  const std::int64_t stretch =
      frames ? std::max<std::int64_t>(1, *frames / tries) : kUnknownStretch;
  BoardSearch search;
  search.width = source.width();
  search.height = source.height();
  Image image, sharpest;
  double sharpness = -1;
  std::int64_t frame = 0, sharpest_frame = 0;
  const auto try_sharpest = [&] {
    if (sharpness < 0) return;
    ++search.looked_at;
    auto view =
        FindBoard(board, sharpest, video.string() + ", frame " + std::to_string(sharpest_frame));
    if (view.found()) search.views.push_back(std::move(view));
    sharpness = -1;
  };
  while (source.Read(&image)) {
    ++frame;
    if (const double its = Sharpness(image); its > sharpness) {
      sharpness = its;
      sharpest_frame = frame;
      std::swap(image, sharpest);
    }
    if (frame % stretch == 0) try_sharpest();
    Report(progress, frame, frames.value_or(0));
  }
  try_sharpest();
  search.views = SelectViews(DropRepeats(std::move(search.views)), max_views);
  return search;
}

}  // namespace flocklift
