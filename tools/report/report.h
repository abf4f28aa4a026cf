// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The report of a run: one self-contained HTML page.

#ifndef FLOCKLIFT_TOOLS_REPORT_REPORT_H_
#define FLOCKLIFT_TOOLS_REPORT_REPORT_H_

#include <string>

#include "tools/report/run_folder.h"

namespace flocklift {

// The page's text. Depends on the files and nothing else; at most a few megabytes, however long the
// sequence is.
std::string MakeReport(RunFolder run);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPORT_REPORT_H_
