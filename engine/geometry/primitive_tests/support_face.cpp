#include "engine/geometry/primitive_tests/support_face.hpp"

#include "engine/geometry/constructions/closest_points.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr double level = 1e-13;  ///< corners within this share of the size count as equally far

template <size_t N>
SupportFace furthest(const std::array<Vec3, N>& corners, const Vec3& direction) {
  double size = 0, most = 0;  // relative to the first corner
  for (const Vec3& c : corners) {
    size = std::max(size, (c - corners[0]).norm());
    most = std::max(most, direction.dot(c - corners[0]));
  }
  SupportFace out;
  for (const Vec3& c : corners) {
    if (direction.dot(c - corners[0]) >= most - level * size) {
      out.corners[size_t(out.count++)] = c;
    }
  }
  return out;
}

/// Nearest point of a face, given as one or two triangles that may have no area.
Vec3 nearest_on(const SupportFace& f, const Vec3& p) {
  const auto corner = [&](int k) { return f.corners[size_t(std::min(k, f.count - 1))]; };
  const TrianglePoint near = closest_on_triangle(p, corner(0), corner(1), corner(2));
  if (f.count < 4) return near.point;
  const TrianglePoint other = closest_on_triangle(p, corner(0), corner(2), corner(3));
  return other.squared_distance < near.squared_distance ? other.point : near.point;
}

}  // namespace

SupportFace support_face(const Segment& s, const Vec3& direction) {
  return furthest(std::array<Vec3, 2>{s.a, s.b}, direction);
}

SupportFace support_face(const Triangle3& t, const Vec3& direction) {
  return furthest(t, direction);
}

SupportFace support_face(const OrientedBox& box, const Vec3& direction) {
  SupportFace out;
  out.corners[0] = box.centre;
  out.count = 1;
  for (int k = 0; k < 3; ++k) {
    const Vec3 arm = box.half_axes.col(k);
    const double along = direction.dot(arm);
    if (std::fabs(along) > level * arm.norm()) {
      for (int i = 0; i < out.count; ++i) out.corners[size_t(i)] += along > 0 ? arm : Vec3(-arm);
    } else if (out.count < 4 && !arm.isZero(0)) {
      for (int i = 0; i < out.count; ++i) {
        out.corners[size_t(2 * out.count - 1 - i)] = out.corners[size_t(i)] + arm;
        out.corners[size_t(i)] -= arm;
      }
      out.count *= 2;
    }
  }
  return out;
}

PrimitiveContact contact_between(const SupportFace& a, const SupportFace& b,
                                 const Penetration& penetration) {
  // After the shift, the face and b are coplanar: a corner of one lies in the other, or sides
  // cross.
  const Vec3 shift = penetration.depth * penetration.normal;
  SupportFace moved = a;
  for (Vec3& corner : moved.corners) corner -= shift;
  PrimitiveContact out{.normal = penetration.normal, .depth = penetration.depth};
  double nearest = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Vec3& on_moved, const Vec3& on_b) {
    const double square = (on_moved - on_b).squaredNorm();
    if (!(square < nearest)) return;
    nearest = square;
    out.on_a = on_moved + shift;
    out.on_b = on_b;
  };
  for (int i = 0; i < moved.count; ++i) {
    offer(moved.corners[size_t(i)], nearest_on(b, moved.corners[size_t(i)]));
  }
  for (int j = 0; j < b.count; ++j) {
    offer(nearest_on(moved, b.corners[size_t(j)]), b.corners[size_t(j)]);
  }
  const auto side = [](const SupportFace& f, int k) {
    return Segment{f.corners[size_t(k)], f.corners[size_t((k + 1) % f.count)]};
  };
  for (int i = 0; i < moved.count; ++i) {
    for (int j = 0; j < b.count; ++j) {
      const Segment s = side(moved, i), t = side(b, j);
      const SegmentPair pair = closest_segment_segment(s.a, s.b, t.a, t.b);
      offer(pair.on_a, pair.on_b);
    }
  }
  return out;
}

}  // namespace tumble
