// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page with all that it shows inside it: it opens from the disk, needs no server, and its
// content security policy lets it load nothing and run nothing but itself. To look at only.

#ifndef FLOCKLIFT_TOOLS_VIEW_EXPORT_PAGE_H_
#define FLOCKLIFT_TOOLS_VIEW_EXPORT_PAGE_H_

#include <cstddef>
#include <string>

#include "tools/view/page_files.h"
#include "tools/view/run_data.h"

namespace flocklift {

struct ExportOptions {
  int picture_width = 800;                    // at most [px]
  std::size_t most_picture_bytes = 40 << 20;  // smaller pictures, then fewer of them, beyond
};

// Pictures are of every n-th frame where those of all would be too much.
std::string MakeExportPage(const PageFiles& page, const RunData& data,
                           const ExportOptions& options);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_EXPORT_PAGE_H_
