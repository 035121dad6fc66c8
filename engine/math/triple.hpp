#pragma once
#include "engine/math/types.hpp"

#include <cmath>
#include <cstddef>

namespace tumble {

/// Three coordinates of any number type: doubles, double-doubles, estimates, exact sums. For
/// doubles it has no alignment and no SIMD: in loops whose every result feeds the next operation,
/// coordinates then stay in scalar registers, without stalls by loads of a different width than the
/// stores.
template <class T>
struct Triple {
  T x, y, z;

  static Triple of(const Vec3& v) { return {T{v.x()}, T{v.y()}, T{v.z()}}; }
  Vec3 vec() const { return {x, y, z}; }
  const T& operator[](size_t k) const { return k == 0 ? x : k == 1 ? y : z; }
  Triple operator-() const { return {-x, -y, -z}; }
  Triple operator+(const Triple& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Triple operator-(const Triple& o) const { return {x - o.x, y - o.y, z - o.z}; }
  template <class Factor>
  Triple operator*(const Factor& f) const {
    return {x * f, y * f, z * f};
  }
  template <class Factor>
  Triple operator/(const Factor& f) const {
    return {x / f, y / f, z / f};
  }
  T dot(const Triple& o) const { return x * o.x + y * o.y + z * o.z; }
  T squared() const { return dot(*this); }
  T norm() const {
    using std::sqrt;
    return sqrt(squared());
  }
  Triple cross(const Triple& o) const {
    return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
  }
  bool operator==(const Triple& o) const = default;
};

using Plain3 = Triple<double>;

inline Plain3 operator*(double f, const Plain3& v) {
  return v * f;
}

}  // namespace tumble
