// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/round_trip_scores.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "reconstruct/metrics/flock_statistics.h"
#include "reconstruct/metrics/matched_points.h"
#include "simulate/camera/projection.h"
#include "simulate/core/check.h"
#include "tools/error_shares.h"

namespace flocklift {
namespace {

constexpr double kTail = 0.5;       // that a second film goes on for, so that its tracks do [s]
constexpr double kFilmGatePx = 15;  // farther from an animal, what a second film shows is another

using Places = std::unordered_map<Id, Vec3d>;

Places PlacesAt(const Trajectories& flock, int frame) {
  const FlockState state = StateAtFrame(flock, frame);
  Places places;
  for (std::size_t k = 0; k < state.size(); ++k) places.emplace(state.id[k], state.position[k]);
  return places;
}

// Where the chain's own id of each true animal is at a start; by true id.
std::map<int, std::map<Id, Id>> OwnIds(const RoundTripLeg& leg, const Camera& camera,
                                       const Trajectories& truth, const std::vector<int>& starts) {
  std::map<int, std::map<Id, Id>> own;
  const MatchedTrajectories matched =
      MatchTrajectories({.by_image = !leg.has_true_ids}, camera, truth, leg.paths);
  for (const int start : starts) own[start];
  for (const MatchedPoint& point : matched.points) {
    const auto found = own.find(point.frame);
    if (found != own.end()) found->second[point.truth_id] = point.result_id;
  }
  return own;
}

double RelativeDifference(std::optional<double> a, std::optional<double> b) {
  if (!a || !b || !(*b > 0)) return std::nan("");
  return std::abs(*a / *b - 1);
}

FlockStatistics StatisticsAt(const Trajectories& flock, int frame) {
  Trajectories moment = flock;
  for (Trajectory& path : moment.trajectories) {
    std::erase_if(path.points, [frame](const TrajectoryPoint& p) { return p.frame != frame; });
  }
  const std::vector<FlockStatistics> statistics = ComputeFlockStatistics(StatesByFrame(moment));
  return statistics.empty() ? FlockStatistics{} : statistics.front();
}

// What the picture can tell apart; an animal behind the camera is as wrong as can be.
class Picture {
 public:
  explicit Picture(const Camera& camera)
      : camera_(camera), diagonal_(std::hypot(camera.width, camera.height)) {}

  bool Sees(int frame, const Vec3d& point) const {
    return ProjectVisible(camera_, camera_.CamFromWorld(frame) * point).has_value();
  }
  Vec2d PointOf(int frame, const Vec3d& point) const {
    return Project(camera_.intrinsics, camera_.CamFromWorld(frame) * point);
  }
  double SquaredError(int frame, const Vec3d& truth, const Vec3d& result) const {
    if (!((camera_.CamFromWorld(frame) * result).z > 0)) return diagonal_ * diagonal_;
    const Vec2d a = PointOf(frame, truth), b = PointOf(frame, result);
    const double square = (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
    return std::min(square, diagonal_ * diagonal_);
  }

 private:
  const Camera& camera_;
  double diagonal_;
};

Trajectories FromFrameOne(Trajectories flock, int first) {
  for (Trajectory& path : flock.trajectories) {
    for (TrajectoryPoint& point : path.points) point.frame -= first - 1;
  }
  return flock;
}

// Distance of what the second film shows from where its animals are, in one frame. What is seen
// belongs to the animal that is nearest to it.
struct FilmError {
  double squared = 0;
  int seen = 0;
};
FilmError ErrorOfFilm(const Tracks& tracks, int frame_of_film, const Picture& picture, int frame,
                      const Places& flown, const std::vector<Id>& ids) {
  std::vector<std::pair<Id, Vec2d>> there;
  for (const auto& [id, place] : flown) {
    if (picture.Sees(frame, place)) there.emplace_back(id, picture.PointOf(frame, place));
  }
  std::unordered_map<Id, double> squares;
  for (const Tracklet& tracklet : tracks.tracklets) {
    for (const Detection& d : tracklet.detections) {
      if (d.frame != frame_of_film) continue;
      const Vec2d seen = d.box.Center();
      Id nearest = kNoId;
      double square = kFilmGatePx * kFilmGatePx;
      for (const auto& [id, point] : there) {
        const double du = point.x - seen.x, dv = point.y - seen.y;
        if (!(du * du + dv * dv < square)) continue;
        square = du * du + dv * dv;
        nearest = id;
      }
      if (nearest == kNoId) continue;
      const auto [known, is_new] = squares.emplace(nearest, square);
      if (!is_new) known->second = std::min(known->second, square);
    }
  }
  FilmError error;
  for (const Id id : ids) {
    const auto found = squares.find(id);
    if (found == squares.end()) continue;
    error.squared += found->second;
    ++error.seen;
  }
  return error;
}

double Sum(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

// The moments that replays start from, evenly over the film.
std::vector<int> StartFrames(const FrameSpan& span, int ahead, int wanted) {
  const int room = span.last - span.first + 1 - ahead;
  Check(room > 0, "the film is shorter than --lead");
  std::vector<int> starts;
  for (int k = 0; k < wanted; ++k) {
    const int start = span.first + static_cast<int>((k + 0.5) * room / wanted);
    if (starts.empty() || start > starts.back()) starts.push_back(start);
  }
  return starts;
}

class Scorer {
 public:
  Scorer(const ReplayOptions& replay, const Camera& camera, const Trajectories& truth,
         const std::vector<RoundTripLeg>& legs, double fps, std::vector<int> starts, int ahead)
      : replay_(replay),
        truth_(truth),
        legs_(legs),
        fps_(fps),
        starts_(std::move(starts)),
        ahead_(ahead),
        picture_(camera),
        space_(legs.size(), std::vector<double>(starts_.size())),
        image_(space_),
        film_(starts_.size()),
        straight_(starts_.size()),
        straight_image_(starts_.size()),
        present_(legs.size()),
        flock_(legs.size()),
        flocks_(legs.size()) {
    for (const RoundTripLeg& leg : legs) own_.push_back(OwnIds(leg, camera, truth, starts_));
  }

  RoundTripScores Run(std::uint64_t seed, int threads, const FilmAgain& film_again) {
    for (std::size_t at = 0; at < starts_.size(); ++at) {
      Meet(at);
      if (ids_.empty()) continue;
      for (std::size_t k = 0; k < legs_.size(); ++k) Fly(k, at, seed, threads, film_again);
      FlyStraightOn(at);
    }
    return Summary(film_again != nullptr);
  }

 private:
  // The true animals of a start that are in the picture at both ends and that all legs have.
  void Meet(std::size_t at) {
    const int start = starts_[at];
    const Places before = PlacesAt(truth_, start);
    after_ = PlacesAt(truth_, start + ahead_);
    ids_.clear();
    for (const auto& [id, place] : std::map<Id, Vec3d>(before.begin(), before.end())) {
      if (!picture_.Sees(start, place)) continue;
      ++in_view_;
      bool everywhere = after_.contains(id) && picture_.Sees(start + ahead_, after_.at(id));
      for (std::size_t k = 0; k < legs_.size(); ++k) {
        const bool has = own_[k].at(start).contains(id);
        present_[k] += has ? 1 : 0;
        everywhere = everywhere && has;
      }
      if (everywhere) ids_.push_back(id);
    }
    animals_ += static_cast<int>(ids_.size());
    if (!ids_.empty()) true_flock_ = StatisticsAt(truth_, start + ahead_);
  }

  void Fly(std::size_t k, std::size_t at, std::uint64_t seed, int threads,
           const FilmAgain& film_again) {
    const int start = starts_[at], end = start + ahead_;
    const bool filmed = k == 0 && film_again;
    ReplayOptions options = replay_;
    options.frame = start;
    options.duration = ahead_ / fps_ + (filmed ? kTail : 0);
    const auto fly = [&](bool noiseless) {
      options.noiseless = noiseless;
      return Replay(options, legs_[k].parameters, legs_[k].paths, fps_, seed, threads).replayed;
    };
    AddFlock(k, StatisticsAt(fly(false), end));
    const Trajectories flown = fly(true);
    const Places places = PlacesAt(flown, end);
    for (const Id id : ids_) {
      const Vec3d &place = places.at(own_[k].at(start).at(id)), &there = after_.at(id);
      space_[k][at] += SquaredNorm(place - there);
      image_[k][at] += picture_.SquaredError(end, there, place);
    }
    if (!filmed) return;
    std::vector<Id> own;
    for (const Id id : ids_) own.push_back(own_[0].at(start).at(id));
    const FilmError error =
        ErrorOfFilm(film_again(FromFrameOne(flown, start)), ahead_ + 1, picture_, end, places, own);
    seen_again_ += error.seen;
    // Those that were not seen count as the others.
    if (error.seen > 0) film_[at] = error.squared / error.seen * static_cast<double>(own.size());
  }

  void AddFlock(std::size_t k, const FlockStatistics& flown) {
    const double polarisation =
        flown.polarisation.value_or(0) - true_flock_.polarisation.value_or(0);
    const double speed = RelativeDifference(flown.speed_median, true_flock_.speed_median);
    const double neighbour =
        RelativeDifference(flown.neighbour_median, true_flock_.neighbour_median);
    if (!std::isfinite(speed) || !std::isfinite(neighbour)) return;
    flock_[k].polarisation += std::abs(polarisation);
    flock_[k].speed += speed;
    flock_[k].neighbour += neighbour;
    ++flocks_[k];
  }

  void FlyStraightOn(std::size_t at) {
    const int start = starts_[at];
    const FlockState state = StateAtFrame(legs_[0].paths, start);
    std::unordered_map<Id, std::size_t> index;
    for (std::size_t i = 0; i < state.size(); ++i) index.emplace(state.id[i], i);
    for (const Id id : ids_) {
      const std::size_t i = index.at(own_[0].at(start).at(id));
      const Vec3d place = state.position[i] + (ahead_ / fps_) * state.velocity[i];
      straight_[at] += SquaredNorm(place - after_.at(id));
      straight_image_[at] += picture_.SquaredError(start + ahead_, after_.at(id), place);
    }
  }

  double Rms(const std::vector<double>& squares) const {
    return std::sqrt(Sum(squares) / animals_);
  }

  RoundTripScores Summary(bool has_second_film) {
    RoundTripScores scores;
    scores.lead = ahead_ / fps_;
    scores.starts = static_cast<int>(starts_.size());
    scores.animals = animals_;
    if (!scores.IsUsable()) return scores;
    for (std::vector<double>& row : image_) {
      for (std::size_t at = 0; at < row.size(); ++at) row[at] += film_[at];
    }
    if (has_second_film) image_.push_back(film_);
    const std::vector<ErrorShare> shares = SharesOf(space_), image_shares = SharesOf(image_);
    for (std::size_t k = 0; k < image_.size(); ++k) {
      StageShare& stage = scores.stages.emplace_back();
      stage.image_error = Rms(image_[k]);
      stage.image_share = image_shares[k].value;
      stage.image_share_sd = image_shares[k].sd;
      if (k == legs_.size()) {
        stage.stage = "film again";
        stage.coverage = static_cast<double>(seen_again_) / animals_;
        continue;
      }
      stage.stage = legs_[k].stage;
      stage.error = Rms(space_[k]);
      stage.share = shares[k].value;
      stage.share_sd = shares[k].sd;
      stage.coverage = present_[k] / in_view_;
      if (flocks_[k] == 0) continue;
      stage.flock = {flock_[k].polarisation / flocks_[k], flock_[k].speed / flocks_[k],
                     flock_[k].neighbour / flocks_[k]};
    }
    scores.error = Rms(space_[0]);
    scores.image_error = Rms(image_[0]);
    scores.straight_on_error = Rms(straight_);
    scores.straight_on_image_error = Rms(straight_image_);
    return scores;
  }

  const ReplayOptions& replay_;
  const Trajectories& truth_;
  const std::vector<RoundTripLeg>& legs_;
  double fps_;
  std::vector<int> starts_;
  int ahead_;  // [frames]
  Picture picture_;
  std::vector<std::map<int, std::map<Id, Id>>> own_;  // by leg, start and true id
  // Of the start at hand:
  std::vector<Id> ids_;
  Places after_;
  FlockStatistics true_flock_;
  // Sums of squares, by leg and start:
  std::vector<std::vector<double>> space_, image_;
  std::vector<double> film_, straight_, straight_image_;
  std::vector<double> present_;  // by leg: animals that it has, of in_view_
  double in_view_ = 0;
  std::vector<FlockDifference> flock_;  // by leg: sums over flocks_ starts
  std::vector<int> flocks_;
  int animals_ = 0, seen_again_ = 0;
};

}  // namespace

RoundTripScores ScoreRoundTrip(const RoundTripOptions& options, const ReplayOptions& replay,
                               const Camera& camera, const Trajectories& truth,
                               const std::vector<RoundTripLeg>& legs, double fps,
                               std::uint64_t seed, int threads, const FilmAgain& film_again) {
  CheckOptions(options);
  Check(!legs.empty() && fps > 0, "a round trip needs a leg and frames per second");
  const int ahead = std::max(1, static_cast<int>(std::lround(options.lead * fps)));
  return Scorer(replay, camera, truth, legs, fps, StartFrames(SpanOf(truth), ahead, options.starts),
                ahead)
      .Run(seed, threads, film_again);
}

}  // namespace flocklift
