// Convex hulls of hard families of points. References: check_hull (itself tested against brute
// force and damaged hulls below); the nearest of all triangles of the hull in extended precision,
// for the distance of points left outside; closed forms.
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/hull/plane_tree.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/geometry/hull_families.hpp"
#include "tests/support/why_not.hpp"

#include <cstring>

#include <doctest/doctest.h>

using namespace tumble;
using hull_families::Points;

namespace {

using Long3 = Vector3<long double>;

/// Distance from the nearest point of a triangle, which may be a sliver: weights of the corners are
/// found along its longest side and across, and refined by what is left, so that the answer is
/// never too small and as good as extended precision has the coordinates.
long double distance_to(std::array<Long3, 3> t, const Long3& p) {
  long double nearest = std::numeric_limits<long double>::infinity();
  for (size_t k = 0; k < 3; ++k) {
    const Long3 side = t[(k + 1) % 3] - t[k], from = p - t[k];
    const long double along = std::clamp(side.dot(from) / side.squaredNorm(), 0.0L, 1.0L);
    nearest = std::min(nearest, (from - along * side).norm());
  }
  for (int k = 0; k < 2; ++k) {
    const long double first = (t[1] - t[0]).norm();
    if (first < (t[2] - t[1]).norm() || first < (t[0] - t[2]).norm()) {
      std::rotate(t.begin(), t.begin() + 1, t.end());
    }
  }
  const Long3 u = t[1] - t[0], e = u.normalized(), w = t[2] - t[0], across = w - w.dot(e) * e;
  long double s = 0, r = 0;
  Long3 rest = p - t[0];
  for (int i = 0; i < 6; ++i) {
    const long double dr = across.dot(rest) / across.squaredNorm();
    s += (rest.dot(e) - dr * w.dot(e)) / u.norm();
    r += dr;
    rest = p - t[0] - s * u - r * w;
  }
  return s >= 0 && r >= 0 && s + r <= 1 ? std::min(nearest, rest.norm()) : nearest;
}

/// Furthest distance of the points from the hull [m].
double furthest_outside(const ConvexPolyhedron& hull, const Points& points) {
  const TriangleMesh mesh = to_mesh(hull);
  long double furthest = 0;
  for (const Vec3& p : points) {
    double above = 0;
    for (const Plane& plane : hull.planes) above = std::max(above, plane.distance(p));
    if (above <= 0) continue;
    long double nearest = std::numeric_limits<long double>::infinity();
    for (const Triangle& t : mesh.triangles) {
      const auto corner = [&](uint32_t v) -> Long3 { return mesh.vertices[v].cast<long double>(); };
      nearest = std::min(
          nearest, distance_to({corner(t[0]), corner(t[1]), corner(t[2])}, p.cast<long double>()));
    }
    furthest = std::max(furthest, nearest);
  }
  return double(furthest);
}

/// Either a valid hull that holds every point, or a refusal that says what the points are.
bool valid_or_refused(const std::string& name, const Points& points, const HullOptions& options) {
  const auto hull = convex_hull(points, options);
  if (!hull.ok()) {
    const std::string& why = hull.error().message;
    const bool thin = why.find("flat") != why.npos || why.find("collinear") != why.npos ||
                      why.find("coincide") != why.npos;
    CHECK_MESSAGE(thin, name, ": ", why);
    return false;
  }
  const Status valid = check_hull(hull->polyhedron, points, hull->tolerance);
  CHECK_MESSAGE(valid.ok(), name, ": ", test::why_not(valid));
  const double outside = furthest_outside(hull->polyhedron, points);
  CHECK_MESSAGE(outside <= 1.02 * hull->tolerance, name, ": a point is ", outside, " m away");
  return true;
}

bool same_bits(const ConvexHull& a, const ConvexHull& b) {
  return a.source == b.source && a.polyhedron.face_vertices == b.polyhedron.face_vertices &&
         a.polyhedron.planes.size() == b.polyhedron.planes.size() &&
         std::memcmp(a.polyhedron.planes.data(), b.polyhedron.planes.data(),
                     a.polyhedron.planes.size() * sizeof(Plane)) == 0;
}

}  // namespace

TEST_CASE("hull of every hard family is valid at every tolerance, place and size, or refused") {
  Random random(21);
  int built = 0, refused = 0;
  for (int i = 0; i < draws::count(1000); ++i) {
    for (const auto& family : hull_families::all()) {
      const double noise = std::pow(10.0, random.uniform(-17, -6));
      auto points = family.draw(random, 4 + random.below(60), noise);
      const uint32_t change = random.below(6);
      const Quat turn = draws::rotation(random);
      const Vec3 move = draws::in_box(random, std::pow(10.0, random.uniform(0, 8)));
      const double scale = std::pow(10.0, random.uniform(-30, 30));
      for (Vec3& p : points) {
        if (change == 1 || change == 2) p = turn * p;
        if (change == 2 || change == 3) p += move;
        if (change == 4) p *= scale;
        if (change == 5) p = p.cast<float>().cast<double>();
      }
      const double tolerance = std::array{0.0, 1e-12, 1e-9, 1e-6, 1e-3}[random.below(5)];
      (valid_or_refused(family.name, points, {tolerance}) ? built : refused) += 1;
    }
  }
  CHECK(built > refused);
  CHECK(refused > built / 20);
}

TEST_CASE("a point beyond a sharp edge is kept, though near the planes of both its faces") {
  // At a wedge of 1e-8 a point within 1e-9 of both planes may be 0.1 away from the hull.
  Random random(22);
  for (int i = 0; i < draws::count(200); ++i) {
    Points points = {{1, -1, 1e-8}, {1, 1, 1e-8}, {1, -1, -1e-8}, {1, 1, -1e-8}};
    for (int k = 0; k < 20; ++k)
      points.emplace_back(-0.05 * random.uniform(), 0.9 * random.uniform(-1, 1), 0);
    points.emplace_back(0, -1, 0);
    points.emplace_back(0, 1, 0);
    CHECK(valid_or_refused("wedge", points, {}));
  }
}

TEST_CASE("hulls of the same points are the same bits") {
  Random random(23);
  for (const auto& family : hull_families::all()) {
    const Points points = family.draw(random, 200, 1e-8);
    const auto a = convex_hull(points, {}), b = convex_hull(points, {});
    REQUIRE(a.ok() == b.ok());
    if (a.ok()) CHECK(same_bits(*a, *b));
  }
}

TEST_CASE("a fine cylinder with points in random places costs about as much as a ball") {
  // One end may not be refined before the other: its corners would see all sides of the other.
  Random random(24);
  Points points;
  for (int i = 0; i < 20000; ++i) {
    points.push_back(hull_families::on_circle(random.uniform(), random.below(2)));
  }
  const auto hull = convex_hull(points, {});
  REQUIRE(hull.ok());
  CHECK(check_hull(hull->polyhedron, points, hull->tolerance).ok());
  CHECK(hull->polyhedron.vertices.size() > 15000);
}

TEST_CASE("what a hull cannot be made of is refused with limits") {
  const auto message = [](const Points& points, const HullOptions& options = {}) {
    const auto hull = convex_hull(points, options);
    return hull.ok() ? std::string() : hull.error().text();
  };
  Points box = make_mesh::box(Vec3(1, 1, 1)).vertices;
  const auto scaled = [&](double s) {
    Points out = box;
    for (Vec3& p : out) p *= s;
    return out;
  };
  CHECK(message(box).empty());
  CHECK(message(scaled(1e39)).empty());
  CHECK(message(scaled(1e-39)).empty());
  CHECK(message(scaled(1e41)).find("1e+41 m") != std::string::npos);
  CHECK(message(scaled(1e300)).find("1e+300 m") != std::string::npos);
  CHECK(message(scaled(1e-41)).find("1e-41 m") != std::string::npos);
  CHECK(message(scaled(0)).find("coincide") != std::string::npos);
  for (const double bad : {-1e-9, 0.1, double(NAN), double(INFINITY)}) {
    CHECK(message(box, {bad}).find("relative tolerance") != std::string::npos);
  }
  for (const double thickness : {0.0, 1e-16, 1e-14, 1e-12}) {
    Points slab = box;
    for (Vec3& p : slab) p.z() *= thickness;
    CHECK(message(slab).find("flat") != std::string::npos);
  }
  Points thin = box;
  for (Vec3& p : thin) p.z() *= 1e-12;
  CHECK(message(thin, {0.0}).empty());
  box[3].y() = -INFINITY;
  CHECK(message(box).find("point 3") != std::string::npos);
}

TEST_CASE("the tree of planes finds the planes that trying all finds") {
  Random random(25);
  int outside = 0, cases = 0;
  for (int i = 0; i < draws::count(20); ++i) {
    Points points;
    const Vec3 at = i % 2 ? Vec3(draws::in_box(random, 1e4)) : Vec3::Zero();
    for (int k = 0; k < 300; ++k) points.push_back(at + draws::direction(random));
    const auto hull = convex_hull(points, {});
    REQUIRE(hull.ok());
    const auto& planes = hull->polyhedron.planes;
    Points touched;
    for (size_t f = 0; f < planes.size(); ++f) {
      touched.push_back(hull->polyhedron.vertices[hull->polyhedron.face(f)[0]]);
    }
    const PlaneTree tree(planes, touched);
    for (int k = 0; k < 500; ++k) {
      const Vec3 p = at + draws::direction(random) * random.uniform(0.95, 1.01);
      for (const double epsilon : {0.0, 1e-3}) {
        uint32_t first = no_index;
        for (uint32_t f = uint32_t(planes.size()); f-- > 0;) {
          if (planes[f].distance(p) > epsilon) first = f;
        }
        CHECK(tree.first_outside(p, epsilon) == first);
        outside += first != no_index;
        ++cases;
      }
    }
  }
  CHECK(outside > cases / 10);
  CHECK(outside < 9 * cases / 10);
}

TEST_CASE("the check names every damage to a hull") {
  const auto made = convex_hull(make_mesh::icosphere(1, 2).vertices, {});
  REQUIRE(made.ok());
  const auto refuses = [&](const auto& damage) {
    ConvexPolyhedron hull = made->polyhedron;
    damage(hull);
    return !check_hull(hull, {}, made->tolerance).ok();
  };
  CHECK_FALSE(refuses([](ConvexPolyhedron&) {}));
  CHECK(refuses([](ConvexPolyhedron& h) { h.half_edge_twin[3] = no_index; }));
  CHECK(refuses([](ConvexPolyhedron& h) { std::swap(h.half_edge_twin[3], h.half_edge_twin[9]); }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.half_edge_face[5] = 0; }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.face_vertices[7] = 100000; }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.face_first[2] = 100000; }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.edges.pop_back(); }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.neighbours.pop_back(); }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.planes[4].normal *= 2; }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.planes[4].offset += 1e-6; }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.planes[4].normal.x() = NAN; }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.vertices[6] *= 0.9; }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.vertices[6] *= 1.1; }));
  CHECK(refuses([](ConvexPolyhedron& h) { h.vertices[6].y() = NAN; }));
  CHECK(refuses([](ConvexPolyhedron& h) { h = ConvexPolyhedron(); }));
  const Vec3 inside = 0.9 * Vec3::UnitX(), outside = 1.1 * Vec3::UnitX(), odd(NAN, 0, 0);
  CHECK(check_hull(made->polyhedron, {&inside, 1}, made->tolerance).ok());
  CHECK_FALSE(check_hull(made->polyhedron, {&outside, 1}, made->tolerance).ok());
  CHECK_FALSE(check_hull(made->polyhedron, {&odd, 1}, made->tolerance).ok());
}
