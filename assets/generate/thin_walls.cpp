// Shells of a millimetre and less, for what is thin and what is fast.
#include "assets/generate/constructions.hpp"
#include "assets/generate/makers.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::assets {
namespace {

/// A horizontal square of this half width about the y axis, counter-clockwise from above.
Loop3 square(double half, double y) {
  return {{-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half}};
}

/// Walls and floor of a box about the y axis, seen from outside, or from inside when `hollow`.
void box_without_lid(Builder& builder, const Vec3& half, double low, double high, bool hollow) {
  const auto corner = [&](int x, int z, double y) { return Vec3(x * half.x(), y, z * half.z()); };
  const auto face = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    if (hollow) std::swap(b, d);
    builder.quad(a, b, c, d);
  };
  constexpr int turn[4][2] = {{-1, 1}, {1, 1}, {1, -1}, {-1, -1}};  // counter-clockwise from above
  for (size_t i = 0; i < 4; ++i) {
    const int *p = turn[i], *q = turn[(i + 1) % 4];
    face(corner(p[0], p[1], low), corner(q[0], q[1], low), corner(q[0], q[1], high),
         corner(p[0], p[1], high));
  }
  face(corner(-1, -1, low), corner(1, -1, low), corner(1, 1, low), corner(-1, 1, low));
}

}  // namespace

Mesh make_glass_case() {
  constexpr double wall = 0.006, pinhole = 0.0005;
  const Vec3 inner(0.6, 0.8, 0.35);  // half width, height, half depth
  const Vec3 outer = inner + Vec3(wall, 0, wall);
  const double top = inner.y() + wall;
  Builder builder;
  box_without_lid(builder, outer, -wall, top, false);
  box_without_lid(builder, inner, 0, inner.y(), true);
  const auto lid = [](const Vec3& half, double y) {
    return Loop3{{-half.x(), y, half.z()},
                 {half.x(), y, half.z()},
                 {half.x(), y, -half.z()},
                 {-half.x(), y, -half.z()}};
  };
  builder.polygon(lid(outer, top), {square(pinhole, top)});
  Loop3 ceiling = lid(inner, inner.y());
  std::reverse(ceiling.begin(), ceiling.end());
  builder.polygon(ceiling, {square(pinhole, inner.y())});
  const Loop3 above = square(pinhole, top), below = square(pinhole, inner.y());
  for (size_t i = 0; i < 4; ++i) {
    const size_t k = (i + 1) % 4;
    builder.quad(above[i], above[k], below[k], below[i]);
  }
  return builder.mesh();
}

Mesh make_thin_dish() {
  constexpr double thickness = 0.0001, rim = 0.5, curvature = 1.1;
  constexpr int rings = 8;
  const double half_angle = det::asin(rim / curvature);
  Loop2 profile;
  for (int i = 0; i <= rings; ++i) {
    const double a = half_angle * i / rings, r = curvature - thickness;
    profile.push_back({r * det::sin(a), r * det::cos(a)});
  }
  for (int i = rings; i >= 0; --i) {
    const double a = half_angle * i / rings;
    profile.push_back({curvature * det::sin(a), curvature * det::cos(a)});
  }
  Builder builder;
  revolve(builder, profile, 48);
  return builder.centred_mesh();
}

}  // namespace tumble::assets
