// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/render/film.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/core/parallel_for.h"
#include "simulate/render/flight.h"
#include "simulate/render/renderer.h"

namespace flocklift {
namespace {

// Lets threads that make numbered pieces hand them over in order, one at a time.
class Turnstile {
 public:
  // Runs `pass` when all pieces before number k have passed. False once something has failed.
  template <typename Function>
  bool Pass(int k, const Function& pass) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return next_ == k || failure_; });
    if (failure_) return false;
    pass();
    ++next_;
    changed_.notify_all();
    return true;
  }
  void Fail(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = failure;
    changed_.notify_all();
  }
  void Rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int next_ = 0;
  std::exception_ptr failure_;
};

Image Draw(const FlockRenderer& renderer, const Flight& flight, const Scenery* scenery, int frame) {
  const double time = flight.TimeOf(frame);
  const std::vector<FlyingAnimal> animals = flight.At(frame);
  if (scenery == nullptr) return renderer.Render(frame, time, animals);
  Image image;
  scenery->With(frame, time, [&](const Setting& setting) {
    image = renderer.Render(frame, time, animals, setting);
  });
  return image;
}

}  // namespace

void FilmTrajectories(const std::filesystem::path& path, const Trajectories& trajectories,
                      std::span<const Animal> animals, const Camera& camera, const RenderSpec& spec,
                      const FilmOptions& options, const Progress& progress) {
  const Flight flight(trajectories, animals, camera, options.fps);
  const FlockRenderer renderer(camera, spec, options.fps, options.seed);
  const int frames = options.frames > 0 ? options.frames : flight.span().last;
  Check(frames > 0, "there is no frame to film");
  VideoWriter writer(path, camera.width, camera.height, options.fps, options.video);

  const int threads = std::min(ResolveThreads(options.threads), frames);
  Turnstile turnstile;
  const auto draw = [&](int first) {
    try {
      for (int k = first; k < frames; k += threads) {
        const int frame = k + 1;
        Image image = Draw(renderer, flight, options.scenery, frame);
        const bool passed = turnstile.Pass(k, [&] {
          writer.Write(std::move(image));
          Report(progress, k + 1, frames);
        });
        if (!passed) return;
      }
    } catch (...) {
      turnstile.Fail(std::current_exception());
    }
  };
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(draw, t);
  draw(0);
  for (std::thread& other : others) other.join();
  turnstile.Rethrow();
  writer.Finish();
}

Image DrawFrame(const Trajectories& trajectories, std::span<const Animal> animals,
                const Camera& camera, const RenderSpec& spec, const FilmOptions& options,
                int frame) {
  const Flight flight(trajectories, animals, camera, options.fps);
  return Draw(FlockRenderer(camera, spec, options.fps, options.seed), flight, options.scenery,
              frame);
}

}  // namespace flocklift
