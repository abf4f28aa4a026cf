// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Metric neighbours: a grid of cubic cells over the animals' bounding box, and the animals sorted
// by cell (counting sort; x fastest, then y, z; stable, so the order is a function of the state).
// Cells are at least `reach` wide, so all within reach of an animal are in its cell or one that
// touches it: nine runs of consecutive animals, one per row of cells along x. A ghost layer of
// empty cells all around saves the tests at the rim. Linear in animals: where cells of that width
// would be too many (a sparse, scattered flock), they are made wider.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_CELL_GRID_H_
#define FLOCKLIFT_SIMULATE_FLOCK_CELL_GRID_H_

#include <cstdint>
#include <vector>

#include "simulate/core/parallel_for.h"
#include "simulate/flock/bodies.h"

namespace flocklift {

template <typename T>
class CellGrid {
 public:
  // Takes the memory that a sort of so many needs, but for the cells', ahead of the first.
  void Reserve(std::size_t animals) { cell_.resize(animals); }

  // Sorts `from` by cell into `to`, on the pool's threads if there is one; the result is the same.
  // Throws std::runtime_error when a position is not finite.
  void Sort(const Bodies<T>& from, double reach, Bodies<T>* to, ThreadPool* pool = nullptr);

  // What the kernels read, as plain numbers.
  struct View {
    const std::uint32_t* start;  // of each cell's run; the next entry is its end
    T low_x, inverse_edge;
    int nx, ny, nz;  // cells without the ghosts, which have the indices 0 and n + 1

    int Cell(int a, int b, int c) const { return (c * (ny + 2) + b) * (nx + 2) + a; }
    int CellX(T x) const {  // 1 .. nx
      const int a = static_cast<int>((x - low_x) * inverse_edge);
      return 1 + (a < nx ? a : nx - 1);
    }
    int RowCount() const {
      return ny * nz;
    }  // row r holds the cells b = 1 + r % ny, c = 1 + r / ny
  };
  View view() const { return {start_.data(), low_.x, inverse_edge_, nx_, ny_, nz_}; }

  // Calls fn(first, last) for the nine runs that hold all within reach of animals of cell row
  // (b, c), cells a0 .. a1, in the order of the sort.
  template <typename Function>
  static void ForEachRun(const View& g, int a0, int a1, int b, int c, const Function& fn) {
    for (int dc = -1; dc <= 1; ++dc) {
      for (int db = -1; db <= 1; ++db) {
        fn(g.start[g.Cell(a0 - 1, b + db, c + dc)], g.start[g.Cell(a1 + 1, b + db, c + dc) + 1]);
      }
    }
  }

 private:
  void ChooseCells(const Vec3<T>& low, const Vec3<T>& high, double reach, std::size_t n);
  void StartRuns(std::size_t cells, ThreadPool* pool);

  Vec3<T> low_;
  T inverse_edge_{};
  int nx_ = 0, ny_ = 0, nz_ = 0;
  // By cell, animal, share and cell, share and block of cells.
  std::vector<std::uint32_t> start_, cell_, next_, in_block_;
};

extern template class CellGrid<float>;
extern template class CellGrid<double>;

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_CELL_GRID_H_
