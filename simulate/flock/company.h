// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which animals may have somebody too near, for minimum-distance enforcement
// (simulate/flock/minimum_distance.h) where nearly all have nobody. Every animal sets the bit of
// its cell of a lattice; cells are wider than twice the largest distance asked for, so that an
// animal's own cell and the nearer neighbours, eight in all, hold everybody who may be too near.
// Who sees a second bit in there may have company; where two are in one cell, the bits of its
// neighbours along x are set too. A few are found that have none, since cells far apart may share a
// bit. The lattice is numbered row by row, so that neighbours in space share cache lines.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_COMPANY_H_
#define FLOCKLIFT_SIMULATE_FLOCK_COMPANY_H_

#include <cstdint>
#include <span>
#include <vector>

#include "simulate/flock/crowd.h"

namespace flocklift {

template <typename T>
class Company {
 public:
  // Counted through all crowds, where it is, and the numbers of its own cell and of the lowest of
  // its eight; the others' are further by 1, across_y(), across_z() and their sums, modulo 2^32.
  struct Animal {
    std::uint32_t animal, cell, lowest;
    T x, y, z, room;  // [m]
  };

  // `box` is around all, `reach` the largest distance asked for, above 0 [m].
  void Find(std::span<const Crowd<T>> crowds, const CrowdBox<T>& box, T reach);

  // Ascending; all that are nearer than `reach` to somebody are among them.
  const std::vector<Animal>& found() const { return found_; }
  std::uint32_t across_y() const { return across_y_; }
  std::uint32_t across_z() const { return across_z_; }

  // Animals a cell, on average over the box.
  static double Density(std::span<const Crowd<T>> crowds, const CrowdBox<T>& box, T reach);

 private:
  // Of the cell that a place is in, taken down by `shift` cells along each axis before.
  std::uint32_t Cell(T x, T y, T z, T shift = T(0)) const;
  void Number(const Crowd<T>& crowd, std::size_t first, std::size_t last, std::uint32_t* to) const;
  void NumberLattice(const CrowdBox<T>& box, T reach, std::size_t animals);
  void SetBits(std::span<const Crowd<T>> crowds);
  void SetNeighbours();
  void LookUp(std::span<const Crowd<T>> crowds);

  T per_cell_ = 0;
  std::uint32_t across_y_ = 0, across_z_ = 0;
  std::uint32_t mask_ = 0;             // of the bit of a cell
  std::vector<std::uint8_t> bits_;     // eight a byte; the first byte follows again
  std::vector<std::uint32_t> shared_;  // those that were set already
  std::vector<Animal> found_;
};

extern template class Company<float>;
extern template class Company<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_COMPANY_H_
