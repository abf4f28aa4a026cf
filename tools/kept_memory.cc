// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/kept_memory.h"

#include <malloc.h>

namespace flocklift {

void KeepFreedMemory(int largest, int most) {
  mallopt(M_MMAP_THRESHOLD, largest);  // NOLINT(concurrency-mt-unsafe): before any thread
  mallopt(M_TRIM_THRESHOLD, most);     // NOLINT(concurrency-mt-unsafe)
}

}  // namespace flocklift
