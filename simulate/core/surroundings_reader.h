// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of a scene file that surround the animals: goals, predators, obstacles, shapes, paths,
// wind and events.

#ifndef FLOCKLIFT_SIMULATE_CORE_SURROUNDINGS_READER_H_
#define FLOCKLIFT_SIMULATE_CORE_SURROUNDINGS_READER_H_

#include <string>

#include "simulate/core/scene.h"
#include "simulate/core/settings.h"

namespace flocklift::internal {

inline constexpr double kLongest = 86400;  // of any time: a day [s]
inline constexpr double kFastest = 1000;   // [m/s]

// `file` is the whole file; the species must have been read. Throws InputError.
void ReadSurroundings(Settings* file, Scene* scene);

// Every species' shape and path, and every shape's path, must be in the scene.
void CheckNamesOfSurroundings(const std::string& name, const Scene& scene);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_SURROUNDINGS_READER_H_
