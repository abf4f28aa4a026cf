// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Closed meshes for the tests of fields: shapes whose distance is known or hard.

#ifndef FLOCKLIFT_TESTS_SIMULATE_FIELDS_MESHES_H_
#define FLOCKLIFT_TESTS_SIMULATE_FIELDS_MESHES_H_

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "simulate/core/rng.h"
#include "simulate/core/triangle_mesh.h"

namespace flocklift {

// The box from low to high, 12 triangles.
inline TriangleMesh BoxMesh(const Vec3d& low, const Vec3d& high) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.push_back(
        {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// A ring of `rings` circles of `segments` points each, joined to a torus.
inline TriangleMesh TorusMesh(double major, double minor, std::uint32_t rings,
                              std::uint32_t segments) {
  TriangleMesh mesh;
  for (std::uint32_t r = 0; r < rings; ++r) {
    for (std::uint32_t s = 0; s < segments; ++s) {
      const double a = 2 * std::numbers::pi * r / rings, b = 2 * std::numbers::pi * s / segments;
      const double out = major + minor * std::cos(b);
      mesh.vertices.push_back({out * std::cos(a), out * std::sin(a), minor * std::sin(b)});
      const std::uint32_t r1 = (r + 1) % rings, s1 = (s + 1) % segments;
      const std::uint32_t v00 = r * segments + s, v10 = r1 * segments + s;
      const std::uint32_t v01 = r * segments + s1, v11 = r1 * segments + s1;
      mesh.triangles.push_back({v00, v10, v11});
      mesh.triangles.push_back({v00, v11, v01});
    }
  }
  return mesh;
}

// A ball of meridians and parallels; `bumps` moves every vertex in or out by up to that share.
inline TriangleMesh BallMesh(const Vec3d& centre, double radius, std::uint32_t parallels,
                             std::uint32_t meridians, double bumps = 0) {
  TriangleMesh mesh;
  Rng rng(3);
  const auto add = [&](double polar, double azimuth) {
    const double r = radius * (1 + bumps * rng.Uniform(-1, 1));
    mesh.vertices.push_back(centre + r * Vec3d{std::sin(polar) * std::cos(azimuth),
                                               std::sin(polar) * std::sin(azimuth),
                                               std::cos(polar)});
  };
  add(0, 0);
  for (std::uint32_t p = 1; p < parallels; ++p) {
    for (std::uint32_t m = 0; m < meridians; ++m) {
      add(std::numbers::pi * p / parallels, 2 * std::numbers::pi * m / meridians);
    }
  }
  add(std::numbers::pi, 0);
  const auto at = [&](std::uint32_t p, std::uint32_t m) { return 1 + (p - 1) * meridians + m; };
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t m = 0; m < meridians; ++m) {
    const std::uint32_t n = (m + 1) % meridians;
    mesh.triangles.push_back({0, at(1, m), at(1, n)});
    for (std::uint32_t p = 1; p + 1 < parallels; ++p) {
      mesh.triangles.push_back({at(p, m), at(p + 1, m), at(p + 1, n)});
      mesh.triangles.push_back({at(p, m), at(p + 1, n), at(p, n)});
    }
    mesh.triangles.push_back({at(parallels - 1, m), last, at(parallels - 1, n)});
  }
  return mesh;
}

// Two thin sheets that meet at a needle-sharp tip: the hardest corner for the sign.
inline TriangleMesh NeedleMesh() {
  return {{{0, 0, 0}, {0.05, 0, 0}, {0, 0.05, 0}, {0.3, 0.2, 3}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

inline void Append(const TriangleMesh& other, TriangleMesh* mesh) {
  const auto offset = static_cast<std::uint32_t>(mesh->vertices.size());
  mesh->vertices.insert(mesh->vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) {
    mesh->triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
}

// A cube whose top is a pit down to its middle, and a pyramid that stands in the pit on its tip:
// two surfaces with one vertex in common, which is nearest to points inside the cube.
inline TriangleMesh KissingMesh() {
  TriangleMesh mesh = BoxMesh({-1, -1, -1}, {1, 1, 1});
  std::erase_if(mesh.triangles, [](const auto& t) { return t[0] >= 4 && t[1] >= 4 && t[2] >= 4; });
  mesh.vertices.push_back({0, 0, 0});
  const auto cone = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const std::uint32_t tip = 8;
    for (const auto& t : {std::array{a, b, tip}, {b, d, tip}, {d, c, tip}, {c, a, tip}}) {
      mesh.triangles.push_back(t);
    }
  };
  cone(4, 5, 6, 7);
  const double w = 0.2, h = 0.8;
  mesh.vertices.insert(mesh.vertices.end(), {{-w, -w, h}, {w, -w, h}, {-w, w, h}, {w, w, h}});
  cone(10, 9, 12, 11);  // a different way round
  mesh.triangles.insert(mesh.triangles.end(), {{9, 10, 11}, {10, 12, 11}});
  return mesh;
}

// Turned inside out: the wall of a cavity.
inline TriangleMesh Inverted(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

inline std::vector<NamedMesh> ManyMeshes() {
  std::vector<NamedMesh> meshes = {
      {"cube", BoxMesh({-1, -1, -1}, {1, 1, 1})},
      {"plate", BoxMesh({-1, -1.5, -0.001}, {1, 1.5, 0.001})},
      {"ball", BallMesh({0.1, -0.2, 0.3}, 1.2, 12, 20)},
      {"bumpy ball", BallMesh({0, 0, 0}, 1.2, 14, 22, 0.35)},
      {"torus", TorusMesh(1.0, 0.35, 24, 12)},
      {"needle", NeedleMesh()},
  };
  TriangleMesh hollow = BallMesh({0, 0, 0}, 1.5, 10, 16);
  Append(Inverted(BallMesh({0.2, 0, 0}, 0.9, 9, 14)), &hollow);
  meshes.push_back({"hollow ball", hollow});
  TriangleMesh two = BoxMesh({-1.5, -1, -1}, {-0.2, 1, 1});
  Append(BoxMesh({0.2, -1, -1}, {1.5, 1, 1}), &two);
  meshes.push_back({"two boxes", two});
  meshes.push_back({"kissing", KissingMesh()});
  return meshes;
}

}  // namespace flocklift

#endif  // FLOCKLIFT_TESTS_SIMULATE_FIELDS_MESHES_H_
