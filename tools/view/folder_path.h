// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Names that a page sends, as files of one folder and of no other place.

#ifndef FLOCKLIFT_TOOLS_VIEW_FOLDER_PATH_H_
#define FLOCKLIFT_TOOLS_VIEW_FOLDER_PATH_H_

#include <filesystem>
#include <optional>
#include <string>

namespace flocklift {

// folder/name with all links followed, if that is inside `folder` (which must exist); the file
// itself need not. Nothing for an absolute name, one with "..", and a link that leads outside.
std::optional<std::filesystem::path> PathInFolder(const std::filesystem::path& folder,
                                                  const std::string& name);

// A name for a new file right in a folder: letters, digits, '-', '_' and '.', not first a dot, at
// most 100 of them, with the extension.
bool IsPlainFileName(const std::string& name, const std::string& extension);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_FOLDER_PATH_H_
