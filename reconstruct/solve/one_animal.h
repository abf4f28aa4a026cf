// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One animal of a flock with forces (coupled_flock.h) as if the others stood still, and forces and
// the flock's scalars with them: a block of coordinates. What counts is all that changes with its
// path: its own errors, and those of all who hear it. They are found by Gauss-Newton with
// Levenberg's damping. A step costs in proportion to its knots times the animals that are there,
// for the others' sums over whom they hear are kept without it; there is no system of the whole
// flock to be solved.

#ifndef FLOCKLIFT_RECONSTRUCT_SOLVE_ONE_ANIMAL_H_
#define FLOCKLIFT_RECONSTRUCT_SOLVE_ONE_ANIMAL_H_

#include <vector>

#include "reconstruct/solve/coupled_flock.h"

namespace flocklift::internal {

class OneAnimal {
 public:
  // The flock stays the caller's, and its other animals where they are.
  explicit OneAnimal(CoupledFlock* flock);

  void Choose(std::size_t animal);
  const Bird& bird() const { return flock_.birds_[animal_]; }
  void Put(const Bird& bird);

  // Of all errors that its path is in, but for a constant.
  double Cost() const;
  // Returns the cost that it comes to.
  double Minimize(int max_iterations);

 private:
  using Knot = CoupledFlock::Knot;
  using Line = CoupledFlock::Line;

  // Calls visit(line, animal) for those who are there at a knot of the sequence, but for one.
  template <typename Visit>
  void ForEachOther(int time, std::size_t but_for, const Visit& visit) const {
    const std::vector<std::size_t>& present = flock_.present_[static_cast<std::size_t>(time)];
    for (std::size_t n = 0; n < present.size(); ++n) {
      if (present[n] != but_for) visit(first_line_[static_cast<std::size_t>(time)] + n, present[n]);
    }
  }
  Offset From(std::size_t line, std::size_t to) const {
    return {states_[to].x - states_[line].x, states_[to].v - states_[line].v};
  }
  bool Hears(const Offset& offset) const { return Dot(offset.dx, offset.dx) <= reach_ * reach_; }
  // At its own knot, of all others.
  void Hear(int knot);
  Vec3d SelfForceAt(std::size_t animal, int knot, SelfDerivatives* derivatives) const;
  // Errors follow its states, those of all who are there with it.
  void Update();
  void Linearize();
  void LinearizeOwn();
  void LinearizeOthers();

  CoupledFlock& flock_;
  std::vector<std::size_t> first_line_;  // at every knot of the sequence
  double reach_;
  PairForce pairs_;
  // Of every line: state, acceleration beyond what the animal does by itself, z_ref / z, error.
  std::vector<Knot> states_;
  std::vector<Vec3d> rest_;
  std::vector<double> factor_;
  std::vector<Vec3d> errors_;
  // Of every line of others while this animal is there: sums over whom it hears, this one left
  // out; whether it hears this one; and its error's derivatives by this one's offset.
  std::vector<PairForce::Sums> without_;
  std::vector<char> hears_;
  std::vector<ByOffset> by_;

  std::size_t animal_ = 0;
  std::vector<Line> lines_;  // linearised, of its knots
  ArrowSystem system_{0, 0, 0};
  std::vector<Offset> heard_;
  std::vector<ByOffset> by_heard_;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_SOLVE_ONE_ANIMAL_H_
