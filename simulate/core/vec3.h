// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Small fixed vectors for any scalar: float, double, a SIMD pack, ceres::Jet.

#ifndef FLOCKLIFT_SIMULATE_CORE_VEC3_H_
#define FLOCKLIFT_SIMULATE_CORE_VEC3_H_

#include <cmath>

namespace flocklift {

// Chooses without a branch: the boolean member of the family of `select` functions. Packs bring
// their own, found by argument-dependent lookup; both sides are evaluated, so both must be finite.
template <typename T>
constexpr T select(bool mask, const T& if_true, const T& if_false) {
  return mask ? if_true : if_false;
}

// `value` where the mask holds, 0 elsewhere; kernels bring a cheaper one for their packs.
template <typename Mask, typename T>
constexpr T Where(const Mask& mask, const T& value) {
  return select(mask, value, T(0.0));
}

// A point or direction of the image [px].
template <typename T>
struct Vec2 {
  T x{}, y{};

  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

// A point, velocity or force in space [m, m/s, m/s^2]; the name of a variable carries its frame.
template <typename T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr Vec3& operator+=(const Vec3& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  constexpr Vec3& operator-=(const Vec3& b) {
    x -= b.x;
    y -= b.y;
    z -= b.z;
    return *this;
  }
  constexpr Vec3& operator*=(const T& s) {
    x *= s;
    y *= s;
    z *= s;
    return *this;
  }

  // Friends, so that implicit conversions to T apply (`2.0 * v` with T = ceres::Jet).
  friend constexpr Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
  friend constexpr Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
  friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(const T& s, Vec3 a) { return a *= s; }
  friend constexpr Vec3 operator*(Vec3 a, const T& s) { return a *= s; }
  friend constexpr Vec3 operator/(Vec3 a, const T& s) { return {a.x / s, a.y / s, a.z / s}; }
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec2d = Vec2<double>;
using Vec3d = Vec3<double>;

template <typename T>
constexpr T Dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
constexpr Vec3<T> Cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename T>
constexpr T SquaredNorm(const Vec3<T>& a) {
  return Dot(a, a);
}

// Not differentiable at 0; terms that autodiff goes through soften it themselves.
template <typename T>
T Norm(const Vec3<T>& a) {
  using std::sqrt;
  return sqrt(Dot(a, a));
}

// a / |a|, and 0 where |a| is too small to have a direction.
inline Vec3d Normalized(const Vec3d& a) {
  const double norm = Norm(a);
  return norm > 1e-12 ? a / norm : Vec3d{};
}

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_VEC3_H_
