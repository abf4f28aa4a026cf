// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Apparent size, seen from the animal's own heading. The body has second moments along its three
// axes: wings s, trunk g (the heading), up u, in the proportion 1 : trunk : up, and its image has
// the squared extent, summed over both image directions and in units of its mean over all views,
//   Q = (|P s|^2 + trunk |P g|^2 + up |P u|^2) / (2/3 (1 + trunk + up)),
// P as in body_image.h; in weak perspective (body_fit.h) bodies are seen along the optical axis.
//   e = log size - (log wingspan + bias + ratio - L + log sqrt(Q))
// `bias` is the individual's, `ratio`, `trunk` and `up` are the flock's: how a wingspan relates to
// a box or a blob is not known beforehand. Where gravity is known the animal leans into its turns,
//   s = g x (up + lean a / 9.81 m/s^2),
// `lean` the flock's: 1 where lift alone carries weight and curve (a coordinated turn), 0 where
// wings stay level. The acceleration a is that of an earlier solution and stays fixed: otherwise
// the size of a bird would say how strongly it turns, in m/s^2, a scale that is not to be trusted.
// Where gravity is not known the wings are anywhere around g, and s and u count by their mean.
// A bird that beats its wings is no ellipsoid, though, and a box around it even less: from a
// quarter its wings and its trunk reach equally far, and the box is smaller than from the side or
// from the front. Where gravity is known, log sqrt(Q) is corrected by what the image of a body
// (body_image.h) differs from the usual Q, so far as the images are those of bodies.

#ifndef FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_SIZE_H_
#define FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_SIZE_H_

#include <cmath>
#include <optional>

#include "reconstruct/cost_functions/body_image.h"
#include "reconstruct/cost_functions/path.h"

namespace flocklift {

// Squared extents of a bird over its wingspan squared: gliding, wings 1, trunk 1/4, up next to
// nothing; beating +-50 degrees, wings 0.69 and up 0.08 in the mean. As proportions to the wings.
inline constexpr double kUsualLogTrunk = -1.2, kUsualLogUp = -2.2;

struct SizeError {
  static constexpr int kSize = 1;
  double rate = 1;                  // knots per second
  double softening = 1e-3;          // speed over depth below which a heading means nothing [1/s]
  double log_size = 0;              // of the angular size
  double log_wingspan = 0;          // of the flock's mean [log m]
  std::optional<Vec3d> up_in_cam;   // unit vector, where gravity is known
  Vec3d curve{};                    // a / 9.81 m/s^2, camera frame
  CameraMotion camera = {};         // at the knot
  const BodyImage* body = nullptr;  // for the correction, if any
  double body_share = 0;            // how much it counts, 0 to 1
  double perspective = 1;           // share of the ray that the body is seen along; 0: weak

  // c: control points k-1 .. k+1, each (X, Y, L); log_trunk and log_up are logs of proportions.
  template <typename T>
  void operator()(const T* c, const T& bias, const T& ratio, const T& log_trunk, const T& log_up,
                  const T& lean, T* error) const {
    Of(StateAtKnot(c, rate), bias, ratio, log_trunk, log_up, lean, error);
  }

  template <typename T>
  void Of(const PathState<T>& q, const T& bias, const T& ratio, const T& log_trunk, const T& log_up,
          const T& lean, T* error) const {
    using std::exp;
    using std::log;
    using std::sqrt;
    const Vec3<T> w = VelocityOverDepth(q, camera);
    const T speed2 = Dot(w, w) + softening * softening;
    const Vec2<T> ray{perspective * q.x, perspective * q.y};
    const auto seen = [&ray](const Vec3<T>& a) {  // |P a|^2
      const Vec2<T> p = ImageOf(a, ray);
      return p.x * p.x + p.y * p.y;
    };
    const T whole = 2.0 + ray.x * ray.x + ray.y * ray.y;  // |P s|^2 + |P g|^2 + |P u|^2
    const T along = seen(w) / speed2;
    T across = 0.5 * (whole - along);
    T correction(0.0);
    const auto extent = [&](const T& trunk, const T& up) {
      return 1.5 * (across + trunk * along + up * (whole - along - across)) / (1.0 + trunk + up);
    };
    if (up_in_cam) {
      const Vec3<T> lift = {up_in_cam->x + lean * curve.x, up_in_cam->y + lean * curve.y,
                            up_in_cam->z + lean * curve.z};
      const Vec3<T> side = Cross(w, lift);
      // Of a heading within some 10 degrees of the lift the side is less and less certain.
      const T certain = 0.03 * speed2 * Dot(lift, lift);
      const T side2 = Dot(side, side) + certain;
      across = (seen(side) + certain * across) / side2;
      if (body != nullptr && body_share > 0) {
        const Vec3<T> g = (1.0 / sqrt(speed2)) * w;
        const Vec3<T> s = (1.0 / sqrt(side2)) * side;
        const T usual = extent(T(std::exp(kUsualLogTrunk)), T(std::exp(kUsualLogUp)));
        correction = body_share *
                     (body->LogSize(ImageOf(g, ray), ImageOf(s, ray), ImageOf(Cross(s, g), ray)) -
                      0.5 * log(usual));
      }
    }
    error[0] = log_size - (log_wingspan + bias + ratio - q.l +
                           0.5 * log(extent(exp(log_trunk), exp(log_up))) + correction);
  }
};

}  // namespace flocklift

#endif  // FLOCKLIFT_RECONSTRUCT_COST_FUNCTIONS_SIZE_H_
