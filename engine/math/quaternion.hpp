#pragma once
#include "engine/math/matrix3.hpp"

namespace tumble {

/// w + x i + y j + z k; a rotation if its length is 1.
template <class T>
class Quaternion {
 public:
  using Scalar = T;
  Quaternion() = default;  ///< its numbers are not set
  constexpr Quaternion(const Quaternion&) = default;
  constexpr Quaternion& operator=(const Quaternion&) & = default;
  constexpr Quaternion(T w, T x, T y, T z) : c_(x, y, z, w) {}
  constexpr Quaternion(T w, const Vector3<T>& v) : c_(v[0], v[1], v[2], w) {}
  /// From (x, y, z, w), the order of coeffs().
  constexpr explicit Quaternion(const Vector4<T>& coefficients) : c_(coefficients) {}
  /// The quaternion of a rotation matrix (Shoemake 1985, "Animating Rotation with Quaternion
  /// Curves", appendix).
  explicit Quaternion(const Matrix3<T>& m) {
    if (const T trace = m.trace(); trace > 0) {
      const T root = std::sqrt(trace + 1), s = T(0.5) / root;
      *this = {T(0.5) * root, (m(2, 1) - m(1, 2)) * s, (m(0, 2) - m(2, 0)) * s,
               (m(1, 0) - m(0, 1)) * s};
      return;
    }
    int i = m(1, 1) > m(0, 0) ? 1 : 0;
    if (m(2, 2) > m(i, i)) i = 2;
    const int j = (i + 1) % 3, k = (j + 1) % 3;
    const T root = std::sqrt(m(i, i) - m(j, j) - m(k, k) + T(1)), s = T(0.5) / root;
    c_[i] = T(0.5) * root;
    c_[j] = (m(j, i) + m(i, j)) * s;
    c_[k] = (m(k, i) + m(i, k)) * s;
    c_[3] = (m(k, j) - m(j, k)) * s;
  }
  static constexpr Quaternion Identity() { return {1, 0, 0, 0}; }

  constexpr T& x() { return c_[0]; }
  constexpr T& y() { return c_[1]; }
  constexpr T& z() { return c_[2]; }
  constexpr T& w() { return c_[3]; }
  constexpr const T& x() const { return c_[0]; }
  constexpr const T& y() const { return c_[1]; }
  constexpr const T& z() const { return c_[2]; }
  constexpr const T& w() const { return c_[3]; }
  constexpr Vector3<T> vec() const { return {c_[0], c_[1], c_[2]}; }
  /// (x, y, z, w).
  constexpr Vector4<T>& coeffs() { return c_; }
  constexpr const Vector4<T>& coeffs() const { return c_; }

  constexpr T dot(const Quaternion& b) const { return c_.dot(b.c_); }
  constexpr T squaredNorm() const { return c_.squaredNorm(); }
  T norm() const { return c_.norm(); }
  Quaternion normalized() const { return Quaternion(c_.normalized()); }
  void normalize() & { c_.normalize(); }
  constexpr Quaternion conjugate() const { return {c_[3], -c_[0], -c_[1], -c_[2]}; }
  /// Zero for the zero quaternion.
  constexpr Quaternion inverse() const {
    const T n = squaredNorm();
    return n > 0 ? Quaternion(conjugate().c_ / n) : Quaternion(Vector4<T>::Zero());
  }
  /// The angle between two orientations [rad], 0 to pi.
  T angularDistance(const Quaternion& b) const {
    const Quaternion d = *this * b.conjugate();
    return T(2) * std::atan2(d.vec().norm(), std::abs(d.w()));
  }

  /// R v for a unit quaternion, by two cross products.
  constexpr Vector3<T> operator*(const Vector3<T>& v) const {
    const Vector3<T> u = vec();
    Vector3<T> uv = u.cross(v);
    uv += uv;
    return v + w() * uv + u.cross(uv);
  }
  constexpr Matrix3<T> toRotationMatrix() const {
    const T tx = 2 * x(), ty = 2 * y(), tz = 2 * z();
    const T twx = tx * w(), twy = ty * w(), twz = tz * w();
    const T txx = tx * x(), txy = ty * x(), txz = tz * x();
    const T tyy = ty * y(), tyz = tz * y(), tzz = tz * z();
    return {1 - (tyy + tzz), txy - twz,       txz + twy,  //
            txy + twz,       1 - (txx + tzz), tyz - twx,  //
            txz - twy,       tyz + twx,       1 - (txx + tyy)};
  }
  friend constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    return {(a.w() * b.w() - a.y() * b.y()) - (a.z() * b.z() + a.x() * b.x()),
            (a.w() * b.x() + a.y() * b.z()) - (a.z() * b.y() - a.x() * b.w()),
            (a.w() * b.y() + a.y() * b.w()) + (a.z() * b.x() - a.x() * b.z()),
            (a.w() * b.z() - a.y() * b.x()) + (a.z() * b.w() + a.x() * b.y())};
  }
  constexpr Quaternion& operator*=(const Quaternion& b) & { return *this = *this * b; }
  friend constexpr bool operator==(const Quaternion& a, const Quaternion& b) {
    return a.c_ == b.c_;
  }
  bool isApprox(const Quaternion& b, T relative = detail::rounding<T>) const {
    return c_.isApprox(b.c_, relative);
  }
  template <class U>
  constexpr Quaternion<U> cast() const {
    return Quaternion<U>(c_.template cast<U>());
  }

 private:
  Vector4<T> c_;
};

}  // namespace tumble
