// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Memory for many arrays that live as long as each other, in blocks that the system is asked to
// back with large pages. The first touch of a page costs up to some microseconds; an array of
// megabytes in pages of 4 KiB may take longer to touch than to fill.

#ifndef FLOCKLIFT_SIMULATE_CORE_LARGE_PAGES_H_
#define FLOCKLIFT_SIMULATE_CORE_LARGE_PAGES_H_

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <vector>

namespace flocklift {

// Hands out pieces of blocks one after the other, to any thread, and frees them when it goes: an
// array that grows leaves its old piece unused until then. Throws std::bad_alloc without memory.
class LargePages final : public std::pmr::memory_resource {
 public:
  LargePages() = default;
  LargePages(const LargePages&) = delete;
  LargePages& operator=(const LargePages&) = delete;

  // Of all blocks [bytes].
  std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(std::byte* block) const { std::free(block); }
  };

  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* /*piece*/, std::size_t /*bytes*/, std::size_t /*alignment*/) override {}
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }
  void AddBlock(std::size_t bytes);

  std::mutex mutex_;
  std::vector<std::unique_ptr<std::byte, Free>> blocks_;
  std::size_t size_ = 0;
  void* next_ = nullptr;  // of the last block
  std::size_t left_ = 0;  // [bytes]
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_LARGE_PAGES_H_
