// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which build of the program this is, for what is kept on disk to go on with: another build may
// compute something else from the same inputs.

#ifndef FLOCKLIFT_SIMULATE_CORE_BUILD_ID_H_
#define FLOCKLIFT_SIMULATE_CORE_BUILD_ID_H_

#include <string>

namespace flocklift {

// The linker's build id of the running program (GNU note, a hash of what was linked), in
// hexadecimal; empty where it was linked without one.
const std::string& BuildId();

// Version and build of the running program, one line.
const std::string& ProgramIdentity();

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_BUILD_ID_H_
