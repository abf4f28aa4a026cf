// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page as one text, with its scripts, its style and what it is to show inside: a browser that
// starts shows something after one answer, and an exported page needs no server.

#ifndef FLOCKLIFT_TOOLS_VIEW_PAGE_TEXT_H_
#define FLOCKLIFT_TOOLS_VIEW_PAGE_TEXT_H_

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "tools/view/page_files.h"

namespace flocklift {

std::string AsBase64(std::string_view bytes);

class PageText {
 public:
  explicit PageText(const PageFiles& page);

  // What of a content security policy says that these scripts and this style may run, and no other.
  const std::string& policy() const { return policy_; }

  // The page of `data`, which its script reads; `head` goes into its head.
  std::string With(const nlohmann::ordered_json& data, std::string_view head = "") const;

 private:
  std::string script_, later_, style_, policy_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_PAGE_TEXT_H_
