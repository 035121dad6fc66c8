// The stones of a semicircular arch: thirteen wedges between radius 1.5 and 2.0 m on two springers,
// exact, so that loose stones touch each other everywhere from the start.
#include "assets/generate/constructions.hpp"
#include "assets/generate/makers.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>

namespace tumble::assets {
namespace {

constexpr double inner_radius = 1.5, outer_radius = 2.0, mid_radius = 1.75;  // at the joints [m]
constexpr double half_depth = 0.4;                                           // [m]
constexpr int stones = 13;
constexpr double bevel = 0.015;  // [m]

/// A convex face, turned so that it looks away from `inside`.
void face_away(Builder& builder, Loop3 face, const Vec3& inside) {
  const Vec3 normal = (face[1] - face[0]).cross(face[2] - face[0]);
  if (normal.dot(face[0] - inside) < 0) std::reverse(face.begin(), face.end());
  if (face.size() == 4) {
    builder.quad(face[0], face[1], face[2], face[3]);
  } else {
    builder.triangle(face[0], face[1], face[2]);
  }
}

/// A six-sided block with bevelled edges; bits 0, 1, 2 of a corner's number are its x, y, z side.
Mesh block(const std::array<Vec3, 8>& corner) {
  Vec3 inside = Vec3::Zero();
  for (const Vec3& p : corner) inside += p / 8;
  // The copy of corner c that lies in its face across `axis`, drawn in along the other two edges.
  const auto drawn_in = [&](unsigned c, unsigned axis) {
    Vec3 p = corner[c];
    for (unsigned other = 0; other < 3; ++other) {
      if (other != axis) p += bevel * (corner[c ^ (1U << other)] - corner[c]).normalized();
    }
    return p;
  };
  Builder builder;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned i = 1U << ((axis + 1) % 3), j = 1U << ((axis + 2) % 3);
    for (const unsigned side : {0U, 1U << axis}) {
      face_away(builder,
                {drawn_in(side, axis), drawn_in(side | i, axis), drawn_in(side | i | j, axis),
                 drawn_in(side | j, axis)},
                inside);
    }
    // The four edges along this axis.
    const unsigned a1 = (axis + 1) % 3, a2 = (axis + 2) % 3;
    for (const unsigned edge : {0U, i, j, i | j}) {
      const unsigned far = edge | (1U << axis);
      face_away(builder,
                {drawn_in(edge, a1), drawn_in(edge, a2), drawn_in(far, a2), drawn_in(far, a1)},
                inside);
    }
  }
  for (unsigned c = 0; c < 8; ++c) {
    face_away(builder, {drawn_in(c, 0), drawn_in(c, 1), drawn_in(c, 2)}, inside);
  }
  return builder.exact_mesh();
}

Mesh wedge(double outer) {
  const double half_angle = det::pi / (2 * stones);
  std::array<Vec3, 8> corner;
  for (unsigned c = 0; c < 8; ++c) {
    const double radius = (c & 2U) != 0 ? outer : inner_radius;
    const double side = (c & 1U) != 0 ? 1 : -1;
    corner[c] = {side * radius * det::sin(half_angle), radius * det::cos(half_angle) - mid_radius,
                 (c & 4U) != 0 ? half_depth : -half_depth};
  }
  return block(corner);
}

}  // namespace

Mesh make_arch_stone() {
  return wedge(outer_radius);
}

Mesh make_arch_keystone() {
  return wedge(outer_radius + 0.15);
}

Mesh make_arch_springer() {
  std::array<Vec3, 8> corner;
  for (unsigned c = 0; c < 8; ++c) {
    corner[c] = {(c & 1U) != 0 ? 0.40 : -0.40, (c & 2U) != 0 ? 0 : -0.60,
                 (c & 4U) != 0 ? 0.5 : -0.5};
  }
  return block(corner);
}

}  // namespace tumble::assets
