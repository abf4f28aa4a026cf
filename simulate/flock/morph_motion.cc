// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/flock/morph_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulate/fields/distance_field.h"
#include "simulate/shapes/morph_order.h"
#include "simulate/shapes/spline_path.h"
#include "simulate/shapes/subdivide.h"
#include "simulate/shapes/tetrahedralize.h"

namespace flocklift {
namespace {

constexpr double kKeyPointsPerLength = 200;  // of the whole path
constexpr double kObstacleCells = 96;        // along the longest side of their bounding box
constexpr double kRoomAboutObstacles = 0.1;  // of that side, beside their range

// `name` is what the species' `setting` says.
std::vector<Tetra> Filled(const MotionContext& context, const std::string& name,
                          const std::string& setting, std::size_t count) {
  for (const ShapeInTime& shape : context.world->shapes) {
    if (shape.name != name) continue;
    return shape.filling.size() == count ? shape.filling : FillWith(shape.meshes.front(), count);
  }
  RefuseModel(context, "the model morph of the species " + context.species + " has no " + setting,
              "name a [[shape]]: " + setting + " = \"NAME\"");
}

// C_S or C_T: of the volume.
Vec3d CentroidOf(const std::vector<Tetra>& solid) {
  Vec3d sum;
  double volume = 0;
  for (const Tetra& t : solid) {
    sum += Volume(t) * Centroid(t);
    volume += Volume(t);
  }
  return sum / volume;
}

std::vector<Vec3d> KeyPoints(const World& world, const std::string& path, const Vec3d& from,
                             const Vec3d& to) {
  std::vector<Vec3d> control{from};
  for (const PathSpec& spec : world.paths) {
    if (spec.name == path) control.insert(control.end(), spec.points.begin(), spec.points.end());
  }
  control.push_back(to);
  if (control.size() == 2) control.insert(control.begin() + 1, 0.5 * (from + to));
  const SplinePath spline(control, false);
  std::vector<Vec3d> points;
  for (int k = 0; k <= kKeyPointsPerLength; ++k) {
    points.push_back(spline.Position(spline.length() * k / kKeyPointsPerLength));
  }
  return points;
}

ScalarField ObstacleDistances(const World& world, double range, int threads) {
  if (world.obstacles.empty() || range == 0) return {};
  std::vector<Solid> solids;
  for (const Obstacle& obstacle : world.obstacles) solids.push_back(obstacle.solid);
  Block box = Bounds(solids.front());
  for (const Solid& solid : solids) {
    const Block b = Bounds(solid);
    box.low = {std::min(box.low.x, b.low.x), std::min(box.low.y, b.low.y),
               std::min(box.low.z, b.low.z)};
    box.high = {std::max(box.high.x, b.high.x), std::max(box.high.y, b.high.y),
                std::max(box.high.z, b.high.z)};
  }
  const Vec3d size = box.high - box.low;
  const double longest = std::max({size.x, size.y, size.z});
  const double room = range + kRoomAboutObstacles * longest;
  const Vec3d grown{room, room, room};
  return DistanceField(GridOver(box.low - grown, box.high + grown, longest / kObstacleCells),
                       solids, threads);
}

MorphOptions OptionsOf(const MorphParameters& p, const World& world, const std::string& path) {
  MorphOptions o;
  o.speed0 = p.speed0;
  o.omega1 = p.omega1;
  o.omega2 = p.omega2;
  o.departure_time = p.departure_time;
  for (const PathSpec& spec : world.paths) {
    if (spec.name == path) o.width = spec.width;
  }
  o.pull = p.pull;
  o.d_min = p.d_min;
  o.space_near_target = o.avoid_near_target = p.near_target.name() == "avoid";
  o.style = static_cast<MorphStyle>(p.style.index);
  o.gain = p.gain;
  o.scale = p.scale;
  o.wind_speed = p.wind_speed;
  if (Norm(world.wind.velocity) > 0) o.wind = world.wind.velocity;
  o.wind_time = p.wind_time;
  o.gravity = p.gravity;
  o.fall_speed = p.fall_speed;
  if (p.k_a > 0) o.k_a = p.k_a;
  o.region = static_cast<RegionKind>(p.region.index);
  o.margin = p.margin;
  o.shrink = p.shrink;
  o.shrink_time = p.shrink_time;
  o.morph_share = p.morph_share;
  o.kind = static_cast<MorphKind>(p.interpolation.index);
  return o;
}

template <typename T>
class MorphMotion final : public Motion<T> {
 public:
  MorphMotion(const MorphParameters& p, const MotionContext& context, Herd<T>* herd)
      : start_(p.start_time),
        world_(*context.world),
        path_(context.path),
        morph_(PrepareMorph(p, context, herd->size())) {
    morph_.CopyStates(0, morph_.size(), &herd->now);
  }

  void Step(const Surroundings& around, ThreadPool* pool, Herd<T>* herd) override {
    if (around.time + 0.5 * around.dt() < start_ || morph_.Done()) {
      morph_.Rest();
      return;
    }
    const std::size_t first = morph_.FirstInFlight();  // those that arrive now included
    morph_.Step(pool);
    // Tetrahedra are numbered by rank, and the herd keeps that order. Each thread copies what it
    // has moved.
    pool->For(static_cast<std::int64_t>(first - first % 16),
              static_cast<std::int64_t>(morph_.EndInFlight()), FlockMorph::kGrain,
              [&](std::int64_t begin, std::int64_t end) {
                morph_.CopyStates(std::max(first, static_cast<std::size_t>(begin)),
                                  static_cast<std::size_t>(end), &herd->now);
              });
  }

  bool HasNeighbours() const override { return false; }

  void Retune(const ModelParameters& parameters) override {
    morph_.Retune(OptionsOf(std::get<MorphParameters>(parameters), world_, path_));
  }

  void Save(StateWriter* out) const override { morph_.Save(out); }
  void Load(StateReader* in) override { morph_.Load(in); }

  std::int64_t touched() const override { return morph_.touched(); }

  void AppendCorners(ThreadPool* pool, std::vector<Vec3<float>>* corners) override {
    morph_.UpdateVertices(pool);
    corners->reserve(corners->size() + 4 * morph_.size());
    for (std::size_t k = 0; k < morph_.size(); ++k) {
      for (int c = 0; c < 4; ++c) corners->push_back(morph_.Vertex(k, c));
    }
  }

 private:
  double start_;
  const World& world_;
  std::string path_;
  FlockMorph morph_;
};

}  // namespace

std::vector<Tetra> FillWith(const TriangleMesh& mesh, std::size_t count) {
  const TetraMesh solid = Tetrahedralize(mesh, {.most_tetrahedra = static_cast<int>(count)});
  return SubdivideTo(count, Separate(solid));
}

MorphScene PrepareMorph(const MorphParameters& p, const MotionContext& context, std::size_t count) {
  const World& world = *context.world;
  if (context.forces != nullptr && !context.forces->empty()) {
    RefuseModel(context, "the model morph sets velocities and takes no [[species.force]]",
                "take the forces out");
  }
  MorphScene scene;
  scene.from = Filled(context, context.start_shape, "start", count);
  scene.to = Filled(context, context.shape, "shape", count);
  scene.path = KeyPoints(world, context.path, CentroidOf(scene.from), CentroidOf(scene.to));
  scene.obstacles = ObstacleDistances(world, p.k_a, context.pool->threads());
  scene.options = OptionsOf(p, world, context.path);
  scene.seed = world.seed;
  scene.dt = world.dt;

  std::vector<Vec3d> centroids;
  for (const Tetra& t : scene.from) centroids.push_back(Centroid(t));
  std::vector<Tetra> by_rank;
  for (const std::uint32_t k : DepartureOrder(scene.path, centroids)) {
    by_rank.push_back(scene.from[k]);
  }
  scene.from = std::move(by_rank);
  return scene;
}

template <typename T>
std::unique_ptr<Motion<T>> MakeMorphMotion(const MorphParameters& parameters,
                                           const MotionContext& context, Herd<T>* herd) {
  return std::make_unique<MorphMotion<T>>(parameters, context, herd);
}

template std::unique_ptr<Motion<float>> MakeMorphMotion(const MorphParameters&,
                                                        const MotionContext&, Herd<float>*);
template std::unique_ptr<Motion<double>> MakeMorphMotion(const MorphParameters&,
                                                         const MotionContext&, Herd<double>*);

}  // namespace flocklift
