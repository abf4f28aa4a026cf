// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/tetgen.h"

#include <fmt/format.h>
#include <tetgen.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace flocklift {

bool HasTetgen() { return true; }

TetraMesh TetrahedralizeByTetgen(const TriangleMesh& surface,
                                 const TetrahedralizeOptions& options) {
  tetgenio in, out;
  in.numberofpoints = static_cast<int>(surface.vertices.size());
  in.pointlist = new REAL[3 * surface.vertices.size()];  // tetgenio deletes its arrays
  for (std::size_t k = 0; k < surface.vertices.size(); ++k) {
    in.pointlist[3 * k] = surface.vertices[k].x;
    in.pointlist[3 * k + 1] = surface.vertices[k].y;
    in.pointlist[3 * k + 2] = surface.vertices[k].z;
  }
  in.numberoffacets = static_cast<int>(surface.triangles.size());
  in.facetlist = new tetgenio::facet[surface.triangles.size()];
  for (std::size_t k = 0; k < surface.triangles.size(); ++k) {
    tetgenio::facet& facet = in.facetlist[k];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    for (std::size_t c = 0; c < 3; ++c) {
      facet.polygonlist->vertexlist[c] = static_cast<int>(surface.triangles[k][c]);
    }
  }
  std::string switches = fmt::format("pq{:g}Q", options.radius_edge);
  if (options.cell > 0) {
    switches += fmt::format("a{:.12f}", options.cell * options.cell * options.cell / 12);
  }
  try {
    tetrahedralize(switches.data(), &in, &out);
  } catch (int code) {
    throw std::invalid_argument(
        fmt::format("TetGen refuses the surface (code {}; 3: it intersects itself)", code));
  }
  TetraMesh mesh;
  for (int k = 0; k < out.numberofpoints; ++k) {
    mesh.vertices.push_back(
        {out.pointlist[3 * k], out.pointlist[3 * k + 1], out.pointlist[3 * k + 2]});
  }
  for (int k = 0; k < out.numberoftetrahedra; ++k) {
    std::array<std::uint32_t, 4> t;
    for (int c = 0; c < 4; ++c) {
      t[static_cast<std::size_t>(c)] =
          static_cast<std::uint32_t>(out.tetrahedronlist[k * out.numberofcorners + c]);
    }
    mesh.tetrahedra.push_back(t);
    if (Volume(mesh.Corners(mesh.tetrahedra.size() - 1)) < 0) {
      std::swap(mesh.tetrahedra.back()[2], mesh.tetrahedra.back()[3]);
    }
  }
  return mesh;
}

}  // namespace flocklift
