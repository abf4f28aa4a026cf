// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wall time of parts of the work.

#ifndef FLOCKLIFT_TRACK_STOPWATCH_H_
#define FLOCKLIFT_TRACK_STOPWATCH_H_

#include <chrono>

namespace flocklift::internal {

class Stopwatch {
 public:
  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Adds the time of one call to `sum`.
template <typename Call>
auto Timed(double* sum, const Call& call) {
  struct Adder {
    Stopwatch watch = {};
    double* sum;
    ~Adder() { *sum += watch.Seconds(); }
  } adder{.sum = sum};
  return call();
}

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_TRACK_STOPWATCH_H_
