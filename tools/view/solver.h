// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reconstructions in the background, one at a time: a new one cancels the one before it, at the
// next time that this reports its progress.

#ifndef FLOCKLIFT_TOOLS_VIEW_SOLVER_H_
#define FLOCKLIFT_TOOLS_VIEW_SOLVER_H_

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "reconstruct/reconstruct.h"
#include "simulate/core/progress.h"

namespace flocklift {

class Solver {
 public:
  // The work; may throw, and lets what the progress throws pass.
  using Job = std::function<ReconstructResult(const Progress&)>;

  // What becomes of a job: that it was accepted is told before Start returns, which may be while
  // the one before it still stops; the rest from the solver's thread. A job that was cancelled
  // tells nothing more. None may call the solver.
  struct Listener {
    std::function<void(std::int64_t job)> accepted;
    std::function<void(std::int64_t job, std::int64_t done, std::int64_t total)> progress;
    std::function<void(std::int64_t job, ReconstructResult&& result, double seconds)> finished;
    std::function<void(std::int64_t job, const std::string& reason)> failed;
  };

  explicit Solver(Listener listener);
  ~Solver();  // cancels
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  std::int64_t Start(Job job);  // its number, from 1
  void Cancel();

 private:
  void Work();

  Listener listener_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Job> next_;
  std::atomic<std::int64_t> wanted_ = 0;  // the job that is still of interest; 0: none
  std::int64_t last_ = 0;
  bool stops_ = false;
  std::thread thread_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_SOLVER_H_
