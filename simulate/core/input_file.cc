// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/input_file.h"

#include <cerrno>
#include <system_error>

#include "simulate/core/check.h"

namespace flocklift {

std::ifstream OpenInput(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status)) {
    throw InputError(path.string(), 0, "there is no such file", "check the name");
  }
  if (std::filesystem::is_directory(status)) {
    throw InputError(path.string(), 0, "this is a folder", "name a file inside it");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw InputError(path.string(), 0,
                     "cannot be opened: " + std::generic_category().message(errno),
                     "check its permissions");
  }
  return stream;
}

std::string ReadTextFile(const std::filesystem::path& path) {
  constexpr std::size_t kLargest = std::size_t{16} << 20;
  std::ifstream stream = OpenInput(path);
  std::string text(4096, '\0');
  std::size_t size = 0;
  while (stream.read(text.data() + size, static_cast<std::streamsize>(text.size() - size)),
         stream.gcount() > 0) {
    size += static_cast<std::size_t>(stream.gcount());
    if (size > kLargest) {
      throw InputError(path.string(), 0, "the file is larger than 16 MiB",
                       "name a settings file, not a recording");
    }
    if (size == text.size()) text.resize(2 * size);
  }
  if (stream.bad()) {
    throw InputError(path.string(), 0, "cannot be read to its end", "check the disk");
  }
  text.resize(size);
  return text;
}

}  // namespace flocklift
