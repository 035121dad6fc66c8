#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// Three doubles without alignment or packets: in loops whose every result feeds the next
/// operation, coordinates stay in registers one by one, and nothing waits for memory that was
/// written in other widths.
struct Plain3 {
  double x, y, z;

  static Plain3 of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
  Vec3 vec() const { return {x, y, z}; }
  Plain3 operator-() const { return {-x, -y, -z}; }
  Plain3 operator+(const Plain3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Plain3 operator-(const Plain3& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Plain3 operator*(double f) const { return {x * f, y * f, z * f}; }
  double dot(const Plain3& o) const { return x * o.x + y * o.y + z * o.z; }
  double squared() const { return dot(*this); }
  Plain3 cross(const Plain3& o) const {
    return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
  }
  bool operator==(const Plain3& o) const = default;
};

inline Plain3 operator*(double f, const Plain3& v) {
  return v * f;
}

/// A rotation by rows.
struct PlainRotation {
  Plain3 row0, row1, row2;

  Plain3 operator*(const Plain3& p) const { return {row0.dot(p), row1.dot(p), row2.dot(p)}; }
  /// By the transpose.
  Plain3 back(const Plain3& p) const { return row0 * p.x + row1 * p.y + row2 * p.z; }
};

}  // namespace tumble
