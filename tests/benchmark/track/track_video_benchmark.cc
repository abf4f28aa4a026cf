// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// From the file to the tracks, 1080p, against the number of animals; beside it what the same file
// costs to decode alone, and to decode and hand to OpenCV's MOG2, which finds foreground and no
// more. CPU time of all threads, a frame. The film is made first: soft dark animals on a noisy
// sky, each on a way of its own.

#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/video/background_segm.hpp>
#include <string>

#include "simulate/media/video_writer.h"
#include "tests/track/pictures.h"
#include "track/tracker.h"
#include "track/video_source.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 1920, kHeight = 1080, kFrames = 120;

Image Colored(const GrayImage& gray) {
  Image image(gray.width, gray.height);
  for (std::size_t k = 0; k < gray.pixels.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) image.bgr[3 * k + c] = gray.pixels[k];
  }
  return image;
}

// Of so many animals, made once.
const fs::path& Film(int animals) {
  static std::map<int, fs::path> made;
  fs::path& path = made[animals];
  if (!path.empty()) return path;
  path = fs::temp_directory_path() / ("flocklift_benchmark_" + std::to_string(animals) + ".mp4");
  const double width = kWidth, height = kHeight;
  // Smaller where they are many, as when a flock is farther away.
  const double size = animals <= 1000 ? 1 : 0.7;
  const GrayImage sky = DrawPicture(kWidth, kHeight, {.level = 190, .noise = 1.5}, {});
  VideoWriter writer(path, kWidth, kHeight, 30);
  for (int frame = 0; frame < kFrames; ++frame) {
    GrayImage picture = sky;
    for (int k = 0; k < animals; ++k) {
      Rng rng(4, static_cast<std::uint64_t>(k));
      const double x = rng.Uniform(0, width), y = rng.Uniform(0, height);
      const double u = rng.Uniform(-4, 4), v = rng.Uniform(-3, 3);
      const SoftBlob blob{.center = {std::fmod(x + u * frame + 10 * width, width),
                                     std::fmod(y + v * frame + 10 * height, height)},
                          .contrast = -110,
                          .major_sd = 2.4 * size,
                          .minor_sd = 1.3 * size,
                          .angle_deg = rng.Uniform(0, 180)};
      for (int j = -7; j <= 7; ++j) {
        for (int i = -7; i <= 7; ++i) {
          const int px = static_cast<int>(blob.center.x) + i;
          const int py = static_cast<int>(blob.center.y) + j;
          if (px < 0 || py < 0 || px >= kWidth || py >= kHeight) continue;
          const double value = picture.Row(py)[px] + BlobValue(blob, px, py);
          picture.Row(py)[px] = static_cast<std::uint8_t>(std::max(value, 40.0));
        }
      }
    }
    writer.Write(Colored(picture));
  }
  writer.Finish();
  return path;
}

void SetCounters(benchmark::State& state) {
  const auto frames = static_cast<double>(state.iterations() * kFrames);
  state.counters["frames/s"] = benchmark::Counter(frames, benchmark::Counter::kIsRate);
  state.counters["s/frame"] =
      benchmark::Counter(frames, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void BM_Decode(benchmark::State& state) {
  const fs::path& film = Film(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    VideoSource video(film);
    for (GrayImage image; video.Read(&image);) benchmark::DoNotOptimize(image.pixels.data());
  }
  SetCounters(state);
}

void BM_DecodeAndMog2(benchmark::State& state) {
  const fs::path& film = Film(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    VideoSource video(film);
    const auto subtractor = cv::createBackgroundSubtractorMOG2();
    cv::Mat mask;
    for (Image image; video.Read(&image);) {
      subtractor->apply(cv::Mat(image.height, image.width, CV_8UC3, image.bgr.data()), mask);
    }
  }
  SetCounters(state);
}

void BM_Track(benchmark::State& state) {
  const fs::path& film = Film(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(TrackVideo({.decline = false}, film));
  SetCounters(state);
}

BENCHMARK(BM_Decode)->Arg(1000)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(BM_DecodeAndMog2)->Arg(1000)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Track)
    ->Arg(20)
    ->Arg(100)
    ->Arg(500)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(5000)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flocklift
