// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the animals of one species move: one class per model, made by MakeMotion. A motion takes the
// herd from one step to the next; the engine looks after everything that several species share.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_MOTION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_MOTION_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/core/scene.h"
#include "simulate/core/state_archive.h"
#include "simulate/flock/herd.h"
#include "simulate/flock/model.h"
#include "simulate/flock/world.h"

namespace flocklift {

// How much room the animals of a species keep from all others that keep any: two of them are at
// least as far from each other as their rooms together say.
struct Room {
  double distance = 0;  // half the least distance between two of the species [m]
  double bodies = 0;    // ... and so many radii of the animal's own body
};

template <typename T>
class Motion {
 public:
  virtual ~Motion() = default;

  // Moves `herd` by one step of around.dt(); its order may change. Fills the herd's neighbours, and
  // its accelerations where the model has any (0 otherwise). The result depends on the state alone,
  // not on the pool's threads.
  virtual void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) = 0;

  // Whether anybody has neighbours in this model; the herd's are 0 otherwise.
  virtual bool HasNeighbours() const { return true; }

  // Other parameters of the same model from the next step on: an event, or somebody's slider.
  virtual void Retune(const ModelParameters& parameters) = 0;

  // What the motion remembers from step to step beyond the herd, to go on from later.
  virtual void Save(StateWriter* /*out*/) const {}
  virtual void Load(StateReader* /*in*/) {}

  // Minimum-distance enforcement after the step, across species; the engine does it. None: zeros.
  virtual Room room() const { return {}; }

  // Animals that a minimum-distance enforcement of the motion's own moved at the last step.
  virtual std::int64_t touched() const { return 0; }

  // Animals that are tetrahedra: appends the four corners of each, as they are now, by agent [m].
  virtual void AppendCorners(ThreadPool* /*pool*/, std::vector<Vec3<float>>* /*corners*/) {}
};

// What a motion may be made from, besides the parameters.
struct MotionContext {
  const World* world = nullptr;                    // lives as long as the motion
  std::string species;                             // the herd's
  std::string shape, path;                         // the species' own, by name; may be empty
  std::string start_shape;                         // likewise
  const Settling* settled = nullptr;               // lives as long as the motion is made
  const std::vector<ModelSpec>* forces = nullptr;  // [[species.force]], checked
  std::string kernel;          // instruction set by name; empty: the fastest there is
  ThreadPool* pool = nullptr;  // for the preparation
  std::string where;           // "FILE:LINE" of the model in the scene's file; empty: none
};

// The species cannot move by its model: throws InputError with the place in the scene's file, or
// std::invalid_argument where there is none.
[[noreturn]] void RefuseModel(const MotionContext& context, const std::string& fault,
                              const std::string& mend);

// Throws std::invalid_argument for numbers that make no sense together, InputError for what the
// scene's file got wrong. `herd` is the species at the start.
template <typename T>
std::unique_ptr<Motion<T>> MakeMotion(const ModelParameters& parameters,
                                      const MotionContext& context, Herd<T>* herd);

extern template std::unique_ptr<Motion<float>> MakeMotion(const ModelParameters&,
                                                          const MotionContext&, Herd<float>*);
extern template std::unique_ptr<Motion<double>> MakeMotion(const ModelParameters&,
                                                           const MotionContext&, Herd<double>*);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_MOTION_H_
