// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The image of a bird in flight, as a box around it or as the second moments of its silhouette, in
// the mean over the phases of its wingbeat. In units of the wingspan a body is
//   wing tips  (+-cos(f) s + sin(f) u) / 2,  f = A sin(phase),   nose and tail  +-(l / 2) g,
// with wings s, heading g, up u. Their images are given (ImageOf).
//   box         around the images of the four, W wide and H high, neither below a body's thickness
//               of 0.1; its squared sides W^2, H^2 count as a, c
//   silhouette  second moments (a b; b c) in units of those of stretched wings,
//               cos(f)^2 s s' + trunk g g' + 0.6 sin(f)^2 u u'
// (raised wings lie on one side of the trunk, so along u their moment about the middle is less; of
// tapering wings some 0.6 of that along s). The size is sqrt(a + c), the ellipticity
// ((a - c), 2 b) / (a + c), as in initialize/segments.h.

#ifndef FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_BODY_IMAGE_H_
#define FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_BODY_IMAGE_H_

#include <array>
#include <cmath>
#include <numbers>

#include "simulate/core/vec3.h"

namespace flocklift {

// Image of an axis of a body that is seen along the ray (X, Y, 1), times its depth,
//   P a = (a_x - X a_z, a_y - Y a_z):
// the derivative of the projection, so a stretch towards the image's edge is in it.
template <typename T>
Vec2<T> ImageOf(const Vec3<T>& a, const Vec2<T>& ray) {
  return {a.x - ray.x * a.z, a.y - ray.y * a.z};
}

// The usual body is the simulator's: length half the wingspan (core/animal.h; a jackdaw has 33 of
// 67 to 74 cm), the inner wing raised by 0.8 sin(phase) (render/body.h).
struct BodyShape {
  double length = 0.5;     // l, over the wingspan; of boxes
  double trunk = 0.3;      // second moment over that of stretched wings; of silhouettes
  double amplitude = 0.8;  // A [rad]
};

class BodyImage {
 public:
  enum class Kind { kBox, kSilhouette };

  BodyImage() : BodyImage(Kind::kBox, BodyShape{}) {}
  BodyImage(Kind kind, const BodyShape& shape) : kind_(kind), shape_(shape) {
    for (std::size_t k = 0; k < kFlaps; ++k) {
      // Wings raised or lowered as much look alike: phases of a quarter of a beat stand for all.
      const double flap = shape.amplitude * std::sin(std::numbers::pi *
                                                     (static_cast<double>(k) + 0.5) / (2 * kFlaps));
      wings_[k] = {std::cos(flap), std::sin(flap)};
    }
  }

  Kind kind() const { return kind_; }
  const BodyShape& shape() const { return shape_; }

  // log of the size, over the wingspan (box) or over stretched wings seen in full (silhouette).
  template <typename T>
  T LogSize(const Vec2<T>& g, const Vec2<T>& s, const Vec2<T>& u) const {
    const Axes x{ValueOf(g.x), ValueOf(s.x), ValueOf(u.x)};
    const Axes y{ValueOf(g.y), ValueOf(s.y), ValueOf(u.y)};
    double value = 0;
    Axes by_x{}, by_y{};
    for (const Wings& wings : wings_) {
      const Extent across = ExtentOf(x, wings), down = ExtentOf(y, wings);
      const double squared = across.square + down.square;
      value += 0.5 * std::log(squared);
      for (std::size_t a = 0; a < 3; ++a) {
        by_x[a] += across.half_slope[a] / squared;
        by_y[a] += down.half_slope[a] / squared;
      }
    }
    // Six derivatives by hand, for whatever a scalar carries along.
    T result(value / kFlaps);
    const auto add = [&result](double slope, const T& axis) {
      result += (slope / kFlaps) * (axis - ValueOf(axis));
    };
    add(by_x[0], g.x);
    add(by_x[1], s.x);
    add(by_x[2], u.x);
    add(by_y[0], g.y);
    add(by_y[1], s.y);
    add(by_y[2], u.y);
    return result;
  }

  Vec2d Ellipticity(const Vec2d& g, const Vec2d& s, const Vec2d& u) const {
    Vec2d sum;
    for (const Wings& wings : wings_) {
      const double a = ExtentOf({g.x, s.x, u.x}, wings).square;
      const double c = ExtentOf({g.y, s.y, u.y}, wings).square;
      const auto [out, up] = wings;
      const double b = kind_ == Kind::kBox ? 0
                                           : out * out * s.x * s.y + shape_.trunk * g.x * g.y +
                                                 kRaised * up * up * u.x * u.y;
      sum.x += (a - c) / (a + c);
      sum.y += 2 * b / (a + c);
    }
    return {sum.x / kFlaps, sum.y / kFlaps};
  }

 private:
  static constexpr int kFlaps = 2;
  static constexpr double kThickness = 0.1, kRaised = 0.6;

  static double ValueOf(double x) { return x; }
  template <typename Jet>
  static double ValueOf(const Jet& x) {
    return x.a;
  }

  struct Wings {  // cosine and sine of the flap
    double out, up;
  };
  using Axes = std::array<double, 3>;  // one coordinate of g, s, u, or by it
  struct Extent {
    double square = 0;  // of a box's side, or a second moment
    Axes half_slope{};  // half its derivative
  };

  Extent ExtentOf(const Axes& axis, const Wings& wings) const {
    return kind_ == Kind::kBox ? SideOf(axis, wings) : MomentOf(axis, wings);
  }

  Extent MomentOf(const Axes& axis, const Wings& wings) const {
    const Axes weight{shape_.trunk, wings.out * wings.out, kRaised * wings.up * wings.up};
    Extent extent;
    for (std::size_t a = 0; a < 3; ++a) {
      extent.square += weight[a] * axis[a] * axis[a];
      extent.half_slope[a] = weight[a] * axis[a];
    }
    return extent;
  }

  Extent SideOf(const Axes& axis, const Wings& wings) const {
    const double nose = 0.5 * shape_.length * std::abs(axis[0]);
    const double tip = 0.5 * wings.out * std::abs(axis[1]);
    const double raised = 0.5 * wings.up * axis[2];
    double length = 0;
    Axes by{};
    const auto reach = [&](double sign) {  // how far one end is from the middle
      const double wing = tip + sign * raised;
      if (nose > wing) {
        length += nose;
        by[0] += std::copysign(0.5 * shape_.length, axis[0]);
      } else {
        length += wing;
        by[1] += std::copysign(0.5 * wings.out, axis[1]);
        by[2] += sign * 0.5 * wings.up;
      }
    };
    reach(1);
    reach(-1);
    if (length < kThickness) return {kThickness * kThickness, {}};
    for (double& slope : by) slope *= length;
    return {length * length, by};
  }

  Kind kind_;
  BodyShape shape_;
  std::array<Wings, kFlaps> wings_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_BODY_IMAGE_H_
