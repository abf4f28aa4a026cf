// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace flocklift {

std::string DurationText(double seconds) {
  if (seconds < 99.5) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::int64_t>(seconds + 0.5);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

ProgressBar::ProgressBar(std::string title, std::string unit)
    : title_(std::move(title)),
      unit_(std::move(unit)),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

ProgressBar::~ProgressBar() {
  if (terminal_ && drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::Update(std::int64_t done, std::int64_t total) {
  using Seconds = std::chrono::duration<double>;
  const auto now = std::chrono::steady_clock::now();
  if (!first_done_) {  // of work that goes on, what was done before took no time now
    first_done_ = done;
    start_ = now;
  }
  if (Seconds(now - last_).count() < (terminal_ ? 0.1 : 5.0)) return;
  last_ = now;
  const double elapsed = Seconds(now - start_).count();
  const double rate = static_cast<double>(done - *first_done_) / std::max(elapsed, 1e-9);
  std::string text = fmt::format("{}: {}", title_, done);
  if (total > 0) text += fmt::format("/{}", total);
  text += fmt::format(" {}, {:.3g}/s", unit_, rate);
  if (total > 0 && rate > 0) {
    text += ", " + DurationText(static_cast<double>(total - done) / rate) + " left";
  }
  if (!terminal_) {
    fmt::print(stderr, "{}\n", text);
    return;
  }
  constexpr int kWidth = 24;
  const int filled =
      total > 0 ? static_cast<int>(std::clamp<std::int64_t>(kWidth * done / total, 0, kWidth)) : 0;
  fmt::print(stderr, "\r\x1b[K[{:#<{}}{:.<{}}] {}", "", filled, "", kWidth - filled, text);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace flocklift
