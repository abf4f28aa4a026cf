// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/shapes/creases.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "simulate/shapes/feature_lines.h"
#include "simulate/shapes/tetra_complex.h"

namespace flocklift {
namespace {

constexpr double kCornerReach = 0.7;   // of a cell: a boundary vertex so near moves to a corner
constexpr double kCreaseReach = 0.35;  // likewise to a crease
constexpr int kSplitRounds = 4;
constexpr double kLeastStep = 0.1;  // of a smoothing move, before it is given up

using Patches = std::vector<std::uint32_t>;  // ascending

Patches Common(const Patches& a, const Patches& b) {
  Patches both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

// What a vertex belongs to: one patch (free on it), two (a crease), more (a corner); none: inside.
struct Place {
  Patches patches;
  bool corner = false;

  bool inside() const { return patches.empty(); }
  bool crease() const { return !corner && patches.size() == 2; }
};

class Restorer {
 public:
  Restorer(const TriangleTree& surface, double cell, const CreaseOptions& options, TetraMesh mesh)
      : surface_(surface),
        cell_(cell),
        options_(options),
        lines_(FindFeatureLines(surface.surface(), options.crease_angle)),
        mesh_(std::move(mesh)),
        place_(mesh_.vertices().size()) {}

  TetraMesh Run() {
    for (const auto& face : mesh_.BoundaryFaces().triangles) {
      for (const std::uint32_t v : face) {
        if (place_[v].inside()) place_[v].patches = {PatchAt(At(v))};
      }
    }
    ClaimCorners();
    ClaimCreases();
    for (int round = 0; round < kSplitRounds; ++round) {
      const bool edges = SplitEdges(), faces = SplitFaces();
      if (!edges && !faces) break;
    }
    for (int pass = 0; pass < options_.smoothing_passes; ++pass) Smooth();
    CollapseBad();
    for (int pass = 0; pass < options_.smoothing_passes; ++pass) Smooth();
    CollapseBad();
    return mesh_.Finish();
  }

 private:
  const Vec3d& At(std::uint32_t v) const { return mesh_.vertices()[v]; }
  std::uint32_t PatchAt(const Vec3d& p) const {
    return lines_.patch_of_triangle[surface_.NearestPoint(p).triangle];
  }

  // Moves v if no tetrahedron around it ends below `least`.
  bool TryMove(std::uint32_t v, const Vec3d& to, double least) {
    const Vec3d from = At(v);
    mesh_.Move(v, to);
    if (mesh_.WorstQualityAt(v) >= least) return true;
    mesh_.Move(v, from);
    return false;
  }

  void ClaimCorners() {
    for (const FeatureLines::Corner& corner : lines_.corners) {
      std::uint32_t best = 0;
      double nearest = kCornerReach * cell_;
      bool found = false;
      for (std::uint32_t v = 0; v < place_.size(); ++v) {
        if (place_[v].inside() || place_[v].corner) continue;
        const double distance = Norm(At(v) - corner.point);
        if (distance >= nearest) continue;
        found = true;
        nearest = distance;
        best = v;
      }
      if (found && TryMove(best, corner.point, options_.least_quality)) {
        place_[best] = {corner.patches, true};
      }
    }
  }

  // The point of the creases (between these patches, if given) that is nearest to p.
  struct OnCrease {
    Vec3d point;
    Patches patches;
    double distance;
  };
  OnCrease NearestOnCrease(const Vec3d& p, const Patches* between) const {
    OnCrease best{{}, {}, std::numeric_limits<double>::infinity()};
    for (const FeatureLines::Segment& segment : lines_.segments) {
      if (between != nullptr && !std::equal(between->begin(), between->end(),
                                            segment.patches.begin(), segment.patches.end())) {
        continue;
      }
      const Vec3d point = NearestOnSegment(p, segment.from, segment.to);
      const double distance = Norm(point - p);
      if (distance < best.distance) {
        best = {point, {segment.patches.begin(), segment.patches.end()}, distance};
      }
    }
    return best;
  }

  void ClaimCreases() {
    for (std::uint32_t v = 0; v < place_.size(); ++v) {
      if (place_[v].patches.size() != 1 || place_[v].corner) continue;
      const OnCrease crease = NearestOnCrease(At(v), nullptr);
      if (crease.distance > kCreaseReach * cell_ || crease.patches[0] == crease.patches[1])
        continue;
      if (TryMove(v, crease.point, options_.least_quality)) place_[v] = {crease.patches, false};
    }
  }

  // Puts the fresh vertex v as far towards `to` as the tetrahedra around it allow.
  bool PutNear(std::uint32_t v, const Vec3d& to) {
    const Vec3d from = At(v);
    for (double share = 1; share > kLeastStep; share /= 2) {
      if (TryMove(v, from + share * (to - from), options_.least_quality / 2)) return share == 1;
    }
    return false;
  }

  bool SplitEdges() {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& face : mesh_.BoundaryFaces().triangles) {
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t a = face[e], b = face[(e + 1) % 3];
        if (Common(place_[a].patches, place_[b].patches).empty()) edges.insert(std::minmax(a, b));
      }
    }
    bool any = false;
    for (const auto& [a, b] : edges) {
      const Vec3d middle = 0.5 * (At(a) + At(b));
      OnCrease best{{}, {}, cell_};
      for (const std::uint32_t p : place_[a].patches) {
        for (const std::uint32_t q : place_[b].patches) {
          const Patches both{std::min(p, q), std::max(p, q)};
          OnCrease crease = NearestOnCrease(middle, &both);
          if (crease.distance < best.distance) best = std::move(crease);
        }
      }
      if (best.patches.empty()) continue;  // two parts that only come near each other
      any = true;
      const std::uint32_t v = mesh_.SplitEdge(a, b);
      place_.push_back({best.patches, false});
      if (!PutNear(v, best.point)) place_[v].patches = {PatchAt(At(v))};
    }
    return any;
  }

  bool SplitFaces() {
    bool any = false;
    for (const auto& face : mesh_.BoundaryFaces().triangles) {
      const Place &a = place_[face[0]], &b = place_[face[1]], &c = place_[face[2]];
      const Patches ab = Common(a.patches, b.patches), bc = Common(b.patches, c.patches);
      const Patches ca = Common(c.patches, a.patches);
      if (ab.empty() || bc.empty() || ca.empty() || !Common(ab, c.patches).empty()) continue;
      const Vec3d middle = (At(face[0]) + At(face[1]) + At(face[2])) / 3.0;
      const FeatureLines::Corner* best = nullptr;
      double nearest = cell_;
      for (const FeatureLines::Corner& corner : lines_.corners) {
        const double distance = Norm(corner.point - middle);
        if (distance >= nearest || Common(corner.patches, ab).empty() ||
            Common(corner.patches, bc).empty() || Common(corner.patches, ca).empty()) {
          continue;
        }
        nearest = distance;
        best = &corner;
      }
      if (best == nullptr) continue;
      any = true;
      const std::uint32_t v = mesh_.SplitBoundaryFace(face);
      place_.push_back({best->patches, true});
      if (!PutNear(v, best->point)) place_[v] = {{PatchAt(At(v))}, false};
    }
    return any;
  }
  void CollapseBad() {
    for (std::uint32_t t = 0; t < mesh_.slots(); ++t) {
      if (!mesh_.Alive(t) || ShapeQuality(mesh_.Corners(t)) > options_.bad_quality) continue;
      double gain = 0;
      std::pair<std::uint32_t, std::uint32_t> best;
      for (const std::uint32_t u : mesh_.Tetrahedron(t)) {
        for (const std::uint32_t v : mesh_.Tetrahedron(t)) {
          // Only onto a vertex that belongs to all that u belongs to.
          if (u == v || place_[u].corner ||
              Common(place_[u].patches, place_[v].patches) != place_[u].patches) {
            continue;
          }
          const double after = mesh_.WorstAfterCollapse(u, v) - mesh_.WorstQualityAt(u);
          if (after > gain && mesh_.CanCollapse(u, v)) {
            gain = after;
            best = {u, v};
          }
        }
      }
      if (gain > 0) mesh_.Collapse(best.first, best.second);
    }
  }

  void Smooth() {
    std::vector<std::vector<std::uint32_t>> neighbours(mesh_.vertices().size());
    for (std::uint32_t t = 0; t < mesh_.slots(); ++t) {
      if (!mesh_.Alive(t)) continue;
      const auto& corners = mesh_.Tetrahedron(t);
      for (const std::uint32_t v : corners) {
        if (!place_[v].inside()) continue;
        neighbours[v].insert(neighbours[v].end(), corners.begin(), corners.end());
      }
    }
    for (const auto& face : mesh_.BoundaryFaces().triangles) {
      for (const std::uint32_t v : face) {
        for (const std::uint32_t w : face) {
          // Along a patch, or along a crease: neighbours that share all of it.
          if (Common(place_[v].patches, place_[w].patches) == place_[v].patches) {
            neighbours[v].push_back(w);
          }
        }
      }
    }
    for (std::uint32_t v = 0; v < neighbours.size(); ++v) {
      auto& others = neighbours[v];
      std::sort(others.begin(), others.end());
      others.erase(std::unique(others.begin(), others.end()), others.end());
      std::erase(others, v);
      if (others.empty() || place_[v].corner) continue;
      Vec3d mean;
      for (const std::uint32_t w : others) mean += At(w);
      mean = mean / static_cast<double>(others.size());
      const double worst = mesh_.WorstQualityAt(v);
      for (double share = 1; share > kLeastStep; share /= 2) {
        Vec3d to = At(v) + share * (mean - At(v));
        if (place_[v].crease()) {
          to = NearestOnCrease(to, &place_[v].patches).point;
        } else if (!place_[v].inside()) {
          const auto nearest = surface_.NearestPoint(to);
          if (lines_.patch_of_triangle[nearest.triangle] != place_[v].patches[0]) continue;
          to = nearest.point;
        }
        if (TryMove(v, to, worst + 1e-9)) break;
      }
    }
  }

  const TriangleTree& surface_;
  const double cell_;
  const CreaseOptions options_;
  const FeatureLines lines_;
  TetraComplex mesh_;
  std::vector<Place> place_;
};

}  // namespace

TetraMesh RestoreCreases(const TriangleTree& surface, double cell, const CreaseOptions& options,
                         TetraMesh mesh) {
  return Restorer(surface, cell, options, std::move(mesh)).Run();
}

}  // namespace flocklift
