#pragma once
#include "engine/math/types.hpp"

#include <string_view>

namespace tumble {

/// Where an algorithm draws what it sees. The viewer shows it, a recorder keeps it, tests count it.
/// Positions in world axes [m]; colours are linear RGBA in 0..1. Compound shapes (arrows, boxes,
/// frames) are free functions on top of these three.
class DebugDraw {
 public:
  virtual ~DebugDraw() = default;
  virtual void line(const Vec3& a, const Vec3& b, const Vec4f& colour) = 0;
  virtual void point(const Vec3& x, const Vec4f& colour, float pixels) = 0;
  virtual void text(const Vec3& x, const Vec4f& colour, std::string_view s) = 0;
};

/// The twelve edges of a box between two corners.
inline void draw_box(DebugDraw& out, const Vec3& lo, const Vec3& hi, const Vec4f& colour) {
  const Vec3 corners[2] = {lo, hi};
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 4; ++i) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      Vec3 a, b;
      a[u] = b[u] = corners[i & 1][u];
      a[v] = b[v] = corners[i >> 1][v];
      a[axis] = lo[axis];
      b[axis] = hi[axis];
      out.line(a, b, colour);
    }
}

}  // namespace tumble
