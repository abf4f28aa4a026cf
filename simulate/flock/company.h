// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which animals may have somebody too near, for minimum-distance enforcement
// (simulate/flock/minimum_distance.h) where nearly all have nobody. Every animal sets the bit of
// its cell of a lattice; cells are wider than twice the largest distance asked for, so that an
// animal's own cell and the nearer neighbours, eight in all, hold everybody who may be too near.
// Who sees a second bit in there may have company; where two are in one cell, the bits of its
// neighbours along x are set too. A few are found that have none, since cells far apart may share a
// bit. The lattice is numbered row by row, so that neighbours in space share cache lines. With
// several threads each has a share of the animals: it sets their bits by themselves, joins those of
// all in bits of its own, and looks its animals up there. To look up what another core has written
// takes longer than to copy it.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_COMPANY_H_
#define FLOCKLIFT_SIMULATE_FLOCK_COMPANY_H_

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "simulate/core/large_pages.h"
#include "simulate/core/parallel_for.h"
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
  void Find(std::span<const Crowd<T>> crowds, const CrowdBox<T>& box, T reach, ThreadPool* pool);

  // Ascending, by share of the animals; all that are nearer than `reach` to somebody are among
  // them.
  const std::vector<std::vector<Animal>>& found() const { return found_; }
  std::uint32_t across_y() const { return across_y_; }
  std::uint32_t across_z() const { return across_z_; }

  // Animals a cell, on average over the box.
  static double Density(std::span<const Crowd<T>> crowds, const CrowdBox<T>& box, T reach);

 private:
  using Words = std::pmr::vector<std::uint64_t>;  // of bits; the first byte follows again
  struct Bits {
    explicit Bits(std::pmr::memory_resource* memory) : words(memory) {}
    Words words;
    std::vector<std::uint32_t> shared;  // those that were set already
  };

  // Of the cell that a place is in, taken down by `shift` cells along each axis before.
  std::uint32_t Cell(T x, T y, T z, T shift = T(0)) const;
  void Number(const Crowd<T>& crowd, std::size_t first, std::size_t last, std::uint32_t* to) const;
  void NumberLattice(const CrowdBox<T>& box, T reach, std::size_t animals);
  // Of the animals first .. last - 1, counted through all crowds.
  void SetBits(std::span<const Crowd<T>> crowds, std::size_t first, std::size_t last,
               Bits* own) const;
  // Those of all shares, for one of them, and those that two have set.
  void Join(std::size_t share);
  void SetNeighbours(const std::vector<std::uint32_t>& shared, Words* words) const;
  void LookUp(std::span<const Crowd<T>> crowds, std::size_t first, std::size_t last,
              const Words& words, std::vector<Animal>* found) const;

  T per_cell_ = 0;
  std::uint32_t across_y_ = 0, across_z_ = 0;
  std::uint32_t mask_ = 0;  // of the bit of a cell
  LargePages memory_;       // of many bits
  std::vector<Bits> bits_;  // these and the others by share of the animals
  std::vector<Words> joined_;
  std::vector<std::vector<std::uint32_t>> shared_;  // in them
  std::vector<std::vector<Animal>> found_;
};

extern template class Company<float>;
extern template class Company<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_COMPANY_H_
