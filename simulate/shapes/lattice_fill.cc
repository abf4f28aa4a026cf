// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/lattice_fill.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

// How near a crossing pulls a lattice point onto the surface, by the kind of the edge that it lies
// on, as a share of the edge: the authors' values for the uniform lattice with their bounds on the
// dihedral angles.
constexpr double kSnapLong = 0.24999, kSnapShort = 0.41189;
// The lattice is set off by odd shares of a cell, so that surfaces drawn on round numbers do not
// run along lattice planes.
constexpr Vec3d kOffset{0.3819660, 0.2360680, 0.4142136};

constexpr double kMostPoints = 2e8;

// Points of the lattice: the corners of a grid of cubes, then their centres.
class Lattice {
 public:
  Lattice(const TriangleMesh& surface, double cell) : cell_(cell) {
    Vec3d low = surface.Corner(0, 0), high = low;
    for (const auto& triangle : surface.triangles) {
      for (const std::uint32_t corner : triangle) {
        const Vec3d& p = surface.vertices[corner];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
    }
    low_ = low - cell * (Vec3d{1, 1, 1} + kOffset);
    const Vec3d cells = (high - low_) / cell + Vec3d{2, 2, 2};
    Check(cells.x * cells.y * cells.z < kMostPoints, "the lattice is too fine for the surface");
    n_ = {static_cast<int>(cells.x), static_cast<int>(cells.y), static_cast<int>(cells.z)};
    corners_ = static_cast<std::size_t>(n_[0] + 1) * (n_[1] + 1) * (n_[2] + 1);
    points_ = corners_ + static_cast<std::size_t>(n_[0]) * n_[1] * n_[2];
  }

  std::size_t size() const { return points_; }
  int cells(int axis) const { return n_[static_cast<std::size_t>(axis)]; }
  double cell() const { return cell_; }
  // The line (i, j) of corners (kind 0) or centres (kind 1) along z: its place and its points.
  Vec3d LineStart(int kind, int i, int j) const {
    return low_ + cell_ * (Vec3d{double(i), double(j), 0} + 0.5 * kind * Vec3d{1, 1, 1});
  }
  std::uint32_t Corner(int i, int j, int k) const {
    return static_cast<std::uint32_t>(
        (static_cast<std::size_t>(k) * (n_[1] + 1) + j) * (n_[0] + 1) + i);
  }
  std::uint32_t Centre(int i, int j, int k) const {
    return static_cast<std::uint32_t>(corners_ + (static_cast<std::size_t>(k) * n_[1] + j) * n_[0] +
                                      i);
  }
  std::uint32_t Point(int kind, int i, int j, int k) const {
    return kind == 0 ? Corner(i, j, k) : Centre(i, j, k);
  }
  bool IsLong(std::uint32_t a, std::uint32_t b) const {  // edges of corner and centre are short
    return (a < corners_) == (b < corners_);
  }

 private:
  Vec3d low_;
  double cell_;
  std::array<int, 3> n_;
  std::size_t corners_, points_;
};

// Calls fn(z, winding) for the lattice's lines along z that the triangle's projection contains.
// Edges are judged from their smaller vertex on, so that neighbours agree to the last bit.
template <typename Function>
void ForEachLineThrough(const TriangleMesh& surface, std::size_t triangle, const Lattice& lattice,
                        int kind, const Function& fn) {
  const auto& corners = surface.triangles[triangle];
  const std::array<Vec3d, 3> p{surface.vertices[corners[0]], surface.vertices[corners[1]],
                               surface.vertices[corners[2]]};
  const Vec3d normal = Cross(p[1] - p[0], p[2] - p[0]);
  if (normal.z == 0) return;
  const Vec3d start = lattice.LineStart(kind, 0, 0);
  const auto range = [&](double a, double b, double c, double from, int count) {
    const double low = std::min({a, b, c}), high = std::max({a, b, c});
    return std::pair(std::max(0, static_cast<int>(std::floor((low - from) / lattice.cell()))),
                     std::min(count - 1, static_cast<int>((high - from) / lattice.cell()) + 1));
  };
  const auto [i0, i1] = range(p[0].x, p[1].x, p[2].x, start.x, lattice.cells(0) + 1 - kind);
  const auto [j0, j1] = range(p[0].y, p[1].y, p[2].y, start.y, lattice.cells(1) + 1 - kind);
  const double lowest = std::min({p[0].z, p[1].z, p[2].z});
  const double highest = std::max({p[0].z, p[1].z, p[2].z});
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const Vec3d q = lattice.LineStart(kind, i, j);
      int left = 0;
      for (std::size_t e = 0; e < 3; ++e) {
        std::size_t a = e, b = (e + 1) % 3;
        const bool swapped = corners[a] > corners[b];
        if (swapped) std::swap(a, b);
        const double side = (p[b].x - p[a].x) * (q.y - p[a].y) - (p[b].y - p[a].y) * (q.x - p[a].x);
        left += (side >= 0) != swapped ? 1 : 0;
      }
      if (left != 0 && left != 3) continue;
      const double z = p[0].z - (normal.x * (q.x - p[0].x) + normal.y * (q.y - p[0].y)) / normal.z;
      fn(i, j, std::clamp(z, lowest, highest), left == 3 ? -1 : 1);
    }
  }
}

// +1 inside, -1 outside, by the winding number along z.
std::vector<signed char> Signs(const TriangleMesh& surface, const Lattice& lattice) {
  std::vector<signed char> signs(lattice.size(), -1);
  for (int kind = 0; kind < 2; ++kind) {
    const int nx = lattice.cells(0) + 1 - kind, ny = lattice.cells(1) + 1 - kind;
    const int nz = lattice.cells(2) + 1 - kind;
    std::vector<std::vector<std::pair<double, int>>> crossings(static_cast<std::size_t>(nx) * ny);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      ForEachLineThrough(surface, t, lattice, kind, [&](int i, int j, double z, int winding) {
        crossings[static_cast<std::size_t>(j) * nx + i].emplace_back(z, winding);
      });
    }
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        auto& line = crossings[static_cast<std::size_t>(j) * nx + i];
        std::sort(line.begin(), line.end());
        const double z0 = lattice.LineStart(kind, i, j).z;
        int winding = 0;  // counted -1 where the line leaves by an upward face
        std::size_t next = 0;
        for (int k = 0; k < nz; ++k) {
          const double z = z0 + k * lattice.cell();
          for (; next < line.size() && line[next].first < z; ++next) winding += line[next].second;
          if (winding > 0) signs[lattice.Point(kind, i, j, k)] = 1;
        }
      }
    }
  }
  return signs;
}

class Stuffing {
 public:
  Stuffing(const TriangleTree& surface, double cell)
      : surface_(surface), lattice_(surface.surface(), cell) {}

  TetraMesh Run() {
    sign_ = Signs(surface_.surface(), lattice_);
    position_.resize(lattice_.size());
    for (int kind = 0; kind < 2; ++kind) {
      for (int k = 0; k < lattice_.cells(2) + 1 - kind; ++k) {
        for (int j = 0; j < lattice_.cells(1) + 1 - kind; ++j) {
          for (int i = 0; i < lattice_.cells(0) + 1 - kind; ++i) {
            position_[lattice_.Point(kind, i, j, k)] =
                lattice_.LineStart(kind, i, j) + Vec3d{0, 0, k * cell()};
          }
        }
      }
    }
    ForEachTetra([this](const std::array<std::uint32_t, 4>& t) { FindCuts(t); });
    Snap();
    name_.assign(lattice_.size(), kUnnamed);
    ForEachTetra([this](const std::array<std::uint32_t, 4>& t) { Trim(t); });
    return std::move(result_);
  }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;  // smaller point first
  struct Cut {
    Vec3d point;
    double from_first = 0;          // [m], to the edge's first point
    std::uint32_t name = kUnnamed;  // vertex of the result
  };
  static constexpr std::uint32_t kUnnamed = ~0U;

  double cell() const { return lattice_.cell(); }
  static Edge Sorted(std::uint32_t a, std::uint32_t b) { return a < b ? Edge{a, b} : Edge{b, a}; }

  // Two centres on both sides of a face, and each edge of that face: 4 tetrahedra a face.
  template <typename Function>
  void ForEachTetra(const Function& fn) const {
    constexpr std::array<std::array<int, 2>, 4> kRing = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (int k = 0; k < lattice_.cells(2); ++k) {
      for (int j = 0; j < lattice_.cells(1); ++j) {
        for (int i = 0; i < lattice_.cells(0); ++i) {
          const std::array<int, 3> here{i, j, k};
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if (here[axis] + 1 >= lattice_.cells(static_cast<int>(axis))) continue;
            std::array<int, 3> next = here;
            ++next[axis];
            const std::uint32_t a = lattice_.Centre(here[0], here[1], here[2]);
            const std::uint32_t b = lattice_.Centre(next[0], next[1], next[2]);
            std::array<std::uint32_t, 4> ring;
            for (std::size_t r = 0; r < 4; ++r) {
              std::array<int, 3> corner = next;
              corner[(axis + 1) % 3] += kRing[r][0];
              corner[(axis + 2) % 3] += kRing[r][1];
              ring[r] = lattice_.Corner(corner[0], corner[1], corner[2]);
            }
            for (std::size_t r = 0; r < 4; ++r) fn({a, b, ring[r], ring[(r + 1) % 4]});
          }
        }
      }
    }
  }

  void FindCuts(const std::array<std::uint32_t, 4>& t) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        if (sign_[t[a]] == sign_[t[b]]) continue;
        const auto [entry, fresh] = cuts_.try_emplace(Sorted(t[a], t[b]));
        if (!fresh) continue;
        const Vec3d& out = position_[sign_[t[a]] < 0 ? t[a] : t[b]];
        const Vec3d& in = position_[sign_[t[a]] < 0 ? t[b] : t[a]];
        // Seen from outside the first crossing is one into the shape. Round-off may hide it.
        const double s = surface_.FirstHit(out, in).value_or(0.5);
        entry->second.point = out + s * (in - out);
        entry->second.from_first = Norm(entry->second.point - position_[entry->first.first]);
      }
    }
  }

  // Points of the lattice go to the nearest crossing that is too near to keep both.
  void Snap() {
    struct Pull {
      double distance;
      Vec3d point;
    };
    std::map<std::uint32_t, Pull> pulls;
    for (const auto& [edge, cut] : cuts_) {
      const double length = Norm(position_[edge.second] - position_[edge.first]);
      const double reach =
          (lattice_.IsLong(edge.first, edge.second) ? kSnapLong : kSnapShort) * length;
      for (const bool second : {false, true}) {
        const double distance = second ? length - cut.from_first : cut.from_first;
        if (distance > reach) continue;
        const auto [pull, fresh] =
            pulls.try_emplace(second ? edge.second : edge.first, Pull{distance, cut.point});
        if (!fresh && distance < pull->second.distance) pull->second = {distance, cut.point};
      }
    }
    for (const auto& [point, pull] : pulls) {
      position_[point] = pull.point;
      sign_[point] = 0;
    }
  }

  std::uint32_t Name(std::uint32_t point) {
    if (name_[point] == kUnnamed) {
      name_[point] = static_cast<std::uint32_t>(result_.vertices.size());
      result_.vertices.push_back(position_[point]);
    }
    return name_[point];
  }
  std::uint32_t NameOfCut(std::uint32_t a, std::uint32_t b) {
    Cut& cut = cuts_.at(Sorted(a, b));
    if (cut.name == kUnnamed) {
      cut.name = static_cast<std::uint32_t>(result_.vertices.size());
      result_.vertices.push_back(cut.point);
    }
    return cut.name;
  }
  // How much of the edge from `out` to `in` sticks out; the order in which diagonals are chosen.
  std::pair<double, std::uint32_t> CutOff(std::uint32_t out, std::uint32_t in) const {
    const Edge edge = Sorted(out, in);
    const Cut& cut = cuts_.at(edge);
    return {edge.first == out ? cut.from_first : Norm(cut.point - position_[out]), in};
  }

  void Add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    Tetra t{result_.vertices[a], result_.vertices[b], result_.vertices[c], result_.vertices[d]};
    const double volume = Volume(t);
    if (volume < 0) std::swap(c, d);
    result_.tetrahedra.push_back({a, b, c, d});
  }

  // The pyramid over quadrilateral (p, q, q', p'), of which p', q' are cuts of edges from `out`.
  void AddPyramid(std::uint32_t out, std::uint32_t p, std::uint32_t q, std::uint32_t apex) {
    if (CutOff(out, p) < CutOff(out, q)) std::swap(p, q);  // the diagonal ends in the cut on p
    const std::uint32_t cut_p = NameOfCut(out, p), cut_q = NameOfCut(out, q);
    Add(Name(p), Name(q), cut_p, apex);
    Add(Name(q), cut_q, cut_p, apex);
  }

  void Trim(const std::array<std::uint32_t, 4>& t) {
    std::vector<std::uint32_t> in, on, out;
    for (const std::uint32_t p : t) (sign_[p] > 0 ? in : sign_[p] < 0 ? out : on).push_back(p);
    if (in.empty()) return;
    if (out.empty()) return Add(Name(t[0]), Name(t[1]), Name(t[2]), Name(t[3]));
    if (in.size() == 1) {
      std::vector<std::uint32_t> corners{Name(in[0])};
      for (const std::uint32_t p : on) corners.push_back(Name(p));
      for (const std::uint32_t p : out) corners.push_back(NameOfCut(p, in[0]));
      return Add(corners[0], corners[1], corners[2], corners[3]);
    }
    if (in.size() == 2 && on.size() == 1) return AddPyramid(out[0], in[0], in[1], Name(on[0]));
    if (in.size() == 2) return TrimTwo(in, out);
    // Three inside: the frustum below the triangle of cuts, from its longest cut edge down.
    std::sort(in.begin(), in.end(), [&](std::uint32_t a, std::uint32_t b) {
      return CutOff(out[0], a) > CutOff(out[0], b);
    });
    const std::uint32_t top = NameOfCut(out[0], in[0]);
    Add(Name(in[0]), Name(in[1]), Name(in[2]), top);
    AddPyramid(out[0], in[1], in[2], top);
  }

  // The wedge with edge (in0, in1): both its quadrilaterals are split by the rule; the one of four
  // cuts is this tetrahedron's own, and is split so that the three pieces fit.
  void TrimTwo(const std::vector<std::uint32_t>& in, const std::vector<std::uint32_t>& out) {
    const auto ends_in = [&](std::size_t o) {
      return CutOff(out[o], in[0]) < CutOff(out[o], in[1]) ? 1U : 0U;
    };
    const std::uint32_t p = in[ends_in(0)], q = in[1 - ends_in(0)];
    const std::uint32_t p0 = NameOfCut(out[0], p), q0 = NameOfCut(out[0], q);
    const std::uint32_t p1 = NameOfCut(out[1], p), q1 = NameOfCut(out[1], q);
    if (ends_in(0) == ends_in(1)) {  // both diagonals from q, ending at p0 and p1
      Add(Name(p), Name(q), p0, p1);
      AddSplit(Name(q), {p0, p1, q1, q0});
    } else {  // diagonals q-p0 and p-q1: the tetrahedron of the two diagonals, and what is left
      Add(Name(p), Name(q), p0, q1);
      Add(Name(p), p0, p1, q1);
      Add(Name(q), p0, q0, q1);
    }
  }
  // A pyramid whose base's diagonal is free: the shorter one.
  void AddSplit(std::uint32_t apex, const std::array<std::uint32_t, 4>& base) {
    const auto& v = result_.vertices;
    const bool even = SquaredNorm(v[base[2]] - v[base[0]]) <= SquaredNorm(v[base[3]] - v[base[1]]);
    const std::size_t s = even ? 0 : 1;
    Add(apex, base[s], base[s + 1], base[s + 2]);
    Add(apex, base[s], base[s + 2], base[(s + 3) % 4]);
  }

  const TriangleTree& surface_;
  Lattice lattice_;
  std::vector<signed char> sign_;
  std::vector<Vec3d> position_;
  std::map<Edge, Cut> cuts_;
  std::vector<std::uint32_t> name_;
  TetraMesh result_;
};

}  // namespace

TetraMesh FillWithLattice(const TriangleTree& surface, double cell) {
  Check(cell > 0, "a lattice needs a positive cell");
  return Stuffing(surface, cell).Run();
}

}  // namespace flocklift
