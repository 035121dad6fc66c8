// Contacts with distance fields. References: support functions over a plane; dense samples of
// solids; the distance of meshes by brute force over all pairs of triangles (closed-form closest
// points), to the error that the field states; closed forms for a groove, a tip under a face and
// two crossed plates; the triangle routines themselves where a query asks for triangles.
#include "engine/collision/field_pairs/convex_in_field.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/query.hpp"
#include "engine/collision/shape_near.hpp"
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/support.hpp"

#include <algorithm>
#include <limits>

using namespace tumble;
using namespace tumble::test;

namespace {

std::shared_ptr<const Shape> field_of(TriangleMesh m, double cell = 0) {
  return must({.type = ShapeType::distance_field,
               .cell = cell,
               .mesh = std::make_shared<const TriangleMesh>(std::move(m))});
}

double stated_error(const Shape& s) {
  return s.field()->report().band_error;
}

std::vector<Manifold> touch(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb,
                            double margin) {
  std::vector<Manifold> out;
  collide(a, pa, b, pb, margin, out);
  return out;
}

std::vector<ManifoldPoint> all_points(const std::vector<Manifold>& list) {
  std::vector<ManifoldPoint> out;
  for (const Manifold& m : list) {
    CHECK(std::abs(m.normal.norm() - 1) < 1e-9);
    for (const ManifoldPoint& p : m.used()) out.push_back(p);
  }
  return out;
}

double least_gap(const std::vector<Manifold>& list) {
  double least = std::numeric_limits<double>::infinity();
  for (const ManifoldPoint& p : all_points(list)) least = std::min(least, p.gap);
  return least;
}

/// By all pairs of triangles [m].
double mesh_distance(const TriangleMesh& a, const Pose& pa, const TriangleMesh& b, const Pose& pb) {
  double best = std::numeric_limits<double>::infinity();
  const TriangleMesh wa = transformed(a, pa), wb = transformed(b, pb);
  for (size_t i = 0; i < wa.triangles.size(); ++i)
    for (size_t j = 0; j < wb.triangles.size(); ++j) {
      const Aabb x = triangle_bounds(wa, i), y = triangle_bounds(wb, j);
      if (!x.inflated(std::min(4.0, best)).overlaps(y)) continue;
      best = std::min(best, std::sqrt(closest_triangle_triangle(
                                          {wa.corner(i, 0), wa.corner(i, 1), wa.corner(i, 2)},
                                          {wb.corner(j, 0), wb.corner(j, 1), wb.corner(j, 2)})
                                          .squared_distance));
    }
  return best;
}

/// Two walls that meet at the bottom at a right angle, in a block 2 m wide and 4 m long.
TriangleMesh groove() {
  TriangleMesh m;
  const double ys[] = {-1, -1, 0.8, 0, 0.8};
  const double xs[] = {-1, 1, 1, 0, -1};  // x = +-1 at the top, 45 degrees and a little less
  for (const double z : {-2.0, 2.0})
    for (int i = 0; i < 5; ++i) m.vertices.push_back({xs[i], ys[i], z});
  for (uint32_t i = 0; i < 5; ++i) {
    const uint32_t j = (i + 1) % 5;
    m.triangles.push_back({i, i + 5, j});
    m.triangles.push_back({j, i + 5, j + 5});
  }
  for (const std::array<uint32_t, 3>& t :
       {std::array<uint32_t, 3>{0, 1, 3}, {1, 2, 3}, {0, 3, 4}}) {
    m.triangles.push_back({t[0], t[1], t[2]});
    m.triangles.push_back({t[0] + 5, t[2] + 5, t[1] + 5});
  }
  double volume = 0;
  for (size_t t = 0; t < m.triangles.size(); ++t)
    volume += m.corner(t, 0).dot(m.corner(t, 1).cross(m.corner(t, 2)));
  if (volume < 0)
    for (Triangle& t : m.triangles) std::swap(t[1], t[2]);
  return m;
}

}  // namespace

TEST_CASE("solids on a field of a slab: depth and normal of the plane, whichever way they lie") {
  const auto slab = field_of(make_mesh::box({3, 0.5, 3}));
  const double hair = 4 * slab->field()->report().node_error;
  Random r(41);
  std::vector<std::shared_ptr<const Shape>> solids = every_solid();
  solids.push_back(random_hull(r, 20, {0.4, 0.3, 0.5}));
  for (const auto& solid : solids)
    for (int i = 0; i < cases(12); ++i) {
      CAPTURE(solid->words());
      CAPTURE(i);
      const double scale = solid->bounding_radius();
      if (scale > 2) continue;
      Pose at{{r.uniform(-0.5, 0.5), 0, r.uniform(-0.5, 0.5)}, random_rotation(r)};
      if (i == 0) at.q = Quat::Identity();
      const double gap = r.uniform(-0.02, 0.01);
      const ConvexShape& c = *solid->convex();
      const Vec3 down = at.inverse_direction(-Vec3::UnitY());
      at.x.y() = 0.5 + gap + down.dot(c.support(down)) + c.rounding();
      const auto found = touch(*solid, at, *slab, Pose{}, 0.02);
      REQUIRE(!found.empty());
      CHECK(std::abs(least_gap(found) - gap) < hair + 1e-4 * scale * scale);
      for (const Manifold& m : found)
        if (m.points[0].gap <= least_gap(found) + hair) CHECK(m.normal.y() < -0.999);
      for (const ManifoldPoint& p : all_points(found)) CHECK(std::abs(p.x_world.y() - 0.5) < 0.02);
    }
}

TEST_CASE("what lies flat on a field has four points, as on a plane") {
  const auto slab = field_of(make_mesh::box({3, 0.5, 3}));
  const auto cube = box({0.3, 0.2, 0.4});
  for (const auto& solid : {cube, cylinder(0.3, 0.4), field_of(make_mesh::box({0.3, 0.2, 0.4}))}) {
    const Pose at{{0.21, 0.7 - 1e-4, -0.13}, axis_angle(Vec3::UnitY(), 0.3)};
    const auto found = touch(*solid, at, *slab, Pose{}, 0.01);
    REQUIRE(found.size() == 1);
    CHECK(found[0].count == 4);
    const double hair = 4 * slab->field()->report().node_error;
    for (const ManifoldPoint& p : found[0].used()) {
      CHECK(std::abs(p.gap + 1e-4) < 2 * hair);
      const Vec3 local = at.inverse_point(p.x_world);
      CHECK(std::hypot(local.x(), local.z()) > 0.29);
    }
  }
  // The capsule's two ends.
  const auto lying = touch(*capsule(0.2, 0.8), {{0, 0.7, 0}, axis_angle(Vec3::UnitZ(), M_PI / 2)},
                           *slab, Pose{}, 0.01);
  REQUIRE(lying.size() == 1);
  CHECK(lying[0].count == 2);
}

TEST_CASE("distances of fields and meshes: brute force, to the error the field states") {
  Random r(42);
  const TriangleMesh ring = make_mesh::torus(0.5, 0.2, 24, 12);
  const TriangleMesh block = make_mesh::box({0.4, 0.3, 0.2});
  const auto ring_field = field_of(ring), block_field = field_of(block);
  const auto ring_mesh = mesh(ring), block_mesh = mesh(block);
  struct Meeting {
    std::shared_ptr<const Shape> a, b;
  };
  const std::vector<Meeting> meetings{
      {ring_field, ring_field}, {ring_mesh, ring_field},   {block_mesh, ring_field},
      {ring_mesh, block_field}, {block_field, ring_field}, {box({0.4, 0.3, 0.2}), ring_field}};
  for (const Meeting& m : meetings)
    for (int i = 0; i < cases(10); ++i) {
      CAPTURE(&m - meetings.data());
      CAPTURE(i);
      const Pose a{{0, 0, 0}, random_rotation(r)};
      Pose b{1.6 * random_direction(r), random_rotation(r)};  // apart
      const TriangleMesh &ta = *m.a->polyhedral()->surface().mesh,
                         &tb = *m.b->polyhedral()->surface().mesh;
      // Together until they are nearly touching, by brute force alone.
      const Vec3 way = b.x.normalized();
      for (int k = 0; k < 40; ++k) {
        const double d = mesh_distance(ta, a, tb, b);
        if (d < 0.012) break;
        b.x -= 0.8 * (d - 0.005) * way;
      }
      const double exact = mesh_distance(ta, a, tb, b);
      const double error = std::max(m.a->field() ? stated_error(*m.a) : 0, stated_error(*m.b));
      const double margin = exact + error;
      const auto found = touch(*m.a, a, *m.b, b, margin);
      REQUIRE(!found.empty());
      CHECK(std::abs(least_gap(found) - exact) < error);
      CHECK(least_gap(found) > exact - 0.35 * error);  // what is seen in practice
      CHECK(least_gap(found) < exact + 0.35 * error);
      // Not found where they are farther apart than the margin and the error.
      double known = 0;
      ContactQuery query(0.2 * exact);
      query.apart = &known;
      std::vector<Manifold> none;
      if (0.2 * exact < exact - error) {
        collide(*m.a, a, *m.b, b, query, none);
        CHECK(none.empty());
        CHECK(known <= exact);
      }
    }
}

TEST_CASE("contacts are the same from either side, and from call to call") {
  Random r(43);
  const auto ring = field_of(make_mesh::torus(0.5, 0.2, 24, 12));
  const std::vector<std::shared_ptr<const Shape>> others{
      sphere(0.2), box({0.3, 0.2, 0.2}), cylinder(0.2, 0.5), mesh(make_mesh::icosphere(0.3, 2)),
      field_of(make_mesh::box({0.3, 0.2, 0.2}))};
  for (const auto& other : others)
    for (int i = 0; i < cases(10); ++i) {
      const Pose a{{0.1, 0.2, 0.3}, random_rotation(r)};
      const Pose b{a.x + 0.6 * random_direction(r), random_rotation(r)};
      const auto one = touch(*ring, a, *other, b, 0.02), two = touch(*other, b, *ring, a, 0.02);
      const auto again = touch(*ring, a, *other, b, 0.02);
      REQUIRE(one.size() == two.size());
      REQUIRE(one.size() == again.size());
      if (one.empty()) continue;
      CHECK(std::abs(least_gap(one) - least_gap(two)) < 1e-12);
      for (size_t k = 0; k < one.size(); ++k) {
        CHECK(one[k].normal == again[k].normal);
        CHECK(one[k].part == again[k].part);
      }
    }
}

TEST_CASE("a ball in a groove touches both walls, a rod too") {
  const auto walls = field_of(groove());
  const double slope = std::atan2(0.8, 1.0), r = 0.15;
  const double height = r / std::cos(slope) - 1e-3;
  const auto found = touch(*sphere(r), {{0, height, 0.3}, Quat::Identity()}, *walls, Pose{}, 0.01);
  REQUIRE(found.size() == 2);
  for (const Manifold& m : found) {
    CHECK(m.count == 1);
    CHECK(m.points[0].gap == doctest::Approx(-1e-3 * std::cos(slope)).epsilon(0.05));
    CHECK(std::abs(std::abs(m.normal.x()) - std::sin(slope)) < 0.01);
  }
  const auto rod = touch(*capsule(r, 1), {{0, height, 0}, axis_angle(Vec3::UnitX(), M_PI / 2)},
                         *walls, Pose{}, 0.01);
  REQUIRE(rod.size() == 2);
  for (const Manifold& m : rod) CHECK(m.count == 2);
}

/// The least value of a field over a placed convex solid: points between supports in even and
/// random directions, the best of them moved by chance as long as that leads down.
double deepest_in(const ConvexShape& c, const Pose& at, const DistanceField& field, Random& r) {
  double least = std::numeric_limits<double>::infinity();
  Vec3 best = Vec3::Zero();
  const auto offer = [&](const Vec3& p) {
    const double d = field.value(at.point(p));
    if (d < least) least = d, best = p;
  };
  const auto farthest = [&](const Vec3& u) { return Vec3(c.support(u) + c.rounding() * u); };
  for (int k = 0; k < 1500; ++k) {
    const Vec3 p = farthest(random_direction(r));
    offer(p);
    offer(p + r.uniform() * (farthest(random_direction(r)) - p));
  }
  double step = 0.2 * c.bounding_radius();
  for (int k = 0; k < 300; ++k, step *= 0.98) {
    const Vec3 p = best + step * random_direction(r);
    const SurfacePoint near = nearest_of(c, p);
    offer(near.distance > 0 ? near.x : p);
  }
  return least;
}

TEST_CASE(
    "the deepest place of a field over a convex solid: brute force, shallow, half sunk, deep") {
  Random r(45);
  const std::vector<TriangleMesh> meshes{make_mesh::torus(0.5, 0.2, 48, 24),
                                         make_mesh::box({0.5, 0.3, 0.4}),
                                         make_mesh::torus(0.5, 0.02, 96, 12)};
  const auto hull_of = [&](double size) { return random_hull(r, 12, Vec3::Constant(size)); };
  std::vector<FeatureContact> contacts;
  for (const TriangleMesh& m : meshes) {
    const auto shape = field_of(m);
    const DistanceField& field = *shape->field();
    const double tolerance = tolerances::deepest * field.cell();
    for (const double size : {0.02, 0.1})
      for (const auto& solid : {sphere(size), capsule(size, 4 * size), cylinder(size, 3 * size),
                                box({size, 2 * size, size}), hull_of(2 * size), sphere(1.3 * size)})
        for (const double sunk : {0.03, 0.95, 1.6}) {
          CAPTURE(&m - meshes.data());
          CAPTURE(solid->words());
          CAPTURE(sunk);
          const ConvexShape& c = *solid->convex();
          const auto t = size_t(r.uniform(0, double(m.triangles.size())));
          const Vec3 a = m.corner(t, 0), b = m.corner(t, 1), d = m.corner(t, 2);
          const Vec3 n = (b - a).cross(d - a).normalized();
          Pose at{(a + b + d) / 3, random_rotation(r)};
          const Vec3 down = at.inverse_direction(-n);
          at.x += (1 - sunk) * (down.dot(c.support(down)) + c.rounding()) * n;
          contacts.clear();
          convex_in_field(c, at, field, 1e-9, contacts);
          const double least = deepest_in(c, at, field, r);
          double found = 1e-9;
          for (const FeatureContact& k : contacts) {
            found = std::min(found, k.gap);
            const Vec3 p = k.x + 0.5 * k.gap * k.normal;  // of the solid, as deep as is said
            CHECK(nearest_of(c, at.inverse_point(p)).distance < 1e-9);
            CHECK(field.value(p) == doctest::Approx(k.gap).epsilon(1e-9));
          }
          CHECK(found < least + tolerance);
        }
  }
}

TEST_CASE("a tip under the middle of a face, and crossed plates, have contacts where they cross") {
  TriangleMesh tip = make_mesh::tetrahedron(0.3);
  const auto top = std::max_element(tip.vertices.begin(), tip.vertices.end(),
                                    [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  const Vec3 highest = *top;
  const auto peak = field_of(tip);
  for (const auto& plate : {box({1, 0.1, 1}), mesh(make_mesh::box({1, 0.1, 1})),
                            field_of(make_mesh::box({1, 0.1, 1}))}) {
    CAPTURE(plate->words());
    const Pose at{{0.1, highest.y() + 0.1 - 1e-3, 0.05}, Quat::Identity()};
    const auto found = touch(*plate, at, *peak, Pose{}, 0.002);
    REQUIRE(!found.empty());
    const auto points = all_points(found);
    const auto lowest = std::min_element(points.begin(), points.end(),
                                         [](auto& a, auto& b) { return a.gap < b.gap; });
    CHECK(lowest->gap == doctest::Approx(-1e-3).epsilon(0.02));
    CHECK((lowest->x_world - highest).norm() < 0.01);
  }
  const auto plank = field_of(make_mesh::box({1, 0.1, 0.2}));
  const auto found = touch(*plank, Pose{}, *plank,
                           {{0, 0.2 - 1e-3, 0}, axis_angle(Vec3::UnitY(), M_PI / 2)}, 0.01);
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].count == 4);
  for (const ManifoldPoint& p : found[0].used()) {
    CHECK(std::abs(std::abs(p.x_world.x()) - 0.2) < 0.03);
    CHECK(std::abs(std::abs(p.x_world.z()) - 0.2) < 0.03);
    CHECK(p.gap == doctest::Approx(-1e-3).epsilon(0.05));
  }
}

TEST_CASE("asked for triangles a field collides as its mesh does, bit by bit") {
  const TriangleMesh ring = make_mesh::torus(0.5, 0.2, 24, 12);
  const auto field = field_of(ring), triangles = mesh(ring);
  Random r(44);
  for (const auto& other : {sphere(0.2), box({0.3, 0.2, 0.2}), half_space()}) {
    const Pose a{{0, 0.1, 0}, random_rotation(r)}, b{{0.45, 0.1, 0}, random_rotation(r)};
    ContactQuery query(0.02);
    query.by_triangles = true;
    std::vector<Manifold> one, two;
    collide(*field, a, *other, b, query, one);
    collide(*triangles, a, *other, b, query, two);
    REQUIRE(one.size() == two.size());
    CHECK(!one.empty());
    for (size_t i = 0; i < one.size(); ++i) {
      CHECK(one[i].normal == two[i].normal);
      CHECK(one[i].points[0].gap == two[i].points[0].gap);
    }
  }
}

TEST_CASE("points that touch a field: the exact distance to the stated error, nothing is missed") {
  const auto ring = field_of(make_mesh::torus(0.5, 0.2, 48, 24));
  const Pose at{{1, 2, 3}, axis_angle(Vec3(1, 2, -1).normalized(), 0.8)};
  Random r(45);
  int near = 0;
  for (int i = 0; i < cases(3000); ++i) {
    const Vec3 x = at.x + random_vec(r, -0.9, 0.9);
    const auto exact = closest_point(*ring, at, x);
    REQUIRE(exact.has_value());
    const double reach = r.uniform(0, 0.1);
    const auto found = near_to_touch(*ring, at, x, reach);
    if (exact->distance < reach - stated_error(*ring)) CHECK(found.has_value());
    if (!found) continue;
    ++near;
    CHECK(std::abs(found->distance - exact->distance) < stated_error(*ring));
    CHECK(std::abs(found->normal.norm() - 1) < 1e-12);
    CHECK((x - found->distance * found->normal - found->x_world).norm() < 1e-9);
  }
  CHECK(near > 0);
}

TEST_CASE("only closed meshes have a field") {
  const auto made = make_shape({.type = ShapeType::distance_field,
                                .mesh = std::make_shared<const TriangleMesh>(
                                    make_mesh::terrain(1, 4, [](double, double) { return 0.0; }))});
  REQUIRE(!made.ok());
  CHECK(made.error().text().find("only a closed mesh") != std::string::npos);
}
