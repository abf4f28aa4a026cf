// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/lattice_fill.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/shapes/body_centred_lattice.h"

namespace flocklift {
namespace {

// How near a crossing pulls a lattice point onto the surface, by the kind of the edge that it lies
// on, as a share of the edge: the authors' values for the uniform lattice with their bounds on the
// dihedral angles.
constexpr double kSnapLong = 0.24999, kSnapShort = 0.41189;

class Stuffing {
 public:
  Stuffing(const TriangleTree& surface, double cell)
      : surface_(surface), lattice_(surface.surface(), cell) {}

  TetraMesh Run() {
    sign_ = SignsOn(lattice_, surface_.surface());
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
  BodyCentredLattice lattice_;
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
