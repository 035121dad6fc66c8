// Convex decomposition. References: an independent checker (vertices against planes for convexity,
// the separating axis theorem for disjointness), the mesh's volume by signed tetrahedra, exact
// winding numbers for points of pieces, closed forms for how many pieces suffice, and brute-force
// sampling for how far hulls are from the mesh.
#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/decomposition/convex_decomposition.hpp"
#include "engine/geometry/decomposition/notches.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"
#include "engine/math/rotation.hpp"
#include "tests/geometry/draws.hpp"
#include "tests/support/convex_pieces.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// Rings of `n` corners around Y at (radius, height), closed by polygons at both ends.
TriangleMesh turned(const std::vector<Vec2>& profile, uint32_t n) {
  TriangleMesh m;
  const auto rings = uint32_t(profile.size());
  for (const Vec2& p : profile)
    for (uint32_t i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n;
      m.vertices.push_back({p.x() * std::cos(a), p.y(), p.x() * std::sin(a)});
    }
  for (uint32_t r = 0; r + 1 < rings; ++r)
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = r * n + i, b = r * n + (i + 1) % n, c = a + n, d = b + n;
      m.triangles.push_back({a, c, b});
      m.triangles.push_back({b, c, d});
    }
  const uint32_t last = (rings - 1) * n;
  for (uint32_t i = 1; i + 1 < n; ++i) {
    m.triangles.push_back({0, i, i + 1});
    m.triangles.push_back({last, last + i + 1, last + i});
  }
  return m;
}

/// A cup of 188 triangles: six rings of 16 corners, straight walls outside and inside.
TriangleMesh cup() {
  return turned({{0.3, 0}, {0.375, 0.4}, {0.45, 0.8}, {0.4, 0.8}, {0.325, 0.44}, {0.25, 0.08}}, 16);
}

/// A prism over a polygon in x and y, counter-clockwise.
TriangleMesh prism(const std::vector<Vec2>& outline, const std::vector<Triangle>& inside) {
  TriangleMesh m;
  const auto n = uint32_t(outline.size());
  for (const double z : {0.0, 1.0})
    for (const Vec2& p : outline) m.vertices.push_back({p.x(), p.y(), z});
  for (const Triangle& t : inside) {
    m.triangles.push_back({t[2], t[1], t[0]});
    m.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t j = (i + 1) % n;
    m.triangles.push_back({i, j, j + n});
    m.triangles.push_back({i, j + n, i + n});
  }
  return m;
}

TriangleMesh l_prism() {
  return prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
               {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}});
}

/// The same with a triangle without area in its reflex edge, which has a vertex on one side only.
TriangleMesh l_prism_with_needle() {
  TriangleMesh m = l_prism();
  const auto middle = uint32_t(m.vertices.size());
  m.vertices.push_back((m.vertices[3] + m.vertices[9]) / 2);
  for (Triangle& t : m.triangles)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      if (a != 3 || b != 9) continue;
      t = {a, middle, c};
      m.triangles.push_back({middle, b, c});
      m.triangles.push_back({a, b, middle});
      return m;
    }
  return m;
}

/// A plus sign: four reflex edges, of which a plane takes two.
TriangleMesh plus_prism() {
  return prism({{1, 0},
                {2, 0},
                {2, 1},
                {3, 1},
                {3, 2},
                {2, 2},
                {2, 3},
                {1, 3},
                {1, 2},
                {0, 2},
                {0, 1},
                {1, 1}},
               {{0, 1, 2},
                {0, 2, 11},
                {2, 3, 4},
                {2, 4, 5},
                {5, 6, 7},
                {5, 7, 8},
                {8, 9, 10},
                {8, 10, 11},
                {2, 5, 8},
                {2, 8, 11}});
}

/// Teeth on a bar: the bottoms of the gaps lie in one plane, which their edges only touch.
TriangleMesh comb(uint32_t teeth) {
  std::vector<Vec2> outline{{0, 0}, {2.0 * teeth - 1, 0}};
  std::vector<Triangle> inside;
  uint32_t last = 1;  // on the bar, from right to left
  const auto add = [&](uint32_t next) {
    inside.push_back({0, last, next});
    last = next;
  };
  for (uint32_t i = teeth; i-- > 0;) {
    const double x = 2.0 * i;
    const auto first = uint32_t(outline.size());
    outline.insert(outline.end(), {{x + 1, 1}, {x + 1, 3}, {x, 3}, {x, 1}});
    inside.push_back({first, first + 1, first + 2});
    inside.push_back({first, first + 2, first + 3});
    add(first);
    add(first + 3);
  }
  return prism(outline, inside);
}

TriangleMesh with_cavity(TriangleMesh outer, TriangleMesh inner) {
  flip(inner);
  append(outer, inner);
  return outer;
}

TriangleMesh spiky_ball(uint64_t seed, int levels) {
  Random random(seed);
  TriangleMesh mesh = make_mesh::icosphere(1, levels);
  for (Vec3& v : mesh.vertices) v *= random.uniform(0.6, 1);
  return mesh;
}

TriangleMesh placed(const TriangleMesh& mesh) {
  return transformed(mesh, {Vec3(3, -2, 5), axis_angle(Vec3(1, 2, 3).normalized(), 0.7)});
}

struct Solid {
  const char* name;
  TriangleMesh mesh;
  size_t most_pieces;
};

std::vector<Solid> solids() {
  const TriangleMesh torus = make_mesh::torus(0.5, 0.2, 24, 12);
  TriangleMesh two = make_mesh::box({0.2, 0.2, 0.2});
  append(two, transformed(l_prism(), {Vec3(1, 0, 0), Quat::Identity()}));
  const auto ball = [](double x) {
    return transformed(make_mesh::icosphere(0.4, 1), {Vec3(x, 0, 0), Quat::Identity()});
  };
  const TriangleMesh two_hollows =
      with_cavity(with_cavity(make_mesh::box({1, 1, 1}), ball(-0.45)), ball(0.45));
  return {
      {"box", make_mesh::box({1, 2, 3}), 1},
      {"ball", make_mesh::icosphere(1, 2), 1},
      {"L", l_prism(), 2},
      {"L, turned", placed(l_prism()), 2},
      {"L with a needle", l_prism_with_needle(), 2},
      {"plus", plus_prism(), 3},
      {"comb", comb(4), 5},
      {"comb, turned", placed(comb(4)), 5},
      {"two solids", two, 3},
      // 0.7 of what CGAL 5.5 leaves of a cup and a torus of these many triangles: 27 and 354.
      {"cup", cup(), 18},
      {"cup, turned", placed(cup()), 18},
      {"torus", torus, 24},
      {"torus, turned", placed(torus), 24},
      {"odd torus", placed(make_mesh::torus(0.5, 0.2, 7, 5)), 7},
      {"box in a box", with_cavity(make_mesh::box({1, 1, 1}), make_mesh::box({0.3, 0.4, 0.5})), 6},
      {"box in a box, turned",
       placed(with_cavity(make_mesh::box({1, 1, 1}), make_mesh::box({0.3, 0.4, 0.5}))), 6},
      // Sections have two holes, or a hole and a slit where the first cut was.
      {"two balls in a box", two_hollows, 150},
      {"ball in a box", with_cavity(make_mesh::box({1, 1, 1}), make_mesh::icosphere(0.5, 1)), 100},
      {"spiky ball", spiky_ball(1, 1), 60},
      {"spikier ball", spiky_ball(2, 2), 250}};
}

/// Convex, disjoint, within the mesh, and of its volume.
void check_partition(const ConvexDecomposition& d, const TriangleMesh& mesh) {
  const double diagonal = bounds(mesh).extent().norm(),
               rounding = 1e-12 * diagonal + 1e-15 * bounds(mesh).max.norm();
  CHECK(std::fabs(d.solid_volume / d.mesh_volume - 1) < 1e-12);
  CHECK(std::fabs(d.hull_volume / d.mesh_volume - 1) < 1e-12);
  CHECK(d.mesh_volume == doctest::Approx(mesh_integrals(mesh).mass).epsilon(1e-12));
  const AabbTree tree(std::make_shared<const TriangleMesh>(mesh));
  Random random(9);
  for (size_t a = 0; a < d.pieces.size(); ++a) {
    const ConvexPolyhedron& p = d.pieces[a].hull;
    CHECK(pieces::worst_bulge(p) <= rounding);
    CHECK(d.pieces[a].volume == doctest::Approx(polyhedron_mass(p).mass));
    for (size_t b = 0; b < a; ++b)
      CHECK(pieces::overlap_depth(p, d.pieces[b].hull, 16 * rounding) <= 16 * rounding);
    for (int i = 0; i < 4; ++i) {  // means of vertices with random weights are inside
      Vec3 inside = Vec3::Zero();
      double sum = 0;
      for (const Vec3& v : p.vertices) {
        const double w = random.uniform(0.1, 1);
        inside += w * v;
        sum += w;
      }
      CHECK(point_in_object(inside / sum, tree).side == PointSide::inside);
    }
  }
}

}  // namespace

TEST_CASE("exact pieces are convex, disjoint and add up, their number is near the least") {
  for (const Solid& s : solids()) {
    CAPTURE(s.name);
    const auto d = decompose_exactly(s.mesh);
    REQUIRE_MESSAGE(d.ok(), test::why_not(d));
    check_partition(*d, s.mesh);
    CHECK(d->pieces.size() <= s.most_pieces);
  }
}

TEST_CASE("coordinates rounded to six digits make reflex edges unless a tolerance allows them") {
  TriangleMesh mesh = placed(make_mesh::torus(0.5, 0.2, 24, 12));
  for (Vec3& v : mesh.vertices) v = (v * 1e6).array().round() / 1e6;
  const auto strict = decompose_exactly(mesh);
  const auto lenient = decompose_exactly(mesh, {.tolerance = 3e-6});
  REQUIRE(lenient.ok());
  REQUIRE(strict.ok());
  check_partition(*strict, mesh);
  CHECK(strict->pieces.size() < 354);
  CHECK(lenient->pieces.size() == 24);
  CHECK(lenient->hull_volume / lenient->mesh_volume == doctest::Approx(1).epsilon(1e-4));
}

TEST_CASE("notches of simple solids are counted") {
  const auto count = [](const TriangleMesh& mesh) {
    ExactSpace space(mesh.vertices);
    size_t notches = 0;
    const auto solids = make_solids(mesh, space, 1e-15);
    REQUIRE(solids.ok());
    for (const SolidPiece& piece : solids->pieces)
      notches += find_notches(space, piece, 1e-12).size();
    return notches;
  };
  CHECK(count(make_mesh::box({1, 2, 3})) == 0);
  CHECK(count(make_mesh::icosphere(1, 2)) == 0);
  CHECK(count(l_prism()) == 1);
  CHECK(count(plus_prism()) == 4);
  CHECK(count(with_cavity(make_mesh::box({1, 1, 1}), make_mesh::box({0.3, 0.4, 0.5}))) == 12);
  // Of each of the 24 rings the sides that face the axis.
  CHECK(count(make_mesh::torus(0.5, 0.2, 24, 12)) == 24 * 6);
}

TEST_CASE("open, crossing and flat meshes are refused with the reason, and limits are kept") {
  const auto refused = [](const TriangleMesh& mesh, const char* why) {
    const auto exact = decompose_exactly(mesh);
    REQUIRE_FALSE(exact.ok());
    CHECK_MESSAGE(exact.error().text().find(why) != std::string::npos, exact.error().text());
    const auto rough =
        decompose_approximately(AabbTree(std::make_shared<const TriangleMesh>(mesh)));
    REQUIRE_FALSE(rough.ok());
    CHECK(rough.error().message == exact.error().message);
  };
  refused(make_mesh::terrain(1, 3, [](double, double) { return 0.0; }), "open");
  refused({}, "triangle");
  TriangleMesh crossing = make_mesh::box({1, 1, 1});
  append(crossing, transformed(make_mesh::box({1, 1, 1}), {Vec3(0.5, 0.4, 0.3), Quat::Identity()}));
  refused(crossing, "cross");
  TriangleMesh inside_out = make_mesh::box({1, 1, 1});
  flip(inside_out);
  refused(inside_out, "inside");
  TriangleMesh needles = l_prism_with_needle();
  needles.vertices.back() = needles.vertices[3];
  refused(needles, "no area");
  CHECK_FALSE(decompose_exactly(cup(), {.tolerance = -1}).ok());
  CHECK_FALSE(decompose_exactly(cup(), {.tolerance = std::nan("")}).ok());
  const auto few = decompose_exactly(cup(), {.max_pieces = 5});
  REQUIRE_FALSE(few.ok());
  CHECK(few.error().message.find("more than 5 pieces") != std::string::npos);
  StopFlag stop;
  stop.request();
  const Stoppable stoppable(&stop);
  CHECK(decompose_exactly(cup()).error().code == ErrorCode::cancelled);
}

TEST_CASE("a decomposition is stopped anywhere, and soon" * doctest::test_suite("long")) {
  // Looks count what it does between them: it asks before each hull, sample and candidate.
  StopFlag flag;
  const Stoppable stoppable(&flag);
  for (const auto& [name, mesh, bound] :
       {std::tuple{"torus", make_mesh::torus(0.5, 0.2, 24, 12), 0.03},
        {"spiky ball", spiky_ball(3, 1), 0.03}}) {
    const auto& shown_name = name;
    CAPTURE(shown_name);
    const AabbTree surface(std::make_shared<const TriangleMesh>(mesh));
    const auto decompose = [&, bound = bound](int64_t after) {
      flag.request_after(after);
      return decompose_approximately(surface, {.concavity = bound, .max_pieces = 12});
    };
    constexpr int64_t plenty = int64_t{1} << 40;
    REQUIRE(decompose(plenty).ok());
    const int64_t looks = plenty - flag.looks_left();
    CHECK(looks > 2000);
    int64_t worst = 0;
    for (int k = 0; k < 24; ++k) {  // more of them early
      CAPTURE(k);
      const auto stopped = decompose(looks * k * k / (24 * 24));
      REQUIRE_FALSE(stopped.ok());
      CHECK(stopped.error().code == ErrorCode::cancelled);
      worst = std::max(worst, -flag.looks_left());
    }
    CHECK(worst < 1000);
    MESSAGE(std::string(name), ": ", looks, " looks, ", worst, " after a request");
  }
}

TEST_CASE("approximate pieces keep the bound and all of the mesh, with any number of threads") {
  for (const auto& [name, mesh, bound, most, ratio] :
       {std::tuple{"torus", make_mesh::torus(0.5, 0.2, 24, 12), 0.03, size_t{12}, 1.081},
        {"cup", cup(), 0.02, size_t{18}, 1.05},
        // Two bars that cross: whole ones would have what they share twice, with none outside.
        {"plus", plus_prism(), 0.01, size_t{3}, 1.0001},
        {"spiky ball", spiky_ball(3, 1), 0.15, size_t{64}, 1.1},
        // Hulls of spikes on opposite sides would all hold the middle.
        {"spiky ball, closer", spiky_ball(3, 1), 0.03, size_t{64}, 1.05}}) {
    const auto& shown_name = name;
    CAPTURE(shown_name);
    if (test::only_to_run() && bound > 0.1) continue;  // the same ball follows
    const AabbTree tree(std::make_shared<const TriangleMesh>(mesh));
    ApproximateDecompositionOptions options;
    options.concavity = bound;
    const auto d = decompose_approximately(tree, options);
    REQUIRE_MESSAGE(d.ok(), test::why_not(d));
    CHECK(d->pieces.size() <= most);
    CHECK(d->hull_volume / d->mesh_volume < ratio);
    CHECK(std::fabs(d->solid_volume / d->mesh_volume - 1) < 1e-5);
    CHECK(d->bound_met);
    // Samples of deciding are fewer than those of reporting.
    CHECK(d->added < 1.25 * bound);
    CHECK(d->missing < 1e-9);
    for (const Vec3& v : mesh.vertices) {
      bool held = false;
      for (const ConvexPiece& p : d->pieces) {
        double out = -1;
        for (const Plane& plane : p.hull.planes) out = std::max(out, plane.distance(v));
        held = held || out < 1e-8;
      }
      CHECK(held);
    }
    Crew crew(2);
    options.crew = &crew;
    const auto shared = decompose_approximately(tree, options);
    REQUIRE(shared.ok());
    REQUIRE(shared->pieces.size() == d->pieces.size());
    for (size_t i = 0; i < d->pieces.size(); ++i)
      CHECK(shared->pieces[i].hull.vertices == d->pieces[i].hull.vertices);
  }
}

TEST_CASE("a bound on pieces is kept, and it is said when the concavity is not") {
  const AabbTree tree(std::make_shared<const TriangleMesh>(make_mesh::torus(0.5, 0.2, 24, 12)));
  const auto d = decompose_approximately(tree, {.concavity = 0.005, .max_pieces = 3});
  REQUIRE(d.ok());
  CHECK(d->pieces.size() <= 3);
  CHECK_FALSE(d->bound_met);
  CHECK(d->added > 0.005);
}

TEST_CASE("hulls are measured against the mesh both ways") {
  // A ball's hull that misses a cap, and a box around a ball: both in closed form.
  const TriangleMesh ball = make_mesh::icosphere(1, 4);
  const AabbTree tree(std::make_shared<const TriangleMesh>(ball));
  std::vector<ConvexPiece> around(1);
  around[0].hull = convex_hull(make_mesh::box({1, 1, 1}).vertices)->polyhedron;
  const HullError box = measure_hulls(around, tree, 5000);
  CHECK(box.added == doctest::Approx(std::sqrt(3.0) - 1).epsilon(0.1));
  CHECK(box.missing < 1e-12);
  std::vector<Vec3> low;
  for (const Vec3& v : ball.vertices)
    if (v.y() < 0.5) low.push_back(v);
  around[0].hull = convex_hull(low)->polyhedron;
  const HullError cut = measure_hulls(around, tree, 5000);
  CHECK(cut.missing == doctest::Approx(0.5).epsilon(0.1));
  CHECK(cut.added < 1e-3);
}
