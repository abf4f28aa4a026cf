// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How long work reports on itself. Libraries never print: they call this.

#ifndef FLOCKLIFT_SIMULATE_CORE_PROGRESS_H_
#define FLOCKLIFT_SIMULATE_CORE_PROGRESS_H_

#include <cstdint>
#include <functional>

namespace flocklift {

// Called now and then, from one thread at a time, with the units done and the total (0: unknown).
// May be empty.
using Progress = std::function<void(std::int64_t done, std::int64_t total)>;

inline void Report(const Progress& progress, std::int64_t done, std::int64_t total) {
  if (progress) progress(done, total);
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_PROGRESS_H_
