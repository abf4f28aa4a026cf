// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The force terms of a species at work: each adds its accelerations to the herd's.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_FORCE_PASSES_H_
#define FLOCKLIFT_SIMULATE_FLOCK_FORCE_PASSES_H_

#include <memory>
#include <string>
#include <vector>

#include "simulate/flock/motion.h"

namespace flocklift {

template <typename T>
class ForcePass {
 public:
  virtual ~ForcePass() = default;

  // How far neighbours are felt; 0: the term knows none [m].
  virtual double Reach() const { return 0; }
  // The herd is sorted by cells at least that wide.
  virtual void Add(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) = 0;
  virtual void Save(StateWriter* /*out*/) const {}
  virtual void Load(StateReader* /*in*/) {}
};

// All terms of a species, in the order of the file.
template <typename T>
class ForcePasses {
 public:
  // Throws InputError for terms that the file names wrongly.
  explicit ForcePasses(const MotionContext& context, std::size_t animals);

  bool empty() const { return passes_.empty(); }
  double Reach() const;
  void Add(const Surroundings& around, ThreadPool* pool, Herd<T>* herd);
  void Save(StateWriter* out) const;
  void Load(StateReader* in);

 private:
  std::vector<std::unique_ptr<ForcePass<T>>> passes_;
};

// InputError when the scene gives terms to a model that does not move by accelerations.
void RefuseForces(const MotionContext& context, const std::string& model, const std::string& why);

extern template class ForcePasses<float>;
extern template class ForcePasses<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_FORCE_PASSES_H_
