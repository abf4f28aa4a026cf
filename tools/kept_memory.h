// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A server makes answers of some hundred kilobytes many times a second. The C library gives such
// blocks back to the system when they are freed, and each page of the next one then costs a fault:
// of an update of a running scene of 10 000 animals, five times what sending it takes. So does a
// fit with arrays of some ten megabytes.

#ifndef FLOCKLIFT_TOOLS_KEPT_MEMORY_H_
#define FLOCKLIFT_TOOLS_KEPT_MEMORY_H_

namespace flocklift {

// From now on the process keeps what it frees, up to `most` bytes for each thread's part of the
// heap; blocks from `largest` on, of 32 MiB at most, are given back as before. Call it before there
// are threads.
void KeepFreedMemory(int largest = 4 << 20, int most = 64 << 20);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_KEPT_MEMORY_H_
