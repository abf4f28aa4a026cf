// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/tetrahedralize.h"

#include <cmath>
#include <utility>

#include "simulate/core/check.h"
#include "simulate/shapes/creases.h"
#include "simulate/shapes/lattice_fill.h"
#include "simulate/shapes/tetgen.h"

namespace flocklift {
namespace {

constexpr int kTries = 12;
constexpr double kCloseEnough = 0.98;  // of most_tetrahedra

TetraMesh FitLattice(const TriangleTree& surface, double cell) {
  return RestoreCreases(surface, cell, {}, FillWithLattice(surface, cell));
}

// The finest lattice of at most so many tetrahedra. Their number is not quite monotonic in the
// cell, hence a search by ratios that keeps the best.
TetraMesh FitCount(const TriangleTree& surface, double volume, int most) {
  double cell = std::cbrt(12 * volume / most), too_fine = 0, coarse_enough = 0;
  TetraMesh best;
  for (int k = 0; k < kTries; ++k) {
    TetraMesh mesh = FitLattice(surface, cell);
    const auto count = static_cast<double>(mesh.tetrahedra.size());
    if (count <= most) {
      coarse_enough = cell;
      if (count > static_cast<double>(best.tetrahedra.size())) best = std::move(mesh);
      if (count >= kCloseEnough * most) break;
    } else {
      too_fine = cell;
    }
    // Surface layers count beside volume: nearly cell^-2.5 for the shapes of scenes.
    const double guess = count > 0 ? cell * std::pow(count / (0.99 * most), 1 / 2.5) : 0.7 * cell;
    const bool between = guess > too_fine && (coarse_enough == 0 || guess < coarse_enough);
    cell =
        between || coarse_enough == 0 || too_fine == 0 ? guess : 0.5 * (too_fine + coarse_enough);
  }
  return best;
}

}  // namespace

TetraMesh Tetrahedralize(const TriangleMesh& surface, const TetrahedralizeOptions& options) {
  const double volume = EnclosedVolume(surface);
  Check(volume > 0, "the surface encloses no volume, or its triangles face inwards");
  if (options.tetgen) return TetrahedralizeByTetgen(surface, options);
  const TriangleTree tree(surface);
  TetraMesh mesh = options.cell > 0 ? FitLattice(tree, options.cell)
                                    : FitCount(tree, volume, options.most_tetrahedra);
  Check(!mesh.tetrahedra.empty(), "the lattice is too coarse for the surface");
  return mesh;
}

}  // namespace flocklift
