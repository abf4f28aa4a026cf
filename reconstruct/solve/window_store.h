// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The windows that a run has solved so far, in a file: a killed run goes on from them. Windows are
// appended one by one; one that was cut short by the kill is dropped. A file that is not of the
// same problem, options and program is started anew.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_WINDOW_STORE_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_WINDOW_STORE_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "reconstruct/solve/window_solver.h"

namespace flocklift::internal {

class WindowStore {
 public:
  // Reads where the windows are of a run with this fingerprint (fingerprint.h). An empty path keeps
  // nothing. Throws std::runtime_error when the file can be neither read nor made.
  WindowStore(std::filesystem::path path, std::uint64_t fingerprint);

  std::optional<SolvedWindow> Find(std::size_t window);
  // Throws std::runtime_error when the disk is full.
  void Keep(std::size_t window, const SolvedWindow& solved);

  // The run is over.
  void Remove();

 private:
  struct Place {
    std::uint64_t window, begin, size;  // in the file
  };

  std::filesystem::path path_;
  std::vector<Place> places_;
  std::uint64_t end_ = 0;  // of what is whole
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_WINDOW_STORE_H_
