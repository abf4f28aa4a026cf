// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/subdivide.h"

#include <algorithm>
#include <numeric>

#include "simulate/core/check.h"

namespace flocklift {

// A corner replaced by an inner point keeps the orientation.
std::array<Tetra, 4> CutInFour(const Tetra& t) {
  std::array<Tetra, 4> pieces{t, t, t, t};
  for (std::size_t k = 0; k < 4; ++k) pieces[k][k] = Centroid(t);
  return pieces;
}

std::array<Tetra, 3> CutInThree(const Tetra& t) {
  std::size_t largest = 0;
  double most = -1;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& [a, b, c] = kTetraFaces[k];
    const double area = Norm(Cross(t[b] - t[a], t[c] - t[a]));
    if (area > most) {
      most = area;
      largest = k;
    }
  }
  const auto& face = kTetraFaces[largest];
  const Vec3d centre = (t[face[0]] + t[face[1]] + t[face[2]]) / 3.0;
  std::array<Tetra, 3> pieces{t, t, t};
  for (std::size_t k = 0; k < 3; ++k) pieces[k][face[k]] = centre;
  return pieces;
}

std::array<Tetra, 2> CutInTwo(const Tetra& t) {
  std::size_t from = 0, to = 1;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      if (SquaredNorm(t[b] - t[a]) > SquaredNorm(t[to] - t[from])) {
        from = a;
        to = b;
      }
    }
  }
  std::array<Tetra, 2> pieces{t, t};
  pieces[0][from] = pieces[1][to] = 0.5 * (t[from] + t[to]);
  return pieces;
}

std::vector<Tetra> SubdivideTo(std::size_t count, std::vector<Tetra> tetrahedra) {
  Check(!tetrahedra.empty(), "there are no tetrahedra to subdivide");
  Check(tetrahedra.size() <= count, "there are more tetrahedra than wanted");
  while (4 * tetrahedra.size() <= count) {
    std::vector<Tetra> finer;
    finer.reserve(4 * tetrahedra.size());
    for (const Tetra& t : tetrahedra) {
      for (const Tetra& piece : CutInFour(t)) finer.push_back(piece);
    }
    tetrahedra = std::move(finer);
  }
  const std::size_t missing = count - tetrahedra.size();
  const std::size_t fours = missing / 3, rest = missing % 3;

  std::vector<double> volume;
  for (const Tetra& t : tetrahedra) volume.push_back(Volume(t));
  std::vector<std::size_t> order(tetrahedra.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return volume[a] > volume[b]; });
  // The first piece takes the place of the whole, the others follow at the end.
  const auto replace = [&](std::size_t which, const auto& pieces) {
    tetrahedra[which] = pieces[0];
    tetrahedra.insert(tetrahedra.end(), pieces.begin() + 1, pieces.end());
  };
  for (std::size_t k = 0; k < fours; ++k) replace(order[k], CutInFour(tetrahedra[order[k]]));
  if (rest == 2) replace(order[fours], CutInThree(tetrahedra[order[fours]]));
  if (rest == 1) replace(order[fours], CutInTwo(tetrahedra[order[fours]]));
  return tetrahedra;
}

}  // namespace flocklift
