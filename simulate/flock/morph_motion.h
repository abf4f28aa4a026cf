// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The model `morph` as a motion: prepares the tetrahedra of both shapes, the path's key points and
// the obstacles' distances, then flies (simulate/flock/flock_morph.h). Animals are tetrahedra,
// numbered in the order in which they leave.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_MORPH_MOTION_H_
#define FLOCKLIFT_SIMULATE_FLOCK_MORPH_MOTION_H_

#include <cstddef>
#include <memory>
#include <vector>

#include "simulate/flock/flock_morph.h"
#include "simulate/flock/morph_model.h"
#include "simulate/flock/motion.h"

namespace flocklift {

// The solid within a closed mesh as `count` tetrahedra. Throws as PrepareMorph.
std::vector<Tetra> FillWith(const TriangleMesh& mesh, std::size_t count);

// What the morph of `count` tetrahedra is made from. Throws std::invalid_argument when the species
// has no two shapes, or they cannot be filled with so many.
MorphScene PrepareMorph(const MorphParameters& parameters, const MotionContext& context,
                        std::size_t count);

template <typename T>
std::unique_ptr<Motion<T>> MakeMorphMotion(const MorphParameters& parameters,
                                           const MotionContext& context, Herd<T>* herd);

extern template std::unique_ptr<Motion<float>> MakeMorphMotion(const MorphParameters&,
                                                               const MotionContext&, Herd<float>*);
extern template std::unique_ptr<Motion<double>> MakeMorphMotion(const MorphParameters&,
                                                                const MotionContext&,
                                                                Herd<double>*);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_MORPH_MOTION_H_
