// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every fuzzer asks of a reader: it takes the input, or refuses it with an InputError that is
// one line and starts with the file's name. Anything else ends the run.

#ifndef FLOCKLIFT_TESTS_FUZZ_FUZZ_H_
#define FLOCKLIFT_TESTS_FUZZ_FUZZ_H_

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "simulate/core/check.h"

namespace flocklift {

inline void Require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "violated: %s\n", what);
  std::abort();
}
#define FLOCKLIFT_REQUIRE(condition) ::flocklift::Require((condition), #condition)

// True when `read` took the input. `name` is what it calls the file.
template <typename Read>
bool ReadsOrRefuses(const std::string& name, const Read& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    const std::string message = error.what();
    FLOCKLIFT_REQUIRE(message.rfind(name + ":", 0) == 0);
    FLOCKLIFT_REQUIRE(message.find("; ") != std::string::npos);
    for (const char c : message) FLOCKLIFT_REQUIRE(static_cast<unsigned char>(c) >= ' ');
    return false;
  }
}

// A file of this process, in memory where the system has such a place; gone at the end.
inline std::filesystem::path ScratchFile(const std::string& name) {
  struct Folder {
    Folder() {
      const bool has_memory = std::filesystem::is_directory("/dev/shm");
      std::string pattern = (has_memory ? std::filesystem::path("/dev/shm")
                                        : std::filesystem::temp_directory_path()) /
                            std::filesystem::path("flocklift_fuzz_XXXXXX");
      path = mkdtemp(pattern.data());
    }
    ~Folder() { std::filesystem::remove_all(path); }
    std::filesystem::path path;
  };
  static const Folder folder;
  return folder.path / name;
}

inline std::string Contents(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_FUZZ_FUZZ_H_
