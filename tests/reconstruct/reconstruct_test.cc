// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/reconstruct.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/reconstruct/circling_flock.h"

namespace flocklift {
namespace {

ReconstructOptions TrueKnowledge(const FlockSpec& flock) {
  ReconstructOptions options;
  options.knowledge.speed = Uncertain{flock.speed, 0.1 * flock.speed};
  options.knowledge.wingspan = Uncertain{flock.wingspan, 0.05 * flock.wingspan};
  return options;
}

struct Scores {
  double scale = 1;   // median of true over found depth
  double median = 0;  // of |relative depth error| after that scale
  std::size_t rows = 0;
};

Scores Score(const Trajectories& truth, const Trajectories& found, const Camera& camera) {
  std::vector<double> ratios, errors;
  for (const auto& [key, depths] : PairDepths(truth, found, camera)) {
    ratios.push_back(depths.first / depths.second);
  }
  if (ratios.empty()) return {};
  const auto median = [](std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  Scores scores;
  scores.rows = ratios.size();
  scores.scale = median(ratios);
  for (const double ratio : ratios) errors.push_back(std::abs(scores.scale / ratio - 1));
  scores.median = median(errors);
  return scores;
}

void ExpectFinite(const Trajectories& trajectories) {
  for (const Trajectory& path : trajectories.trajectories) {
    int last = 0;
    for (const TrajectoryPoint& p : path.points) {
      EXPECT_GT(p.frame, last);
      last = p.frame;
      for (const double value :
           {p.position.x, p.position.y, p.position.z, p.velocity.x, p.velocity.y, p.velocity.z,
            p.world_from_body.w, p.world_from_body.x, p.world_from_body.y, p.world_from_body.z,
            p.sd_depth}) {
        EXPECT_TRUE(std::isfinite(value)) << path.id << " " << p.frame;
      }
    }
  }
}

std::size_t Rows(const Tracks& tracks) {
  std::size_t rows = 0;
  for (const Tracklet& t : tracks.tracklets) rows += t.detections.size();
  return rows;
}

class Twin : public testing::Test {
 protected:
  FlockSpec flock_;
  Camera camera_ = WatchingCamera();
  Trajectories truth_ = CirclingFlock(flock_);
  Tracks tracks_ = Observe(flock_, {}, truth_, camera_);
};

TEST_F(Twin, DepthsAreFoundWithSize) {
  const auto result = Reconstruct(TrueKnowledge(flock_), tracks_, camera_, flock_.fps, 1, {});
  const Scores scores = Score(truth_, result.trajectories, camera_);
  EXPECT_EQ(scores.rows, Rows(tracks_));
  EXPECT_LT(scores.median, 0.03);
  EXPECT_NEAR(scores.scale, 1, 0.12);
  EXPECT_TRUE(result.report.IsUsable());
  EXPECT_TRUE(result.report.converged);
  EXPECT_EQ(result.report.scale_from, "speed, wingspan");
  EXPECT_THAT(result.report.observability, testing::HasSubstr("apparent size"));
  ExpectFinite(result.trajectories);
}

// Balls, not birds: the scale comes out as well when measuring spoils the form of their boxes.
TEST_F(Twin, BoxesThatFollowNoBodyAreFoundOut) {
  for (Tracklet& tracklet : tracks_.tracklets) {
    Rng rng(3, static_cast<std::uint64_t>(tracklet.id));
    for (Detection& d : tracklet.detections) {
      const double width = d.box.width * std::exp(0.08 * rng.Normal());
      const double height = d.box.height * std::exp(0.08 * rng.Normal());
      d.box = Box::Around(d.box.Center(), width, height);
    }
  }
  const auto result = Reconstruct(TrueKnowledge(flock_), tracks_, camera_, flock_.fps, 1, {});
  const Scores scores = Score(truth_, result.trajectories, camera_);
  EXPECT_LT(scores.median, 0.03);
  EXPECT_NEAR(scores.scale, 1, 0.12);
  EXPECT_THAT(result.report.observability, testing::HasSubstr("as large from every side"));
}

TEST_F(Twin, DepthsAreFoundWithoutSize) {
  ReconstructOptions options = TrueKnowledge(flock_);
  options.knowledge.use_size = false;
  const auto result = Reconstruct(options, tracks_, camera_, flock_.fps, 1, {});
  const Scores scores = Score(truth_, result.trajectories, camera_);
  EXPECT_EQ(scores.rows, Rows(tracks_));
  EXPECT_LT(scores.median, 0.05);
  EXPECT_NEAR(scores.scale, 1, 0.1);
}

// Lin's method on the same tracks is far behind: the batch solve has less than half of its error.
TEST_F(Twin, BatchBeatsCobyla) {
  ReconstructOptions options = TrueKnowledge(flock_);
  const auto batch = Reconstruct(options, tracks_, camera_, flock_.fps, 1, {});
  options.method = ReconstructMethod::kCobyla;
  const auto cobyla = Reconstruct(options, tracks_, camera_, flock_.fps, 1, {});
  const Scores scores = Score(truth_, cobyla.trajectories, camera_);
  EXPECT_EQ(scores.rows, Rows(tracks_));
  EXPECT_LT(Score(truth_, batch.trajectories, camera_).median, 0.5 * scores.median);
  EXPECT_FALSE(cobyla.trajectories.has_sd_depth);
  EXPECT_EQ(cobyla.report.scale_sd, 0);
  ExpectFinite(cobyla.trajectories);
}

TEST_F(Twin, ErrorsAreAsLargeAsTheySay) {
  ReconstructOptions options = TrueKnowledge(flock_);
  const auto result = Reconstruct(options, tracks_, camera_, flock_.fps, 1, {});
  const double scale = Score(truth_, result.trajectories, camera_).scale;
  const DepthPairs pairs = PairDepths(truth_, result.trajectories, camera_);
  double inside = 0, count = 0;
  for (const Trajectory& path : result.trajectories.trajectories) {
    for (const TrajectoryPoint& p : path.points) {
      const auto& [true_depth, depth] = pairs.at({path.id, p.frame});
      const double common = result.report.scale_sd * depth;
      EXPECT_GE(p.sd_depth, 0.9 * common);
      EXPECT_LT(p.sd_depth, 0.25 * depth);
      const double own = std::sqrt(std::max(0.0, p.sd_depth * p.sd_depth - common * common));
      inside += std::abs(scale * depth - true_depth) < 2 * own ? 1 : 0;
      count += 1;
    }
  }
  EXPECT_GT(inside / count, 0.75);
}

TEST_F(Twin, VelocityAndHeadingFollowThePath) {
  const auto result = Reconstruct(TrueKnowledge(flock_), tracks_, camera_, flock_.fps, 1, {});
  std::vector<double> angles;
  for (std::size_t i = 0; i < truth_.trajectories.size(); ++i) {
    for (std::size_t k = 5; k + 5 < truth_.trajectories[i].points.size(); k += 10) {
      const TrajectoryPoint& found = result.trajectories.trajectories[i].points[k];
      const Vec3d a = Normalized(truth_.trajectories[i].points[k].velocity);
      const Vec3d b = Normalized(found.velocity);
      angles.push_back(std::acos(std::clamp(Dot(a, b), -1.0, 1.0)));
      const Rotation3d body = RotationFromQuaternion(found.world_from_body);
      EXPECT_LT(Norm(body * Vec3d{1, 0, 0} - b), 1e-9);
      EXPECT_GT((body * Vec3d{0, 0, 1}).z, 0.2);  // nobody flies upside down
    }
  }
  std::sort(angles.begin(), angles.end());
  EXPECT_LT(angles[angles.size() / 2], 0.12);
}

// Anchors alone fix the scale, and well.
TEST_F(Twin, AnchorsFixTheScale) {
  ReconstructOptions options;
  for (const Id id : {1, 4, 7, 9}) {
    const TrajectoryPoint& p = truth_.trajectories[static_cast<std::size_t>(id - 1)].points[40];
    options.knowledge.anchors.push_back({p.frame, id, p.position, 0.3});
  }
  const auto result = Reconstruct(options, tracks_, camera_, flock_.fps, 1, {});
  EXPECT_NEAR(Score(truth_, result.trajectories, camera_).scale, 1, 0.03);
  EXPECT_LT(result.report.scale_sd, 0.03);
  EXPECT_EQ(result.report.scale_from, "anchors");
}

// With bounds alone the flock's middle is at the geometric middle, give or take.
TEST_F(Twin, NearAndFarAloneGiveTheMiddle) {
  ReconstructOptions options;
  options.knowledge.near = 30;
  options.knowledge.far = 90;
  const auto result = Reconstruct(options, tracks_, camera_, flock_.fps, 1, {});
  std::vector<double> depths;
  for (const auto& [key, pair] : PairDepths(truth_, result.trajectories, camera_)) {
    depths.push_back(pair.second);
    EXPECT_GT(pair.second, 28);
    EXPECT_LT(pair.second, 95);
  }
  std::sort(depths.begin(), depths.end());
  EXPECT_NEAR(std::log(depths[depths.size() / 2]), std::log(std::sqrt(30.0 * 90)), 0.12);
  EXPECT_GT(result.report.scale_sd, 0.1);
}

// By how much the stated speed is off what the sizes tell is always said; and warned of where it is
// more than these can be off, however little the speed is trusted.
TEST_F(Twin, DisagreementIsTold) {
  const auto told = [&](double factor, double trust) {
    ReconstructOptions options = TrueKnowledge(flock_);
    options.knowledge.speed = Uncertain{factor * flock_.speed, trust * factor * flock_.speed};
    return Reconstruct(options, tracks_, camera_, flock_.fps, 1, {}).report;
  };
  const double off = told(1, 0.1).speed_by_sizes.value().mean;
  for (const double trust : {0.1, 0.2}) {
    for (const double factor : {1.8, 1.15, 1.0, 0.85, 0.6}) {
      const ReconstructReport report = told(factor, trust);
      ASSERT_TRUE(report.speed_by_sizes.has_value());
      const Uncertain apart = *report.speed_by_sizes;
      EXPECT_NEAR(apart.mean, off - std::log(factor), 0.05) << factor;
      const char* side = apart.mean > 0 ? "faster" : "slower";
      EXPECT_THAT(report.observability, testing::HasSubstr(side));
      const auto warning = testing::AllOf(testing::HasSubstr("disagree"), testing::HasSubstr(side));
      const bool warned = testing::Value(report.warnings, testing::Contains(warning));
      EXPECT_EQ(warned, std::abs(apart.mean) > apart.sd) << factor;
      if (std::abs(std::log(factor)) > 0.5) {
        EXPECT_TRUE(warned);
      }
      if (factor == 1) {
        EXPECT_FALSE(warned);
      }
    }
  }
}

// The world may be turned and moved: the flock turns with it.
TEST_F(Twin, WorldsMayBeTurned) {
  const Rigid3d other_from_world{RotationFromQuaternion({std::cos(0.6), 0, 0, std::sin(0.6)}),
                                 {5, -3, 2}};
  Camera turned = camera_;
  const Rigid3d world_from_other = other_from_world.Inverse();
  const Rotation3d& a = camera_.cam_from_world->rotation;
  const auto column = [&](const Vec3d& axis) { return a * (world_from_other.rotation * axis); };
  turned.cam_from_world = Rigid3d{
      Rotation3d::FromRows(column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})).Inverse(),
      *camera_.cam_from_world * world_from_other.translation};
  const auto one = Reconstruct(TrueKnowledge(flock_), tracks_, camera_, flock_.fps, 1, {});
  const auto two = Reconstruct(TrueKnowledge(flock_), tracks_, turned, flock_.fps, 1, {});
  for (std::size_t i = 0; i < one.trajectories.trajectories.size(); ++i) {
    for (std::size_t k = 0; k < 150; k += 30) {
      const TrajectoryPoint& p = one.trajectories.trajectories[i].points[k];
      const TrajectoryPoint& q = two.trajectories.trajectories[i].points[k];
      EXPECT_LT(Norm(other_from_world * p.position - q.position), 1e-3);
      EXPECT_LT(Norm(other_from_world.rotation * p.velocity - q.velocity), 1e-3);
    }
  }
}

TEST_F(Twin, OrderOfAnimalsDoesNotMatter) {
  Tracks reversed = tracks_;
  for (Tracklet& t : reversed.tracklets) t.id = flock_.count + 1 - t.id;
  std::reverse(reversed.tracklets.begin(), reversed.tracklets.end());
  const auto one = Reconstruct(TrueKnowledge(flock_), tracks_, camera_, flock_.fps, 1, {});
  const auto two = Reconstruct(TrueKnowledge(flock_), reversed, camera_, flock_.fps, 1, {});
  const std::size_t n = one.trajectories.trajectories.size();
  for (std::size_t i = 0; i < n; ++i) {
    const auto& p = one.trajectories.trajectories[i].points[75];
    const auto& q = two.trajectories.trajectories[n - 1 - i].points[75];
    EXPECT_LT(Norm(p.position - q.position), 1e-3);
  }
}

TEST_F(Twin, ThreadsDoNotMatter) {
  const auto one = Reconstruct(TrueKnowledge(flock_), tracks_, camera_, flock_.fps, 1, {});
  const auto four = Reconstruct(TrueKnowledge(flock_), tracks_, camera_, flock_.fps, 4, {});
  ASSERT_EQ(one.trajectories.trajectories.size(), four.trajectories.trajectories.size());
  for (std::size_t i = 0; i < one.trajectories.trajectories.size(); ++i) {
    for (std::size_t k = 0; k < one.trajectories.trajectories[i].points.size(); ++k) {
      const auto& p = one.trajectories.trajectories[i].points[k];
      const auto& q = four.trajectories.trajectories[i].points[k];
      ASSERT_EQ(p.position, q.position);
      ASSERT_EQ(p.velocity, q.velocity);
      ASSERT_EQ(p.sd_depth, q.sd_depth);
    }
  }
}

// Fragments, gaps, interpolated rows, animals that enter and leave, and single rows: every row has
// a depth, and the long tracks stay as good as they were.
TEST_F(Twin, FragmentsEnterAndLeave) {
  Tracks pieces;
  Id next = 1;
  std::vector<std::pair<Id, Id>> owner;  // piece, animal
  for (const Tracklet& t : tracks_.tracklets) {
    const std::size_t cut = 20 + 9 * static_cast<std::size_t>(t.id);
    Tracklet first{next++, {}}, second{next++, {}};
    for (std::size_t k = 0; k < t.detections.size(); ++k) {
      Detection d = t.detections[k];
      if (k % 17 == 3) continue;                  // a miss
      if (k % 17 == 4) d.confidence = 0.3;        // an interpolated row
      if (k + 2 >= cut && k < cut + 1) continue;  // a gap where the tracker lost it
      (k < cut ? first : second).detections.push_back(d);
    }
    owner.push_back({first.id, t.id});
    owner.push_back({second.id, t.id});
    pieces.tracklets.push_back(first);
    pieces.tracklets.push_back(second);
  }
  Tracklet single{next++, {tracks_.tracklets[0].detections[10]}};
  pieces.tracklets.push_back(single);
  owner.push_back({single.id, 1});
  const auto result = Reconstruct(TrueKnowledge(flock_), pieces, camera_, flock_.fps, 1, {});
  ExpectFinite(result.trajectories);
  std::size_t rows = 0;
  Trajectories renamed = result.trajectories;
  for (Trajectory& path : renamed.trajectories) {
    rows += path.points.size();
    for (const auto& [piece, animal] : owner) {
      if (piece == path.id) {
        path.id = animal;
        break;
      }
    }
  }
  EXPECT_EQ(rows, Rows(pieces));
  EXPECT_LT(Score(truth_, renamed, camera_).median, 0.045);
  // The single row is the least certain of all.
  const double least = result.trajectories.trajectories.back().points[0].sd_depth;
  EXPECT_GT(least, result.trajectories.trajectories[0].points[5].sd_depth);
}

// Panned after the flock by hand, walking along and climbing.
Camera CarriedCamera(const FlockSpec& flock) {
  Camera moving = WatchingCamera();
  moving.cam_from_world.reset();
  for (int f = 1; f <= flock.frames; ++f) {
    const double t = (f - 1) / flock.fps;
    const Vec3d shake{0.1 * std::sin(7 * t), 0.2 * std::sin(5 * t), 0.2 * std::cos(9 * t)};
    const Vec3d place{-8 + 3 * t + 0.1 * std::sin(2 * t), -45 - t, 1.7 + 0.4 * t};
    moving.cam_from_world_per_frame.push_back(
        LookAt(place, Vec3d{15 * std::sin(0.8 * t), 0, 15} + shake));
  }
  return moving;
}

// World positions come out as with a camera that stands.
TEST_F(Twin, MovingCameras) {
  const Camera moving = CarriedCamera(flock_);
  const Tracks seen = Observe(flock_, {}, truth_, moving);
  const auto result = Reconstruct(TrueKnowledge(flock_), seen, moving, flock_.fps, 1, {});
  const Scores scores = Score(truth_, result.trajectories, moving);
  EXPECT_EQ(scores.rows, Rows(seen));
  EXPECT_LT(scores.median, 0.03);
  EXPECT_NEAR(scores.scale, 1, 0.1);
  ExpectFinite(result.trajectories);
  std::vector<double> errors;
  for (std::size_t i = 0; i < truth_.trajectories.size(); ++i) {
    for (std::size_t k = 10; k + 10 < truth_.trajectories[i].points.size(); k += 10) {
      errors.push_back(Norm(result.trajectories.trajectories[i].points[k].velocity -
                            truth_.trajectories[i].points[k].velocity));
    }
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.15 * flock_.speed);
}

// A path that is left in a reversal of depth, coming where it goes, has its speed only where all is
// farther away: how fast the camera went then tells a wrong scale.
TEST(Reconstruct, MovingCamerasTellTheScale) {
  double sum = 0;
  constexpr int kFlocks = 3;
  for (int seed = 1; seed <= kFlocks; ++seed) {
    FlockSpec flock;
    flock.seed = static_cast<std::uint64_t>(seed);
    const Trajectories truth = CirclingFlock(flock);
    const Camera moving = CarriedCamera(flock);
    const Tracks seen = Observe(flock, {}, truth, moving);
    const auto result = Reconstruct(TrueKnowledge(flock), seen, moving, flock.fps, 1, {});
    const Scores scores = Score(truth, result.trajectories, moving);
    EXPECT_LT(scores.median, 0.022);
    sum += std::log(scores.scale);
  }
  EXPECT_LT(std::abs(sum / kFlocks), 0.06);
}

// A camera that flies along with a flock sees next to no image motion. Its own is known, and with
// it the flock's; sizes tell the depths, two known positions their scale (the boxes here are
// those of a body that looks the same from all sides).
TEST(Reconstruct, CamerasMayFlyAlong) {
  const FlockSpec flock{.speed_spread = 0.03};
  Trajectories truth = CirclingFlock(flock);  // for its ids and frames
  Camera moving = PinholeCamera(50, 1920, 1080);
  for (int f = 1; f <= flock.frames; ++f) {
    const double t = (f - 1) / flock.fps;
    const Vec3d place{9 * t, -45, 10 + 0.5 * std::sin(t)};
    moving.cam_from_world_per_frame.push_back(LookAt(place, place + Vec3d{0, 1, 0.1}));
    for (Trajectory& path : truth.trajectories) {
      const double i = static_cast<double>(path.id);
      const double speed = flock.speed * (1 + 0.03 * std::sin(5 * i));
      path.points[static_cast<std::size_t>(f - 1)].position = {
          speed * t - 3 + 4 * std::sin(2 * i), 15 * std::sin(3 * i) + 0.5 * std::sin(0.8 * t + i),
          14 + 5 * std::cos(4 * i) + 0.3 * std::sin(1.1 * t - i)};
    }
  }
  ComputeVelocities(flock.fps, &truth);
  const Tracks seen = Observe(flock, {}, truth, moving);
  ReconstructOptions options;
  for (const std::size_t i : {2, 7}) {
    const TrajectoryPoint& p = truth.trajectories[i].points[70];
    options.knowledge.anchors.push_back({p.frame, truth.trajectories[i].id, p.position, 0.3});
  }
  const auto result = Reconstruct(options, seen, moving, flock.fps, 1, {});
  const Scores scores = Score(truth, result.trajectories, moving);
  EXPECT_EQ(scores.rows, Rows(seen));
  EXPECT_LT(scores.median, 0.08);
  // What the best constant depth would leave.
  std::vector<double> depths, off;
  for (const auto& [key, pair] : PairDepths(truth, truth, moving)) depths.push_back(pair.first);
  std::sort(depths.begin(), depths.end());
  for (const double depth : depths) off.push_back(std::abs(depths[depths.size() / 2] / depth - 1));
  std::sort(off.begin(), off.end());
  EXPECT_LT(scores.median, 0.5 * off[off.size() / 2]);
  EXPECT_NEAR(scores.scale, 1, 0.1);
  for (const Trajectory& path : result.trajectories.trajectories) {
    for (std::size_t k = 0; k < path.points.size(); k += 30) {
      EXPECT_NEAR(path.points[k].velocity.x, flock.speed, 0.15 * flock.speed);
    }
  }
}

// Tracks that make no sense still give numbers.
TEST(Reconstruct, NothingIsNaN) {
  const Camera camera = WatchingCamera();
  Rng rng(3);
  Tracks tracks;
  for (Id id = 1; id <= 8; ++id) {
    Tracklet t{id, {}};
    for (int f = 1; f <= 30; f += 1 + static_cast<int>(rng.Below(5))) {
      Detection d;
      d.frame = f;
      // Jumps all over the picture; then standing still in one place; then huge and tiny boxes.
      const Vec2d pixel =
          id < 4 ? Vec2d{rng.Uniform(0, 1920), rng.Uniform(0, 1080)} : Vec2d{900, 500};
      const double size = id > 6 ? std::exp(6 * rng.Normal()) : 10;
      d.box = Box::Around(pixel, size, size);
      d.confidence = rng.Uniform();
      t.detections.push_back(d);
    }
    tracks.tracklets.push_back(t);
  }
  ReconstructOptions options;
  options.knowledge.speed = Uncertain{10, 1};
  options.knowledge.wingspan = Uncertain{0.6, 0.03};
  for (const ReconstructMethod method : {ReconstructMethod::kBatch, ReconstructMethod::kCobyla}) {
    for (const bool size : {true, false}) {
      for (const double fps : {1.0, 30.0, 1000.0}) {
        options.method = method;
        options.knowledge.use_size = size;
        const auto result = Reconstruct(options, tracks, camera, fps, 1, {});
        ExpectFinite(result.trajectories);
        std::size_t rows = 0;
        for (const Trajectory& path : result.trajectories.trajectories) rows += path.points.size();
        EXPECT_EQ(rows, Rows(tracks));
      }
    }
  }
}

TEST(Reconstruct, NoTracksAreNoFault) {
  ReconstructOptions options;
  options.knowledge.speed = Uncertain{10, 1};
  const auto result = Reconstruct(options, {}, WatchingCamera(), 30, 1, {});
  EXPECT_TRUE(result.trajectories.trajectories.empty());
  EXPECT_FALSE(result.report.IsUsable());
}

TEST(Reconstruct, GravityIsNotUsedWhereUnknown) {
  const FlockSpec flock{.count = 3, .frames = 30};
  Camera camera = WatchingCamera();
  const Tracks tracks = Observe(flock, {}, CirclingFlock(flock), camera);
  camera.cam_from_world.reset();
  ReconstructOptions options = TrueKnowledge(flock);
  const auto has_level = [](const ReconstructReport& report) {
    return std::any_of(report.terms.begin(), report.terms.end(),
                       [](const TermStatistics& t) { return t.name == "level flight"; });
  };
  EXPECT_FALSE(has_level(Reconstruct(options, tracks, camera, 30, 1, {}).report));
  options.pitch_deg = 15;
  EXPECT_TRUE(has_level(Reconstruct(options, tracks, camera, 30, 1, {}).report));
}

TEST(Reconstruct, BadInputIsRefused) {
  EXPECT_THROW(Reconstruct({}, {}, WatchingCamera(), 30, 1, {}), std::invalid_argument);
  ReconstructOptions options;
  options.knowledge.speed = Uncertain{10, 1};
  EXPECT_THROW(Reconstruct(options, {}, WatchingCamera(), 0, 1, {}), std::invalid_argument);
  options.batch.speed_sd = -1;
  EXPECT_THROW(Reconstruct(options, {}, WatchingCamera(), 30, 1, {}), std::invalid_argument);
  options.batch = {};
  options.knowledge.anchors = {{1, 1, {0, -100, 1}, 1}};
  EXPECT_THROW(Reconstruct(options, {}, WatchingCamera(), 30, 1, {}), std::invalid_argument);
}

}  // namespace
}  // namespace flocklift
