// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Says of a reader that it refuses a text: at which line, and with which words.

#ifndef FLOCKLIFT_TESTS_SIMULATE_CORE_FAULT_H_
#define FLOCKLIFT_TESTS_SIMULATE_CORE_FAULT_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <string>

#include "simulate/core/check.h"

namespace flocklift {

// A text, and what its reader must say of it. Line 0: of the file as a whole.
struct Fault {
  std::string text;
  int line = 0;
  std::string words;  // that the message holds
};

// `read` gets the text; its messages call the file "FILE".
inline void ExpectFault(const Fault& fault, const std::function<void(const std::string&)>& read) {
  SCOPED_TRACE(testing::PrintToString(fault.text));
  try {
    read(fault.text);
    ADD_FAILURE() << "was read without complaint";
  } catch (const InputError& error) {
    const std::string message = error.what();
    const std::string place =
        fault.line > 0 ? "FILE:" + std::to_string(fault.line) + ": " : "FILE: ";
    EXPECT_EQ(message.substr(0, place.size()), place) << message;
    EXPECT_NE(message.find(fault.words), std::string::npos) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << "no mend: " << message;
    EXPECT_EQ(message.find_first_of("\n\r"), std::string::npos) << message;
  }
}

// The bytes of a file.
inline std::string Contents(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// A folder of this test's own, empty at first, gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "flocklift_XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SIMULATE_CORE_FAULT_H_
