// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The state of a running program as bytes, to go on from later on the same kind of machine: numbers
// and columns of numbers in the order in which they were put.

#ifndef FLOCKLIFT_SIMULATE_CORE_STATE_ARCHIVE_H_
#define FLOCKLIFT_SIMULATE_CORE_STATE_ARCHIVE_H_

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace flocklift {

class StateWriter {
 public:
  template <typename T>
  void Put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <typename T>
  void Put(const std::vector<T>& column) {
    static_assert(std::is_trivially_copyable_v<T>);
    Put(static_cast<std::uint64_t>(column.size()));
    if (!column.empty()) {
      bytes_.append(reinterpret_cast<const char*>(column.data()), column.size() * sizeof(T));
    }
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Throws std::runtime_error when the bytes end early, or a column has another length than expected.
class StateReader {
 public:
  explicit StateReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename T>
  void Take(T* value) {
    static_assert(std::is_trivially_copyable_v<T>);
    Copy(value, sizeof(T));
  }
  // The column keeps its length, which must be that of the one that was put.
  template <typename T>
  void Take(std::vector<T>* column) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t size = 0;
    Take(&size);
    if (size != column->size()) throw std::runtime_error("the saved state is of another flock");
    if (!column->empty()) Copy(column->data(), column->size() * sizeof(T));
  }
  bool AtEnd() const { return bytes_.empty(); }

 private:
  void Copy(void* to, std::size_t size) {
    if (bytes_.size() < size) throw std::runtime_error("the saved state ends early");
    std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }

  std::string_view bytes_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_STATE_ARCHIVE_H_
