// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <stdexcept>
#include <utility>

#include "simulate/core/text_writer.h"

namespace flocklift {
namespace {

std::filesystem::path TemporaryNameFor(const std::filesystem::path& path) {
  static std::atomic<unsigned> count{0};
  const std::string name = fmt::format(".{}.{}-{}{}", path.stem().string(), getpid(), count++,
                                       path.extension().string());
  return path.parent_path() / name;
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(TemporaryNameFor(path_)) {
  std::error_code error;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), error);
  if (error) {
    throw std::runtime_error(fmt::format("cannot make the folder {}: {}",
                                         path_.parent_path().string(), error.message()));
  }
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::Commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) {
    throw std::runtime_error(fmt::format("cannot write {}: {}", path_.string(), error.message()));
  }
  temporary_.clear();
}

void WriteTextFile(const std::filesystem::path& path, std::string_view text) {
  internal::TextWriter writer(path);
  writer.buffer().append(text);
  writer.Commit();
}

}  // namespace flocklift
