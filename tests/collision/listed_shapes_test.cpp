// Every shape of all_shapes() that is said by numbers, against the second definition of it in
// tests/support/shape_reference.hpp: supports, bounds, rays, nearest points, mass, contacts with
// half-spaces, features, elements, outlines and surfaces to draw. Resolutions are said where they
// are used.
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/query.hpp"
#include "engine/collision/shapes/convex_shape.hpp"
#include "tests/collision/support.hpp"
#include "tests/support/shape_reference.hpp"

#include <algorithm>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Calls f with random shapes of every listed type of a family.
template <class F>
void for_listed(Random& r, int count, ShapeFamily family, const F& f) {
  for (const ShapeEntry& entry : all_shapes()) {
    if (entry.family != family || entry.parameters.empty()) continue;
    CAPTURE(entry.name);
    for (int i = 0; i < count; ++i) f(*must(draw_def(r, entry)));
  }
}

class Segments final : public DebugDraw {
 public:
  std::vector<Vec3> points;
  void line(const Vec3& a, const Vec3& b, const Vec4f&) override {
    points.push_back(a), points.push_back(b);
  }
  void point(const Vec3&, const Vec4f&, float) override {}
  void text(const Vec3&, const Vec4f&, std::string_view) override {}
};

/// Mass, centre and inertia of what is round about y by 4,000 discs, whose radii are found on the
/// level (1e-5 and better).
MassProperties mass_by_discs(const Shape& s) {
  const ShapeDef& def = s.def();
  const double low = -extent_along(def, -Vec3::UnitY()), high = extent_along(def, Vec3::UnitY());
  const auto radius = [&](double y) {
    double in = 0, out = 2 * s.bounding_radius();
    if (level(def, {0, y, 0}) >= 0) return 0.0;
    for (int k = 0; k < 60; ++k) {
      const double x = 0.5 * (in + out);
      (level(def, {x, y, 0}) < 0 ? in : out) = x;
    }
    return in;
  };
  constexpr int strips = 4000;
  const double h = (high - low) / strips, pi = std::acos(-1.0);
  MassProperties m;
  double first = 0, second = 0, along = 0;
  for (int k = 0; k < strips; ++k) {
    const double y = low + (k + 0.5) * h, q = radius(y) * radius(y);
    m.mass += pi * q * h;
    first += pi * q * y * h;
    second += pi * q * (y * y + h * h / 12) * h;
    along += 0.5 * pi * q * q * h;
  }
  m.centre = {0, first / m.mass, 0};
  const double across = 0.5 * along + second - first * first / m.mass;
  m.inertia = Vec3(across, along, across).asDiagonal();
  return m;
}

}  // namespace

TEST_CASE("the list of shapes: every type once, those of meshes last") {
  const auto& all = all_shapes();
  REQUIRE(all.size() == shape_type_count);
  std::vector<bool> seen(shape_type_count);
  for (size_t i = 0; i < all.size(); ++i) {
    REQUIRE(size_t(all[i].type) < shape_type_count);
    CHECK(!seen[size_t(all[i].type)]);
    seen[size_t(all[i].type)] = true;
    CHECK(made_of_mesh(all[i].type) == (i + mesh_shape_count >= all.size()));
    CHECK(shape_entry(all[i].type).name == all[i].name);
  }
}

TEST_CASE("listed shapes: support, bounds and radii by extents") {
  Random r(601);
  for_listed(r, cases(60), ShapeFamily::convex, [&](const Shape& s) {
    const ConvexShape& c = *s.convex();
    for (int k = 0; k < 40; ++k) {
      const Vec3 n = k < 6 ? Vec3((k % 2 ? -1 : 1) * Vec3::Unit(k / 2)) : random_direction(r);
      const Vec3 p = c.support(3 * n);
      CHECK(n.dot(p) + c.rounding() == doctest::Approx(extent_along(s.def(), n)).epsilon(1e-12));
      CHECK(level(s.def(), p + (c.rounding() - 1e-9) * n) < 3e-9);
      SupportingFace face;
      c.supporting_face(n, face);
      REQUIRE(face.count >= 1);
      for (int i = 0; i < face.count; ++i) {
        // in the solid, and no farther out than the support
        CHECK(level(s.def(), face.points[size_t(i)]) < 1e-9);
        CHECK(n.dot(face.points[size_t(i)]) <= n.dot(p) + 1e-12);
        CHECK(face.points[size_t(i)].norm() <= c.view().reach + 1e-12);
      }
      CHECK(p.norm() <= c.view().reach + 1e-12);
      CHECK(extent_along(s.def(), n) <= s.bounding_radius() + 1e-12);
      CHECK(extent_along(s.def(), n) + extent_along(s.def(), -n) >= 2 * s.inner_radius() - 1e-12);
    }
    const Pose pose{random_vec(r, -2, 2), random_rotation(r)};
    const Aabb box = s.bounds(pose);
    for (int k = 0; k < 3; ++k)
      for (const double side : {-1.0, 1.0}) {
        const double far = extent_along(s.def(), pose.inverse_direction(side * Vec3::Unit(k)));
        CHECK((side > 0 ? box.max : box.min)[k] - pose.x[k] == doctest::Approx(side * far));
      }
  });
}

TEST_CASE("listed shapes: rays from outside, from inside, from far away") {
  Random r(602);
  int hits = 0, misses = 0;
  for_listed(r, cases(60), ShapeFamily::convex, [&](const Shape& s) {
    for (int k = 0; k < 20; ++k) {
      const double far = k % 5 == 0 ? 1e5 : 3;
      const Vec3 from = far * random_direction(r);
      const Vec3 d = (random_vec(r, -0.5, 0.5) - from).normalized();
      const double exact = ray_by_level(s.def(), from, d);
      const auto hit = s.ray_cast(from, 2 * d, 1e9);
      if (!hit || !std::isfinite(exact)) {
        // both miss, or the ray grazes
        if (hit) CHECK(std::fabs(level(s.def(), from + 2 * hit->t * d)) < 1e-9 * far);
        if (std::isfinite(exact)) CHECK(level(s.def(), from + (exact + 1e-3) * d) > -1e-2);
        ++misses;
        continue;
      }
      ++hits;
      CHECK(2 * hit->t == doctest::Approx(exact).epsilon(far > 10 ? 1e-9 : 1e-7));
      CHECK(std::fabs(hit->normal.norm() - 1) < 1e-9);
      CHECK(hit->normal.dot(d) <= 0);
      // the normal's plane has the solid below it
      const Vec3 x = from + 2 * hit->t * d;
      if (far < 10)
        CHECK(hit->normal.dot(x) ==
              doctest::Approx(extent_along(s.def(), hit->normal)).epsilon(1e-6));
      CHECK(!s.ray_cast(from, 2 * d, 0.999 * hit->t).has_value());
    }
    const Vec3 in = 0.1 * s.inner_radius() * random_direction(r);
    if (level(s.def(), in) < 0) {
      const auto inside = s.ray_cast(in, Vec3(0, 2, 0), 1);
      REQUIRE(inside);
      CHECK(inside->t == 0);
      CHECK((inside->normal + Vec3::UnitY()).norm() < 1e-12);
    }
  });
  CHECK(hits > misses / 4);
}

TEST_CASE("listed shapes that are round about y: nearest points by planes that part") {
  Random r(603);
  int inside = 0, count = 0;
  for_listed(r, cases(60), ShapeFamily::convex, [&](const Shape& s) {
    if (s.symmetry() == ShapeSymmetry::none) return;
    for (int k = 0; k < 20; ++k) {
      Vec3 p = random_vec(r, -1, 1);
      if (k % 4 == 1) p *= 0.3;
      if (k % 10 == 2) p = Vec3(0, p.y(), 0);
      if (k % 10 == 3) p = Vec3(0, 0.3 * p.y(), 0);
      const auto near = s.convex()->nearest(p);
      REQUIRE(near);
      ++count;
      inside += near->distance < 0;
      // The distance is the greatest that a plane parts the point from the shape by. That its own
      // plane does so is checked below; the search of the reference may end a little lower.
      CHECK(near->distance > distance_by_planes(s.def(), p) - 1e-8);
      CHECK((near->x + near->distance * near->normal - p).norm() < 1e-12);
      CHECK(std::fabs(near->normal.norm() - 1) < 1e-12);
      CHECK(std::fabs(level(s.def(), near->x)) < 1e-9);
      CHECK(near->normal.dot(near->x) ==
            doctest::Approx(extent_along(s.def(), near->normal)).epsilon(1e-9));
    }
  });
  CHECK(inside > 0.1 * count);
}

TEST_CASE("listed shapes that are round about y: mass by discs") {
  Random r(604);
  for_listed(r, cases(4), ShapeFamily::convex, [&](const Shape& s) {
    if (s.symmetry() == ShapeSymmetry::none) return;
    const auto m = s.mass_properties();
    REQUIRE(m.ok());
    const MassProperties discs = mass_by_discs(s);
    CHECK(m->mass == doctest::Approx(discs.mass).epsilon(1e-5));
    CHECK((m->centre - discs.centre).norm() < 1e-5);
    CHECK((m->inertia - discs.inertia).norm() < 2e-5 * discs.inertia.norm());
    CHECK(check_physical(*m).ok());
  });
}

TEST_CASE("cones: volume, centre and inertia in closed form") {
  const double pi = std::acos(-1.0), r = 0.3, h = 0.8, m = pi * r * r * h / 3;
  const auto solid = cone(r, h)->mass_properties();
  CHECK(solid->mass == doctest::Approx(m).epsilon(1e-13));
  CHECK(solid->centre.y() == doctest::Approx(-h / 4).epsilon(1e-13));
  CHECK(solid->inertia(1, 1) == doctest::Approx(0.3 * m * r * r).epsilon(1e-13));
  CHECK(solid->inertia(0, 0) == doctest::Approx(3 * m / 80 * (4 * r * r + h * h)).epsilon(1e-13));
}

TEST_CASE("tapered capsules: volume and centre by two caps and a frustum, inertia of even ones") {
  const double pi = std::acos(-1.0), h = 0.8;
  const auto even = tapered_capsule(0.3, 0.3, h)->mass_properties();
  const auto pill = capsule(0.3, h)->mass_properties();
  CHECK(even->mass == doctest::Approx(pill->mass).epsilon(1e-13));
  CHECK(even->centre.norm() < 1e-14);
  CHECK((even->inertia - pill->inertia).norm() < 1e-13 * pill->inertia.norm());
  const double a = 0.4, b = 0.15, s = (a - b) / h, c = std::sqrt(1 - s * s);  // of the side's lean
  const double length = h - a * s + b * s, base = a * c, top = b * c;
  const double high_a = a + a * s, high_b = b - b * s;
  const auto cap = [&](double radius, double high) {
    return pi * high * high * (radius - high / 3);
  };
  const auto off = [](double radius, double high) {  // from the ball's centre to the cap's
    return 3 * (2 * radius - high) * (2 * radius - high) / (4 * (3 * radius - high));
  };
  const double squares = base * base + base * top + top * top, frustum = pi * length / 3 * squares;
  const double up = length * (base * base + 2 * base * top + 3 * top * top) / (4 * squares);
  const auto bone = tapered_capsule(a, b, h)->mass_properties();
  CHECK(bone->mass == doctest::Approx(cap(a, high_a) + frustum + cap(b, high_b)).epsilon(1e-13));
  const double moment = cap(a, high_a) * (-h / 2 - off(a, high_a)) +
                        frustum * (-h / 2 + a * s + up) + cap(b, high_b) * (h / 2 + off(b, high_b));
  CHECK(bone->centre.y() == doctest::Approx(moment / bone->mass).epsilon(1e-12));
}

TEST_CASE(
    "listed shapes over a half-space: the least gap is the height, points are on the surface") {
  Random r(605);
  const auto ground = half_space();
  for_listed(r, cases(100), ShapeFamily::convex, [&](const Shape& s) {
    Pose pose{{r.uniform(-1, 1), 0, r.uniform(-1, 1)}, random_rotation(r)};
    const double gap = r.uniform(-0.01, 0.01);
    pose.x.y() = extent_along(s.def(), pose.inverse_direction(-Vec3::UnitY())) + gap;
    std::vector<Manifold> list;
    collide(*ground, {}, s, pose, 0.02, list);
    REQUIRE(list.size() == 1);
    // The lowest is on the surface, the others there or, below the raised end of something round,
    // inside.
    double least = 1, at_least = 1;
    for (int i = 0; i < list[0].count; ++i) {
      const ManifoldPoint& p = list[0].points[size_t(i)];
      const double at = level(s.def(), pose.inverse_point(p.x_world + Vec3(0, 0.5 * p.gap, 0)));
      CHECK(at < 1e-9);
      if (p.gap < least) least = p.gap, at_least = at;
    }
    CHECK(std::fabs(at_least) < 1e-9);
    CHECK(least == doctest::Approx(gap).scale(1).epsilon(1e-12));
  });
}

TEST_CASE("listed shapes: features, elements and roundness of points of the surface") {
  Random r(606);
  for_listed(r, cases(60), ShapeFamily::convex, [&](const Shape& s) {
    const ConvexShape& c = *s.convex();
    for (int k = 0; k < 20; ++k) {
      const Vec3 n = random_direction(r);
      const Vec3 p = c.support(n) + c.rounding() * n;
      const SurfaceElement e = s.element_at(p, n);
      // The element touches the plane across n at p where the shape does.
      switch (e.kind) {
        case ElementKind::point:
          CHECK((e.origin + e.radius * n - p).norm() < 1e-9);
          CHECK((e.radius == 0 || s.has_point(e)));
          break;
        case ElementKind::plane:
          CHECK(std::fabs(e.direction.dot(p - e.origin)) < 1e-9);
          break;
        case ElementKind::circle:
          CHECK((p - e.origin).norm() == doctest::Approx(e.radius));
          CHECK(std::fabs(e.direction.dot(p - e.origin)) < 1e-9);
          break;
        case ElementKind::ellipsoid:
          CHECK((e.semi_axes.inverse() * p).norm() == doctest::Approx(1));
          break;
        default:
          break;  // lines touch where their normals are: below
      }
      const SurfaceElement border = s.border_at(p, n);
      CHECK(border.kind != ElementKind::plane);
      CHECK(s.rounding_along(n) >= 0);
      CHECK(s.feature_at(p, 0).index < 1000);
    }
    CHECK(s.words().find(std::string(shape_entry(s.type()).name.substr(0, 4))) == 0);
  });
}

TEST_CASE("listed shapes: outlines are on the surface, drawn surfaces are closed and face out") {
  Random r(607);
  for_listed(r, cases(10), ShapeFamily::convex, [&](const Shape& s) {
    Segments outline;
    s.outline(outline, Vec4f::Ones());
    REQUIRE(outline.points.size() >= 8);
    for (const Vec3& p : outline.points) CHECK(std::fabs(level(s.def(), p)) < 1e-9);
    if (s.drawing().kind != ShapeDrawing::Kind::surface) return;
    const DrawnSurface drawn = s.drawn_surface();
    REQUIRE(drawn.normals.size() == drawn.positions.size());
    TriangleMesh mesh;
    mesh.vertices = drawn.positions;
    double closeness = 0;
    for (size_t i = 0; i < drawn.positions.size(); ++i) {
      CHECK(std::fabs(level(s.def(), drawn.positions[i])) < s.bounding_radius());
      CHECK(std::fabs(drawn.normals[i].norm() - 1) < 1e-9);
      // the plane of the normal bears the solid
      closeness = std::max(closeness, extent_along(s.def(), drawn.normals[i]) -
                                          drawn.normals[i].dot(drawn.positions[i]));
    }
    CHECK(closeness < 1e-9);
    for (size_t i = 0; i < drawn.indices.size(); i += 3)
      mesh.triangles.push_back({drawn.indices[i], drawn.indices[i + 1], drawn.indices[i + 2]});
    // Volume by the divergence theorem: less than the solid's by what facets cut off.
    const double volume = mesh_integrals(mesh).mass, solid = s.mass_properties()->mass;
    CHECK(volume < solid);
    CHECK(volume > 0.98 * solid);
  });
}
