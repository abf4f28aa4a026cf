// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page, bundled from tools/view/page and embedded when the program was built.

#ifndef FLOCKLIFT_TOOLS_VIEW_PAGE_FILES_H_
#define FLOCKLIFT_TOOLS_VIEW_PAGE_FILES_H_

#include <string_view>

namespace flocklift {

struct PageFiles {
  std::string_view script, later, style;
  std::string_view missing;  // why there is no page; empty: there is one
};

PageFiles EmbeddedPage();

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_PAGE_FILES_H_
