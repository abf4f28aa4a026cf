// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Progress on standard error: a bar with rate and time left on a terminal, a plain line every few
// seconds otherwise.

#ifndef FLOCKLIFT_TOOLS_PROGRESS_BAR_H_
#define FLOCKLIFT_TOOLS_PROGRESS_BAR_H_

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace flocklift {

class ProgressBar {
 public:
  ProgressBar(std::string title, std::string unit);
  ~ProgressBar();  // finishes the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void Update(std::int64_t done, std::int64_t total);

 private:
  std::string title_, unit_;
  bool terminal_;
  bool drawn_ = false;
  std::optional<std::int64_t> first_done_;  // at the first call
  std::chrono::steady_clock::time_point start_, last_;
};

// "4.2 s", "3 min 05 s", "2 h 10 min".
std::string DurationText(double seconds);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_PROGRESS_BAR_H_
