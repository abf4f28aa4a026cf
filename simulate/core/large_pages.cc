// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/large_pages.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>
#include <utility>

namespace flocklift {
namespace {

constexpr std::size_t kPage = std::size_t{1} << 21U;        // of x86-64
constexpr std::size_t kMostAhead = std::size_t{32} << 20U;  // what a block may hold beyond its need

}  // namespace

void* LargePages::do_allocate(std::size_t bytes, std::size_t alignment) {
  const std::lock_guard lock(mutex_);
  void* piece = std::align(alignment, bytes, next_, left_);
  if (piece == nullptr) {
    AddBlock(bytes + alignment);
    piece = std::align(alignment, bytes, next_, left_);
  }
  next_ = static_cast<std::byte*>(next_) + bytes;
  left_ -= bytes;
  return piece;
}

// Blocks double what there is, so that they stay few.
void LargePages::AddBlock(std::size_t bytes) {
  const std::size_t wanted = std::max(bytes, std::min(size_, kMostAhead));
  const std::size_t size = (wanted + kPage - 1) / kPage * kPage;
  std::unique_ptr<std::byte, Free> block(static_cast<std::byte*>(std::aligned_alloc(kPage, size)));
  if (block == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  madvise(block.get(), size, MADV_HUGEPAGE);  // advice: small pages will do
#endif
  blocks_.push_back(std::move(block));
  size_ += size;
  next_ = blocks_.back().get();
  left_ = size;
}

}  // namespace flocklift
