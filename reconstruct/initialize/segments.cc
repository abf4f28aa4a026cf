// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reconstruct/initialize/segments.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "reconstruct/initialize/persistence.h"
#include "reconstruct/initialize/reference_axes.h"
#include "simulate/camera/projection.h"
#include "simulate/core/check.h"
#include "simulate/core/trajectory.h"

namespace flocklift {
namespace {

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double Diagonal(double a, double b) { return std::sqrt(a * a + b * b); }

bool IsMeasured(const Detection& d) { return d.confidence >= kMeasuredConfidence; }

// Where the detection would be in the picture of a camera that does not turn [px].
Vec2d SteadyPixel(const ReferenceAxes& axes, const Camera& camera, const Detection& d) {
  const Vec2d pixel = d.box.Center();
  if (!axes.turns()) return pixel;
  const auto ray = RayThroughPixel(camera.intrinsics, pixel);
  const auto turned = ray ? axes.Turn(d.frame, *ray) : std::nullopt;
  if (!turned) return pixel;
  return {turned->ray.x * camera.intrinsics.fx, turned->ray.y * camera.intrinsics.fy};
}

// Third differences over four successive measured frames; sd of white noise from their median.
double EstimatePixelSd(const ReferenceAxes& axes, const Camera& camera, const Tracks& tracks) {
  std::vector<double> differences;
  for (const Tracklet& tracklet : tracks.tracklets) {
    const auto& d = tracklet.detections;
    for (std::size_t k = 3; k < d.size(); ++k) {
      if (d[k].frame - d[k - 3].frame != 3) continue;
      if (!IsMeasured(d[k]) || !IsMeasured(d[k - 1]) || !IsMeasured(d[k - 2]) ||
          !IsMeasured(d[k - 3])) {
        continue;
      }
      Vec2d p[4];
      for (std::size_t a = 0; a < 4; ++a) p[a] = SteadyPixel(axes, camera, d[k - 3 + a]);
      differences.push_back(std::abs(p[3].x - 3 * p[2].x + 3 * p[1].x - p[0].x));
      differences.push_back(std::abs(p[3].y - 3 * p[2].y + 3 * p[1].y - p[0].y));
    }
  }
  constexpr double kMedianOfNormal = 0.6745;
  return Median(std::move(differences)) / (kMedianOfNormal * std::sqrt(20.0));
}

// Log of (size by box over size by shape), median of the detections that have both.
std::optional<double> MedianBoxOverShape(const Tracks& tracks) {
  std::vector<double> ratios;
  for (const Tracklet& tracklet : tracks.tracklets) {
    for (const Detection& d : tracklet.detections) {
      if (!d.shape || !IsMeasured(d)) continue;
      const double shape = Diagonal(d.shape->major, d.shape->minor);
      const double box = Diagonal(d.box.width, d.box.height);
      if (shape > 0 && box > 0) ratios.push_back(std::log(box / shape));
    }
  }
  if (ratios.empty()) return std::nullopt;
  return Median(std::move(ratios));
}

// The Jacobian of a map of the plane, by differences.
template <typename Map>
Eigen::Matrix2d JacobianOf(const Map& map, const Vec2d& at) {
  constexpr double kStep = 1e-5;
  const Vec2d a = map(Vec2d{at.x + kStep, at.y}), b = map(Vec2d{at.x - kStep, at.y});
  const Vec2d c = map(Vec2d{at.x, at.y + kStep}), d = map(Vec2d{at.x, at.y - kStep});
  Eigen::Matrix2d jacobian;
  jacobian << a.x - b.x, c.x - d.x, a.y - b.y, c.y - d.y;
  return jacobian / (2 * kStep);
}

// Pixels by normalised coordinates around a ray.
Eigen::Matrix2d PixelByRay(const Intrinsics& k, const Vec2d& ray) {
  return JacobianOf([&k](const Vec2d& r) { return ProjectNormalized(k, r); }, ray);
}

// Pixels per unit of normalised coordinates.
double LocalFocalLength(const Eigen::Matrix2d& pixel_by_ray) {
  return std::sqrt(std::max(std::abs(pixel_by_ray.determinant()), 1e-30));
}

Vec2d EllipticityOf(const Eigen::Matrix2d& moments) {
  const double trace = moments.trace();
  return {(moments(0, 0) - moments(1, 1)) / trace, 2 * moments(0, 1) / trace};
}

// Of moments in the picture, `squares` along axes that are turned by `angle`, seen in the reference
// axes.
std::optional<Vec2d> EllipticityOf(const Eigen::Vector2d& squares, double angle,
                                   const ReferenceAxes& axes, int frame, const Vec2d& ray,
                                   const Eigen::Matrix2d& pixel_by_ray) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  Eigen::Matrix2d ref_by_pixel = pixel_by_ray.inverse();
  if (axes.turns()) {
    const auto turned = [&](const Vec2d& r) {
      return axes.Turn(frame, r).value_or(ReferenceAxes::Turned{}).ray;
    };
    ref_by_pixel = JacobianOf(turned, ray) * ref_by_pixel;
  }
  const Eigen::Matrix2d moments =
      ref_by_pixel * turn * squares.asDiagonal() * turn.transpose() * ref_by_pixel.transpose();
  if (!(moments.trace() > 0) || !moments.allFinite()) return std::nullopt;
  return EllipticityOf(moments);
}

// Position and velocity by a straight line through up to four sightings on one side of a gap.
struct Line {
  Vec2d position, velocity;
};
Line FitLine(const Sighting* first, std::size_t count, double time) {
  double st = 0, stt = 0;
  Vec2d sp, stp;
  for (std::size_t a = 0; a < count; ++a) {
    const double t = first[a].time - time;
    st += t;
    stt += t * t;
    sp = {sp.x + first[a].ray.x, sp.y + first[a].ray.y};
    stp = {stp.x + t * first[a].ray.x, stp.y + t * first[a].ray.y};
  }
  const double n = static_cast<double>(count);
  const double determinant = n * stt - st * st;
  const Vec2d velocity{(n * stp.x - st * sp.x) / determinant,
                       (n * stp.y - st * sp.y) / determinant};
  return {{(sp.x - velocity.x * st) / n, (sp.y - velocity.y * st) / n}, velocity};
}

constexpr std::size_t kSide = 4;      // sightings that a line of motion is fitted to
constexpr std::size_t kGapStep = 4;   // sightings
constexpr std::size_t kGapSteps = 4;  // longest glitch: 16 sightings
constexpr double kBridge = 4;         // robust sds within which two motions are one animal's

// How badly the motion before sighting `first` predicts the motion from sighting `last` on, half
// way between. Nothing near the ends.
struct Mismatch {
  double position = 0, velocity = 0;

  // The larger of the two in units of `limit`.
  double Over(const Mismatch& limit) const {
    return std::max(position / limit.position, velocity / limit.velocity);
  }
};
std::optional<Mismatch> MismatchAcross(const std::vector<Sighting>& s, std::size_t first,
                                       std::size_t last) {
  if (first < kSide || last + kSide > s.size()) return std::nullopt;
  const double time = 0.5 * (s[first - 1].time + s[last].time);
  const Line before = FitLine(&s[first - kSide], kSide, time);
  const Line after = FitLine(&s[last], kSide, time);
  return Mismatch{
      std::hypot(after.position.x - before.position.x, after.position.y - before.position.y),
      std::hypot(after.velocity.x - before.velocity.x, after.velocity.y - before.velocity.y)};
}

// What the whole flock does across so many sightings: robust sds of the mismatch.
Mismatch UsualMismatch(const std::vector<Segment>& segments, std::size_t gap) {
  std::vector<double> positions, velocities;
  for (const Segment& segment : segments) {
    for (std::size_t k = 0; k < segment.sightings.size(); ++k) {
      if (const auto m = MismatchAcross(segment.sightings, k, k + gap)) {
        positions.push_back(m->position);
        velocities.push_back(m->velocity);
      }
    }
  }
  constexpr double kMedianOfNormal2 = 1.18;  // of the length of a 2-vector
  return {Median(std::move(positions)) / kMedianOfNormal2,
          Median(std::move(velocities)) / kMedianOfNormal2};
}

// A range of sightings that do not show the animal's own motion, though it is the same animal's
// before and after: a blob that held two, a wing at the edge of the picture.
struct Glitch {
  std::size_t first = 0, last = 0;
};

// The shortest glitch about the jump at k, if skipping it makes one motion of the two sides. An end
// of the segment that is as short as a glitch is one.
std::optional<Glitch> GlitchAt(const std::vector<Sighting>& s, std::size_t k,
                               const std::vector<Mismatch>& usual) {
  const std::size_t longest = kGapStep * kGapSteps;
  if (k <= longest && k <= s.size() - k) return Glitch{0, k};
  if (s.size() - k <= longest) return Glitch{k, s.size()};
  for (std::size_t gap = 1; gap <= kGapSteps; ++gap) {
    for (std::size_t before = 0; before <= gap; ++before) {
      const std::size_t first = k - std::min(k, before * kGapStep);
      const std::size_t last = first + gap * kGapStep;
      const auto m = MismatchAcross(s, first, last);
      if (m && m->Over(usual[gap]) <= kBridge) return Glitch{first, last};
    }
  }
  return std::nullopt;
}

// Cuts where the jump is the largest around and far beyond what the whole flock does, unless it is
// a glitch: that is left to the smoothness of the path, its sightings count little.
void CutJumps(double jump, double doubt, std::vector<Segment>* segments, int* cuts) {
  std::vector<Mismatch> usual;
  for (std::size_t gap = 0; gap <= kGapSteps; ++gap) {
    usual.push_back(UsualMismatch(*segments, gap * kGapStep));
    if (!(usual.back().position > 0) || !(usual.back().velocity > 0)) return;
  }
  std::vector<Segment> result;
  for (Segment& segment : *segments) {
    auto& s = segment.sightings;
    std::vector<double> excess(s.size(), 0.0);
    for (std::size_t k = 0; k < s.size(); ++k) {
      if (const auto m = MismatchAcross(s, k, k)) excess[k] = m->Over(usual[0]) / jump;
    }
    std::vector<std::size_t> cut_before;
    std::vector<Glitch> glitches;
    for (std::size_t k = 1; k < s.size(); ++k) {
      const std::size_t low = k < kSide ? 0 : k - kSide;
      const std::size_t high = std::min(s.size(), k + kSide + 1);
      const bool largest = std::max_element(excess.begin() + static_cast<std::ptrdiff_t>(low),
                                            excess.begin() + static_cast<std::ptrdiff_t>(high)) ==
                           excess.begin() + static_cast<std::ptrdiff_t>(k);
      if (excess[k] <= 1 || !largest) continue;
      if (const auto glitch = GlitchAt(s, k, usual)) {
        glitches.push_back(*glitch);
      } else {
        cut_before.push_back(k);
      }
    }
    for (const Glitch& glitch : glitches) {
      for (std::size_t k = glitch.first; k < glitch.last; ++k) {
        s[k].ray_sd = std::max(s[k].ray_sd, doubt);
        s[k].log_size.reset();
        s[k].ellipticity.reset();
      }
    }
    *cuts += static_cast<int>(cut_before.size());
    cut_before.push_back(s.size());
    std::size_t begin = 0;
    for (const std::size_t end : cut_before) {
      result.push_back({segment.id,
                        {s.begin() + static_cast<std::ptrdiff_t>(begin),
                         s.begin() + static_cast<std::ptrdiff_t>(end)}});
      begin = end;
    }
  }
  *segments = std::move(result);
}

}  // namespace

Segments MakeSegments(const SegmentOptions& options, const Tracks& tracks, const Camera& camera,
                      double fps) {
  Check(fps > 0, "reconstruct needs a positive number of frames per second");
  Segments result;
  result.fps = fps;
  const FrameSpan span = SpanOf(tracks);
  const ReferenceAxes axes(camera, span.first, span.last);
  if (axes.moves()) {
    for (int frame = span.first; frame <= span.last; ++frame) {
      result.camera_places.push_back(axes.CameraPlace(frame));
    }
  }
  result.pixel_sd = std::max(EstimatePixelSd(axes, camera, tracks), options.min_pixel_sd);
  const std::optional<double> box_over_shape = MedianBoxOverShape(tracks);
  result.has_shapes = box_over_shape.has_value();
  result.camera_turns = axes.turns();
  result.form = FormOfBoxes(tracks, camera);
  for (const Tracklet& tracklet : tracks.tracklets) {
    Segment segment{tracklet.id, {}};
    for (const Detection& d : tracklet.detections) {
      ++result.rows;
      const auto ray = RayThroughPixel(camera.intrinsics, d.box.Center());
      const auto turned = ray ? axes.Turn(d.frame, *ray) : std::nullopt;
      if (!turned) {
        ++result.unusable;
        continue;
      }
      const Eigen::Matrix2d pixel_by_ray = PixelByRay(camera.intrinsics, *ray);
      const double focal_px = LocalFocalLength(pixel_by_ray) / turned->magnification;
      Sighting sighting;
      sighting.frame = d.frame;
      sighting.time = (d.frame - span.first) / fps;
      sighting.ray = turned->ray;
      sighting.ray_sd = result.pixel_sd * (IsMeasured(d) ? 1 : options.interpolated_sd) / focal_px;
      const bool cut_off = IsCutOff(d.box, camera);
      if (cut_off) {
        const double half_box_px = 0.5 * Diagonal(d.box.width, d.box.height);
        sighting.ray_sd = std::max(sighting.ray_sd, half_box_px / focal_px);
      }
      if (options.use_size && IsMeasured(d) && !cut_off) {
        const double box_px = Diagonal(d.box.width, d.box.height);
        const double size_px =
            d.shape && box_over_shape
                ? Diagonal(d.shape->major, d.shape->minor) * std::exp(*box_over_shape)
                : box_px;
        if (size_px > 0) sighting.log_size = std::log(size_px / focal_px);
        if (size_px > 0 && d.shape) {
          sighting.ellipticity = EllipticityOf(
              Eigen::Vector2d(d.shape->major, d.shape->minor).cwiseAbs2(),
              d.shape->angle_deg * std::numbers::pi / 180, axes, d.frame, *ray, pixel_by_ray);
        } else if (size_px > 0 && !box_over_shape && !axes.turns()) {
          sighting.ellipticity =
              EllipticityOf(Eigen::Vector2d(d.box.width, d.box.height).cwiseAbs2(), 0, axes,
                            d.frame, *ray, pixel_by_ray);
        }
      }
      segment.sightings.push_back(sighting);
    }
    if (!segment.sightings.empty()) result.segments.push_back(std::move(segment));
  }
  if (options.jump > 0) {
    const double doubt = options.glitch_pixel_sd / camera.intrinsics.fx;
    CutJumps(options.jump, doubt, &result.segments, &result.cuts);
  }
  result.persistence = PersistenceOf(result.segments);
  return result;
}

}  // namespace flocklift
