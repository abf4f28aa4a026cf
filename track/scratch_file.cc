// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "track/scratch_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace flocklift::internal {

ScratchFile::~ScratchFile() {
  if (file_ >= 0) close(file_);
}

void ScratchFile::Fail(const char* what) const {
  throw std::runtime_error(path_.string() + " cannot be " + what + ": " + std::strerror(errno));
}

void ScratchFile::Open() {
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path());
  if (name_ == Name::kKept) {
    file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) Fail("opened");
    return;
  }
  std::string unique = path_.string() + ".XXXXXX";
  file_ = mkostemp(unique.data(), O_CLOEXEC);
  if (file_ < 0) Fail("made");
  unlink(unique.c_str());
}

void ScratchFile::GoOn(std::uint64_t size) {
  if (file_ < 0) Open();
  if (ftruncate(file_, static_cast<off_t>(size)) != 0) Fail("cut");
  size_ = size;
}

std::uint64_t ScratchFile::Append(std::span<const std::byte> bytes) {
  if (file_ < 0) GoOn(0);
  const std::uint64_t begin = size_;
  while (!bytes.empty()) {
    const ssize_t written = pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(size_));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) Fail("written");
    size_ += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return begin;
}

void ScratchFile::Read(std::uint64_t at, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t read = pread(file_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (read < 0 && errno == EINTR) continue;
    if (read == 0) errno = ENODATA;
    if (read <= 0) Fail("read");
    at += static_cast<std::uint64_t>(read);
    bytes = bytes.subspan(static_cast<std::size_t>(read));
  }
}

}  // namespace flocklift::internal
