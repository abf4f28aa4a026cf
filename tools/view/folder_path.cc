// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/folder_path.h"

#include <algorithm>
#include <cctype>

namespace flocklift {

namespace fs = std::filesystem;

std::optional<fs::path> PathInFolder(const fs::path& folder, const std::string& name) {
  if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
  const fs::path relative(name);
  if (relative.is_absolute()) return std::nullopt;
  if (std::find(relative.begin(), relative.end(), "..") != relative.end()) return std::nullopt;
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) return std::nullopt;
  const fs::path path = fs::weakly_canonical(root / relative, error);
  if (error) return std::nullopt;
  const auto [root_end, below] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  if (root_end != root.end() || below == path.end()) return std::nullopt;
  // A link to what is not there yet is not followed above.
  if (fs::is_symlink(fs::symlink_status(path, error))) return std::nullopt;
  return path;
}

bool IsPlainFileName(const std::string& name, const std::string& extension) {
  constexpr std::size_t kLongest = 100;
  return name.size() > extension.size() && name.size() <= kLongest && name.ends_with(extension) &&
         name.front() != '.' && std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return c < 128 && (std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.');
         });
}

}  // namespace flocklift
