// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The three kinds of failure. A bug of ours: FLOCKLIFT_DCHECK (debug builds only). A caller's
// broken precondition or an option out of range: Check, std::invalid_argument. A foreign file that
// is missing or malformed: InputError. What the data merely do not permit is a value, not an error.

#ifndef FLOCKLIFT_SIMULATE_CORE_CHECK_H_
#define FLOCKLIFT_SIMULATE_CORE_CHECK_H_

#include <cassert>
#include <stdexcept>
#include <string>

#define FLOCKLIFT_DCHECK(condition) assert(condition)

namespace flocklift {

inline void Check(bool condition, const std::string& message) {
  if (!condition) throw std::invalid_argument(message);
}

// A fault of a foreign file, told in one line: "FILE:LINE: FAULT; MEND". `line` counts from 1; 0
// means the file as a whole. Ends the program with exit status 2.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& file, long line, const std::string& fault, const std::string& mend)
      : std::runtime_error(file + (line > 0 ? ':' + std::to_string(line) : "") + ": " + fault +
                           "; " + mend) {}
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_CHECK_H_
