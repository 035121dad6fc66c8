// Contacts of primitives. References in long double: depth as the least overlap over the cross
// products of all differences of corners (a superset of the facets' normals, by another route than
// the engine's), and properties that a witness must have: each point on its shape, their
// difference depth times normal, and no way out that is shorter in random directions. Resolution
// 1e-15 of the size; the promise is 1e-12.
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/primitive_tests/primitive_tests.hpp"
#include "tests/geometry/draws.hpp"
#include "tests/support/dense3.hpp"

#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

using Wide = Vector3<long double>;
using Corners = std::vector<Vec3>;

Corners corners_of(const OrientedBox& b) {
  Corners out;
  for (int c = 0; c < 8; ++c) {
    out.push_back(b.centre + b.half_axes * Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1));
  }
  return out;
}
Corners corners_of(const Triangle3& t) {
  return {t[0], t[1], t[2]};
}
Corners corners_of(const Segment& s) {
  return {s.a, s.b};
}

/// How far b must move along the unit vector n so as to leave a.
long double overlap(const Corners& a, const Corners& b, const Wide& n) {
  long double most = -1e30L, least = 1e30L;
  for (const Vec3& p : a) most = std::max(most, n.dot(p.cast<long double>()));
  for (const Vec3& p : b) least = std::min(least, n.dot(p.cast<long double>()));
  return most - least;
}

long double least_overlap(const Corners& a, const Corners& b) {
  std::vector<Wide> sides;
  for (const Corners* set : {&a, &b}) {
    for (size_t i = 0; i < set->size(); ++i) {
      for (size_t j = 0; j < i; ++j) sides.push_back(((*set)[i] - (*set)[j]).cast<long double>());
    }
  }
  long double least = 1e30L;
  for (size_t i = 0; i < sides.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      const Wide axis = sides[i].cross(sides[j]);
      const long double length = axis.norm();
      if (!(length > 1e-15L * sides[i].norm() * sides[j].norm())) continue;
      const Wide n = axis / length;
      least = std::min({least, overlap(a, b, n), overlap(a, b, Wide(-n))});
    }
  }
  return least;
}

/// Distance of p from a shape.
double distance(const Vec3& p, const Segment& s) {
  return (p - closest_on_segment(p, s.a, s.b).point).norm();
}
/// In long double with two steps of refinement, for slivers.
double distance(const Vec3& p, const Triangle3& t) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < 3; ++k)
    least = std::min(least, distance(p, Segment{t[k], t[(k + 1) % 3]}));
  const Wide u = (t[1] - t[0]).cast<long double>(), v = (t[2] - t[0]).cast<long double>();
  const Wide n = u.cross(v), w = (p - t[0]).cast<long double>();
  long double x = 0, y = 0;
  for (int step = 0; step < 3; ++step) {
    const Wide rest = w - x * u - y * v;
    x += rest.cross(v).dot(n) / n.squaredNorm();
    y += u.cross(rest).dot(n) / n.squaredNorm();
  }
  if (x > 0 && y > 0 && x + y < 1) least = std::min(least, double((w - x * u - y * v).norm()));
  return least;
}
double distance(const Vec3& p, const OrientedBox& b) {
  const Vec3 s = solve(b.half_axes, p - b.centre);
  return (b.half_axes * (s - s.cwiseMax(-1).cwiseMin(1))).norm();
}

/// Within 1e-12 of everything that is promised.
template <class A, class B>
void check_contact(const A& a, const B& b, const PrimitiveContact& c, double size, Random& random) {
  const Corners ca = corners_of(a), cb = corners_of(b);
  const double tolerance = 1e-12 * size;
  REQUIRE(std::fabs(c.normal.norm() - 1) < 1e-14);
  REQUIRE(c.depth >= 0);
  REQUIRE(std::fabs(double(least_overlap(ca, cb)) - c.depth) < tolerance);
  REQUIRE(std::fabs(double(overlap(ca, cb, c.normal.cast<long double>())) - c.depth) < tolerance);
  REQUIRE((c.on_a - c.on_b - c.depth * c.normal).norm() < tolerance);
  REQUIRE(distance(c.on_a, a) < tolerance);
  REQUIRE(distance(c.on_b, b) < tolerance);
  for (int k = 0; k < 4; ++k) {
    const Wide n = draws::direction(random).cast<long double>();
    REQUIRE(double(overlap(ca, cb, n / n.norm())) > c.depth - tolerance);
  }
}

OrientedBox any_box(Random& r, int kind, double size) {
  OrientedBox out;
  const Vec3 half(r.uniform(0.1, 1), r.uniform(0.1, 1), r.uniform(0.1, 1));
  const Quat q = kind % 4 == 1 ? Quat::Identity() : draws::rotation(r);
  out.half_axes = size * q.toRotationMatrix() * half.asDiagonal();
  if (kind % 4 == 2) out.half_axes.col(1) += 0.5 * out.half_axes.col(0);  // sheared
  out.centre = size * draws::in_box(r, 0.8);
  return out;
}

/// A rotation by 1e-16 to 1e-3.
Mat3 slight_turn(Random& r) {
  const Vec3 half = 0.5 * std::pow(10.0, r.uniform(-16, -3)) * draws::direction(r);
  return Quat(1, half.x(), half.y(), half.z()).normalized().toRotationMatrix();
}

}  // namespace

TEST_CASE("contacts of boxes: depth, normal and witnesses") {
  Random random(400);
  int hits = 0;
  const int n = draws::count(20000);
  for (int i = 0; i < n; ++i) {
    const double size = i % 16 < 14 ? 1 : (i % 16 == 14 ? 1e-3 : 1e3);
    const OrientedBox a = any_box(random, i, size);
    OrientedBox b = any_box(random, i / 4, size);
    switch (i / 16 % 6) {
      case 0:  // the same axes
        b.half_axes = a.half_axes * Vec3(0.5, 2, 1).asDiagonal();
        break;
      case 1:  // nearly the same axes
        b.half_axes = slight_turn(random) * a.half_axes;
        break;
      default:
        break;
    }
    const auto contact = box_box_contact(a, b);
    REQUIRE(contact.has_value() == boxes_intersect(a, b));
    hits += contact.has_value();
    if (contact) check_contact(a, b, *contact, 4 * size, random);
  }
  if (n > 1000) {
    CHECK(hits > n * 3 / 10);
    CHECK(hits < n * 9 / 10);
  }
}

TEST_CASE("contacts of triangles and segments with boxes and each other") {
  Random random(410);
  std::array<int, 4> hits{};
  const int n = draws::count(40000);
  for (int i = 0; i < n; ++i) {
    const OrientedBox box = any_box(random, i, 1);
    Triangle3 t = draws::triangle(random), u = draws::triangle(random);
    if (i % 8 == 1) t[2] = t[0] + std::pow(10.0, random.uniform(-12, -1)) * (t[2] - t[0]);
    if (i % 8 == 2) u[2] = 0.3 * u[0] + 0.7 * u[1] + 1e-6 * draws::direction(random);
    if (i % 8 == 3) u = {t[0], t[1], u[2]};  // a shared side
    if (i % 8 == 4) {                        // nearly coplanar
      for (Vec3& p : u) p = t[0] + p.x() * (t[1] - t[0]) + p.y() * (t[2] - t[0]);
    }
    const Segment s{u[0], u[1]};
    if (const auto c = box_triangle_contact(box, t)) {
      check_contact(box, t, *c, 4, random);
      ++hits[0];
    }
    if (const auto c = segment_box_contact(s, box)) {
      check_contact(s, box, *c, 4, random);
      ++hits[1];
    }
    if (const auto c = triangle_triangle_contact(t, u)) {
      check_contact(t, u, *c, 4, random);
      ++hits[2];
    }
    if (const auto c = segment_triangle_contact(s, t)) {
      check_contact(s, t, *c, 4, random);
      ++hits[3];
    }
  }
  for (const int h : hits) CHECK((n < 1000 || h > n / 50));
}

TEST_CASE("contacts of shapes without extent have depth 0 where they meet") {
  const Segment a{Vec3(-1, 0, 0), Vec3(1, 0, 0)}, b{Vec3(0.5, -1, 0), Vec3(0.5, 2, 0)};
  const auto crossing = edge_edge_contact(a, b);
  REQUIRE(crossing);
  CHECK(crossing->depth == 0);
  CHECK(std::fabs(crossing->normal.z()) == 1);
  CHECK(crossing->on_a == Vec3(0.5, 0, 0));
  CHECK(crossing->on_b == Vec3(0.5, 0, 0));
  const auto collinear = edge_edge_contact(a, {Vec3(1, 0, 0), Vec3(5, 0, 0)});
  REQUIRE(collinear);
  CHECK(collinear->depth == 0);
  CHECK(std::fabs(collinear->normal.x()) < 1e-15);
  CHECK((collinear->on_a - Vec3(1, 0, 0)).norm() < 1e-15);
  const auto points = edge_edge_contact(Segment{a.a, a.a}, Segment{a.a, a.a});
  REQUIRE(points);
  CHECK(points->normal == Vec3::UnitY());
  CHECK_FALSE(edge_edge_contact(a, {Vec3(1.5, 0, 0), Vec3(5, 0, 0)}));
  const Triangle3 t{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)};
  const auto flat = triangle_triangle_contact(t, {Vec3(1, 1, 0), Vec3(3, 1, 0), Vec3(1, 3, 0)});
  REQUIRE(flat);
  CHECK(flat->depth == 0);
  CHECK(std::fabs(flat->normal.z()) == 1);
}

namespace {

/// A sphere's contact: points on the line of the normal, the nearest point of the other shape as
/// long double gives it.
template <class Shape>
void check_ball(const Sphere& s, const Shape& shape, const PrimitiveContact& c, double size,
                const Wide& from_shape) {
  const double tolerance = 1e-12 * size;
  const long double d = from_shape.norm();
  REQUIRE(std::fabs(c.normal.norm() - 1) < 1e-14);
  REQUIRE(std::fabs(double(s.radius - d) - c.depth) < tolerance);
  REQUIRE((c.on_a - (s.centre + s.radius * c.normal)).norm() < tolerance);
  REQUIRE((c.on_a - c.on_b - c.depth * c.normal).norm() < tolerance);
  REQUIRE(distance(c.on_b, shape) < tolerance);
  REQUIRE((c.normal + (from_shape / d).template cast<double>()).norm() < 1e-12);
}

}  // namespace

TEST_CASE("contacts of spheres: the normal is right also next to the surface") {
  Random random(420);
  int hits = 0;
  const int n = draws::count(60000);
  for (int i = 0; i < n; ++i) {
    // The nearest point and the outward direction are chosen first, the centre along it, so the
    // answer is known: over a face, beside an edge, at a corner. All numbers are dyadic with few
    // bits, so that nothing rounds.
    const auto few = [&](int bits) { return double(int(random.below(2u << bits)) - (1 << bits)); };
    const Vec3 a(few(6), few(6), few(6)), u(few(6), few(6), few(6)), v(few(6), few(6), few(6));
    const Vec3 face = u.cross(v);
    if (face.isZero(0)) continue;
    const Triangle3 t{a, a + 4 * u, a + 4 * v};
    const int kind = i % 3;
    Vec3 nearest = a + u + v, out = face;
    if (kind == 1) {  // beside the side along u: away from v and up
      nearest = a + u;
      out = face - 0x1p-4 * face.cross(u);  // face x u points to the inner side of u
    }
    if (kind == 2) {  // beyond corner a
      nearest = a;
      if (u.dot(v) < 0) continue;
      out = face - double(1 << 6) * (u + v);
      if (out.dot(u) > 0 || out.dot(v) > 0) continue;
    }
    const int power = -int(random.below(34)) - 10;
    const Vec3 offset = std::ldexp(1.0, power) * out;
    const Vec3 centre = nearest + offset;
    if ((centre - nearest) != offset) continue;
    const double size = 1024 + offset.norm();
    const Sphere s{centre, offset.norm() * random.uniform(1.001, 3)};
    const auto c = sphere_triangle_contact(s, t);
    REQUIRE(c);
    check_ball(s, t, *c, size, offset.cast<long double>());
    ++hits;
    if (kind == 1) {
      const Segment side{t[0], t[1]};
      const auto along = segment_sphere_contact(side, s);
      REQUIRE(along);
      check_ball(s, side, *along, size, offset.cast<long double>());
    }
  }
  CHECK((n < 1000 || hits > n / 3));
}

TEST_CASE("contacts of spheres with boxes and spheres, centres inside and on the surface") {
  Random random(430);
  int inside = 0, outside = 0;
  const int n = draws::count(20000);
  for (int i = 0; i < n; ++i) {
    const OrientedBox box = any_box(random, i, 1);
    const Sphere s{draws::in_box(random, 1.5), random.uniform(0.1, 1)};
    const auto c = sphere_box_contact(s, box);
    REQUIRE(c.has_value() == sphere_box_intersect(s, box));
    if (!c) continue;
    const bool within = point_in_box(s.centre, box);
    ++(within ? inside : outside);
    REQUIRE((c->on_a - c->on_b - c->depth * c->normal).norm() < 4e-12);
    REQUIRE((c->on_a - s.centre - s.radius * c->normal).norm() < 4e-12);
    // Moved by the depth the ball no longer meets the box, by a little less it still does.
    OrientedBox moved = box;
    moved.centre = box.centre + (c->depth + 4e-12) * c->normal;
    REQUIRE_FALSE(sphere_box_intersect(s, moved));
    moved.centre = box.centre + (c->depth - 4e-12) * c->normal;
    REQUIRE(sphere_box_intersect(s, moved));
    REQUIRE(distance(c->on_b, box) < 4e-12);
    if (within) {
      REQUIRE(c->depth >= s.radius);
      const Segment point{s.centre, s.centre};
      REQUIRE(std::fabs(double(least_overlap(corners_of(box), corners_of(point))) -
                        (c->depth - s.radius)) < 4e-12);
    }
  }
  CHECK((n < 1000 || (inside > n / 25 && outside > n / 6)));
  const auto concentric = sphere_sphere_contact({Vec3(1, 2, 3), 2}, {Vec3(1, 2, 3), 1});
  REQUIRE(concentric);
  CHECK(concentric->normal == Vec3::UnitY());
  CHECK(concentric->depth == 3);
  const auto spheres = sphere_sphere_contact({Vec3(0, 0, 0), 2}, {Vec3(3, 0, 0), 1.5});
  REQUIRE(spheres);
  CHECK(spheres->depth == 0.5);
  CHECK(spheres->on_a == Vec3(2, 0, 0));
  CHECK(spheres->on_b == Vec3(1.5, 0, 0));
  const Triangle3 t{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)};
  const auto centred = sphere_triangle_contact({Vec3(0.5, 0.5, 0), 1}, t);
  REQUIRE(centred);
  CHECK(centred->normal == -Vec3::UnitZ());  // the ball leaves on the outer side
  CHECK(centred->depth == 1);
  CHECK_FALSE(sphere_triangle_contact({Vec3(0.5, 0.5, 0), -1}, t));
  CHECK(sphere_triangle_contact({Vec3(0.5, 0.5, 0), 0}, t)->depth == 0);
}
