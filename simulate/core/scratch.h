// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Room to work in, mostly more than is needed: what is never written costs nothing, unlike the
// zeros of a std::vector.

#ifndef FLOCKLIFT_SIMULATE_CORE_SCRATCH_H_
#define FLOCKLIFT_SIMULATE_CORE_SCRATCH_H_

#include <cstddef>
#include <memory>

namespace flocklift {

template <typename T>
class Scratch {
 public:
  // Room for as many at least, whose values are any.
  T* Reserve(std::size_t wanted) {
    if (wanted > room_) {
      values_ = std::make_unique_for_overwrite<T[]>(wanted);
      room_ = wanted;
    }
    return values_.get();
  }

 private:
  std::size_t room_ = 0;
  std::unique_ptr<T[]> values_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_SCRATCH_H_
