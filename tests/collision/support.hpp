#pragma once
#include "engine/collision/shape.hpp"
#include "engine/core/random.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/shape_reference.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>
#include <cstdlib>

#include <doctest/doctest.h>

/// Shapes and random draws shared by the tests of collision/.
namespace tumble::test {

/// `count` random cases, scaled by the environment variable TUMBLE_TEST_SCALE.
inline int cases(int count) {
  return scaled_count(count);
}

inline Vec3 random_direction(Random& r) {
  const double z = r.uniform(-1, 1), phi = r.uniform(0, 2 * det::pi), s = std::sqrt(1 - z * z);
  return {s * det::cos(phi), s * det::sin(phi), z};
}

inline Quat random_rotation(Random& r) {
  const double a = r.uniform(), b = r.uniform(0, 2 * det::pi), c = r.uniform(0, 2 * det::pi);
  return Quat(std::sqrt(1 - a) * det::sin(b), std::sqrt(1 - a) * det::cos(b),
              std::sqrt(a) * det::sin(c), std::sqrt(a) * det::cos(c));
}

inline Vec3 random_vec(Random& r, double a, double b) {
  const double x = r.uniform(a, b), y = r.uniform(a, b), z = r.uniform(a, b);
  return {x, y, z};
}

inline std::shared_ptr<const Shape> must(const ShapeDef& def) {
  auto shape = make_shape(def);
  REQUIRE_MESSAGE(shape.ok(), test::why_not(shape));
  return *shape;
}

inline std::shared_ptr<const Shape> sphere(double radius) {
  return must({.type = ShapeType::sphere, .radius = radius});
}
inline std::shared_ptr<const Shape> capsule(double radius, double height) {
  return must({.type = ShapeType::capsule, .radius = radius, .height = height});
}
inline std::shared_ptr<const Shape> cylinder(double radius, double height) {
  return must({.type = ShapeType::cylinder, .radius = radius, .height = height});
}
inline std::shared_ptr<const Shape> box(const Vec3& half) {
  return must({.type = ShapeType::box, .half_extents = half});
}
inline std::shared_ptr<const Shape> ellipsoid(const Vec3& semi_axes) {
  return must({.type = ShapeType::ellipsoid, .half_extents = semi_axes});
}
inline std::shared_ptr<const Shape> half_space() {
  return must({.type = ShapeType::half_space});
}
inline std::shared_ptr<const Shape> mesh(TriangleMesh m) {
  return must({.type = ShapeType::triangle_mesh,
               .mesh = std::make_shared<const TriangleMesh>(std::move(m))});
}
inline std::shared_ptr<const Shape> hull(std::vector<Vec3> points) {
  auto m = std::make_shared<TriangleMesh>();
  m->vertices = std::move(points);
  return must({.type = ShapeType::convex_hull, .mesh = m});
}
inline std::shared_ptr<const Shape> cone(double radius, double height) {
  return must({.type = ShapeType::cone, .radius = radius, .height = height});
}
inline std::shared_ptr<const Shape> tapered_capsule(double radius, double top_radius,
                                                    double height) {
  return must({.type = ShapeType::tapered_capsule,
               .radius = radius,
               .height = height,
               .top_radius = top_radius});
}
/// One of every convex type of all_shapes() that is said by numbers, sizes drawn with one seed.
inline std::vector<std::shared_ptr<const Shape>> every_solid() {
  Random r(600);
  std::vector<std::shared_ptr<const Shape>> out;
  for (const ShapeEntry& entry : all_shapes())
    if (entry.family == ShapeFamily::convex && !entry.parameters.empty())
      out.push_back(must(draw_def(r, entry)));
  return out;
}
/// Hull of n random points on an ellipsoid with the given semi-axes.
inline std::shared_ptr<const Shape> random_hull(Random& r, int n, const Vec3& axes) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) points.push_back(random_direction(r).cwiseProduct(axes));
  return hull(std::move(points));
}

}  // namespace tumble::test
