// Whether a mesh bounds a solid. References: meshes broken in one known way each, whose offending
// edges, vertices, triangles and pairs are counted by hand; all pairs of triangles by brute force;
// exact integers for how two triangles lie to each other.
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "engine/geometry/solid/self_intersection.hpp"
#include "engine/geometry/solid/solid_report.hpp"
#include "tests/geometry/draws.hpp"
#include "tests/geometry/hierarchy_meshes.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;
using Kind = SolidFaultKind;

namespace {

TriangleMesh moved_by(const TriangleMesh& mesh, const Vec3& by) {
  return transformed(mesh, {by, Quat::Identity()});
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  append(a, b);
  return a;
}

TriangleMesh flipped(TriangleMesh mesh) {
  flip(mesh);
  return mesh;
}

TriangleMesh unit_cube() {
  return make_mesh::box(Vec3::Constant(0.5));
}

/// Equal vertices made one, nothing else changed.
TriangleMesh sharing(TriangleMesh mesh) {
  const std::vector<uint32_t> lowest = lowest_equal_vertices(mesh);
  for (Triangle& t : mesh.triangles) {
    for (uint32_t& v : t) v = lowest[v];
  }
  return mesh;
}

/// A grid of u by v quads on a surface, closed in u (shifted by `mirror`) and, if asked, in v.
TriangleMesh wrapped_grid(int n, int m, bool mirror, bool close_v, auto&& point) {
  TriangleMesh mesh;
  const int columns = close_v ? m : m + 1;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < columns; ++j) mesh.vertices.push_back(point(i, j));
  }
  const auto at = [&](int i, int j) {
    if (i == n) {
      i = 0;
      if (mirror) j = m - j;
    }
    if (close_v) j = ((j % m) + m) % m;
    return uint32_t(i * columns + j);
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

TriangleMesh moebius_strip(int n) {
  return wrapped_grid(n, 2, true, false, [n](int i, int j) {
    const double u = 2 * std::numbers::pi * i / n, w = 0.3 * (j - 1);
    return Vec3((1 + w * std::cos(u / 2)) * std::cos(u), w * std::sin(u / 2),
                (1 + w * std::cos(u / 2)) * std::sin(u));
  });
}

/// The figure-eight immersion, which passes through itself along a circle.
TriangleMesh klein_bottle(int n, int m) {
  return wrapped_grid(n, m, true, true, [n, m](int i, int j) {
    const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * (j + 0.25) / m - 0.5;
    const double r = 2 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
    return Vec3(r * std::cos(u), std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v),
                r * std::sin(u));
  });
}

/// A prism over the pentagram, whose sides cross.
TriangleMesh star_prism() {
  TriangleMesh mesh;
  for (int layer = 0; layer < 2; ++layer) {
    for (int k = 0; k < 5; ++k) {
      const double angle = 2 * std::numbers::pi * (2 * k) / 5;
      mesh.vertices.push_back(Vec3(std::cos(angle), layer, std::sin(angle)));
    }
  }
  mesh.vertices.push_back(Vec3(0, 0, 0));
  mesh.vertices.push_back(Vec3(0, 1, 0));
  for (uint32_t k = 0; k < 5; ++k) {
    const uint32_t next = (k + 1) % 5;
    mesh.triangles.push_back({k, k + 5, next + 5});
    mesh.triangles.push_back({k, next + 5, next});
    mesh.triangles.push_back({10, k, next});
    mesh.triangles.push_back({11, next + 5, k + 5});
  }
  return mesh;
}

std::string kinds(const SolidReport& r) {
  std::string out;
  for (const SolidFault& f : r.faults) {
    if (!out.empty()) out += ' ';
    out += to_string(f.kind);
  }
  return out;
}

void check_texts(const SolidReport& r) {
  for (const SolidFault& f : r.faults) {
    CHECK_FALSE(f.text.empty());
    CHECK(f.blocks_mass == (f.kind < Kind::non_manifold_vertex));
    CHECK(r.find(f.kind) == &f);
    CHECK(r.text().find(f.text) != std::string::npos);
  }
  CHECK(r.solid() == r.status().ok());
}

}  // namespace

TEST_CASE("sound solids have no fault") {
  for (const TriangleMesh& mesh :
       {unit_cube(), make_mesh::tetrahedron(1), make_mesh::icosphere(1, 3),
        make_mesh::torus(1, 0.3, 30, 12), make_mesh::cylinder(0.5, 0.3, 200),
        make_mesh::capsule(0.5, 0.3, 16, 5)}) {
    const SolidReport r = check_solid(mesh);
    CHECK_MESSAGE(r.faults.empty(), r.text());
    CHECK(r.solid());
    CHECK(r.status().ok());
    CHECK(r.text().empty());
    REQUIRE(r.shells.size() == 1);
    CHECK(r.shells[0].closed);
    CHECK(r.shells[0].triangles == mesh.triangles.size());
    CHECK(r.shells[0].volume == doctest::Approx(mesh_integrals(mesh).mass));
    CHECK(r.intersections_checked);
  }
}

TEST_CASE("open borders are reported as edges and as loops") {
  TriangleMesh cube = unit_cube();
  cube.triangles.pop_back();
  const SolidReport r = check_solid(cube);
  check_texts(r);
  CHECK(kinds(r) == "open_border");
  const SolidFault& f = r.faults[0];
  CHECK(f.count == 3);
  CHECK(f.edges == std::vector<std::array<uint32_t, 2>>{{4, 6}, {4, 7}, {6, 7}});
  REQUIRE(f.loops.size() == 1);
  CHECK(f.loops[0].size() == 3);
  CHECK(f.text == "the mesh is not closed: 3 open edges (vertices 4-6 4-7 6-7) around 1 hole");

  TriangleMesh one;
  one.vertices = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
  one.triangles = {{0, 1, 2}};
  CHECK(kinds(check_solid(one)) == "open_border");

  // Every triangle with corners of its own, as an STL file stores them: the cure says so.
  TriangleMesh soup;
  for (const Triangle& t : unit_cube().triangles) {
    const auto k = uint32_t(soup.vertices.size());
    for (uint32_t v : t) soup.vertices.push_back(unit_cube().vertices[v]);
    soup.triangles.push_back({k, k + 1, k + 2});
  }
  const SolidReport unwelded = check_solid(soup);
  CHECK(unwelded.find(Kind::open_border)->count == 36);
  CHECK(unwelded.find(Kind::open_border)->cure.find("28 of which lie upon others") !=
        std::string::npos);
  CHECK_FALSE(unwelded.find(Kind::self_intersection));
}

TEST_CASE("winding: one triangle, a patch, a whole shell, a surface with one side") {
  TriangleMesh cube = unit_cube();
  std::swap(cube.triangles[0][1], cube.triangles[0][2]);
  const SolidReport one = check_solid(cube);
  check_texts(one);
  CHECK(kinds(one) == "misoriented");
  CHECK(one.faults[0].count == 3);
  CHECK(one.faults[0].triangles == std::vector<uint32_t>{0});

  TriangleMesh torus = make_mesh::torus(1, 0.3, 30, 12);
  std::vector<uint32_t> patch;
  for (uint32_t t = 100; t < 150; ++t) {
    std::swap(torus.triangles[t][1], torus.triangles[t][2]);
    patch.push_back(t);
  }
  const SolidReport part = check_solid(torus);
  CHECK(kinds(part) == "misoriented");
  CHECK(part.faults[0].triangles == patch);

  const SolidReport turned = check_solid(flipped(unit_cube()));
  check_texts(turned);
  CHECK(kinds(turned) == "inside_out");
  CHECK(turned.faults[0].text == "the mesh is inside-out: its volume is -1 m^3");

  const SolidReport strip = check_solid(moebius_strip(24));
  check_texts(strip);
  CHECK(kinds(strip) == "open_border one_sided");
  CHECK(strip.faults[0].loops.size() == 1);  // a Moebius strip has one border
  const SolidReport bottle = check_solid(klein_bottle(40, 20));
  check_texts(bottle);
  CHECK(bottle.find(Kind::one_sided));
  CHECK_FALSE(bottle.find(Kind::open_border));
  CHECK(bottle.find(Kind::self_intersection));  // as it must in three dimensions
}

TEST_CASE("cubes that share an edge, a vertex, a face, or only touch") {
  const TriangleMesh cube = unit_cube();
  const SolidReport edge = check_solid(sharing(joined(cube, moved_by(cube, Vec3(1, 1, 0)))));
  check_texts(edge);
  CHECK(edge.find(Kind::non_manifold_edge));
  CHECK(edge.find(Kind::non_manifold_edge)->count == 1);
  CHECK(edge.find(Kind::non_manifold_edge)->triangles.size() == 4);
  CHECK_FALSE(edge.find(Kind::self_intersection));

  const SolidReport vertex = check_solid(sharing(joined(cube, moved_by(cube, Vec3(1, 1, 1)))));
  check_texts(vertex);
  CHECK(kinds(vertex) == "non_manifold_vertex");
  CHECK(vertex.faults[0].vertices.size() == 1);
  CHECK(vertex.solid());

  // Face to face and half a face over: solid, and said to touch.
  for (const Vec3& by : {Vec3(1, 0, 0), Vec3(1, 0.5, 0.25)}) {
    const SolidReport stacked = check_solid(joined(cube, moved_by(cube, by)));
    check_texts(stacked);
    CHECK(kinds(stacked) == "touching");
    CHECK(stacked.solid());
  }
  // Apart, they are no news.
  CHECK(check_solid(joined(cube, moved_by(cube, Vec3(2, 0, 0)))).faults.empty());
}

TEST_CASE("shells within shells") {
  const TriangleMesh outer = make_mesh::icosphere(1, 2), inner = make_mesh::icosphere(0.5, 2);
  const TriangleMesh core = make_mesh::icosphere(0.25, 1);
  const SolidReport hollow = check_solid(joined(outer, flipped(inner)));
  CHECK(hollow.faults.empty());
  CHECK(hollow.cavities == 1);
  CHECK(hollow.shells[1].cavity());
  CHECK(hollow.shells[1].depth == 1);
  const SolidReport island = check_solid(joined(joined(core, flipped(inner)), outer));
  CHECK(island.faults.empty());
  CHECK(island.shells[0].depth == 2);
  CHECK(island.cavities == 1);

  const SolidReport doubled = check_solid(joined(outer, inner));
  check_texts(doubled);
  CHECK(kinds(doubled) == "counted_twice");
  CHECK(doubled.faults[0].triangles == std::vector<uint32_t>{uint32_t(outer.triangles.size())});
  CHECK(kinds(check_solid(flipped(joined(outer, flipped(inner))))) == "inside_out");
  CHECK(check_solid(flipped(joined(outer, flipped(inner)))).faults[0].count == 2);
  CHECK(kinds(check_solid(joined(outer, moved_by(flipped(inner), Vec3(3, 0, 0))))) == "inside_out");
  // A hollow that is not inside anything, and one that a hollow already holds.
  CHECK(kinds(check_solid(joined(joined(outer, flipped(inner)), flipped(core)))) == "inside_out");
}

TEST_CASE("surfaces that pass through each other, also only along edges") {
  const TriangleMesh cube = unit_cube();
  const SolidReport through = check_solid(joined(cube, moved_by(cube, Vec3(0.3, 0.2, 0.4))));
  check_texts(through);
  CHECK(kinds(through) == "self_intersection");
  CHECK_FALSE(mesh_mass(joined(cube, moved_by(cube, Vec3(0.3, 0.2, 0.4)))).ok());
  // Twice the same, coincident sides facing alike.
  const SolidReport twice = check_solid(joined(cube, cube));
  CHECK(twice.find(Kind::self_intersection));
  CHECK(twice.find(Kind::self_intersection)->count == 12);
  // Half over, four sides within the planes of the other's.
  CHECK(check_solid(joined(cube, moved_by(cube, Vec3(0.5, 0, 0)))).find(Kind::self_intersection));

  CHECK(check_solid(star_prism()).find(Kind::self_intersection));

  // A prism with a seam of vertices at y = 0, in the plane of a larger box's side: no triangle
  // crosses one.
  TriangleMesh halves;
  for (int k = 0; k < 12; ++k) {
    const double a = 2 * std::numbers::pi * k / 12, x = 0.25 * std::cos(a), z = 0.25 * std::sin(a);
    for (double y : {-1.0, 0.0, 1.0}) halves.vertices.push_back(Vec3(x, y, z));
  }
  halves.vertices.push_back(Vec3(0, -1, 0));
  halves.vertices.push_back(Vec3(0, 1, 0));
  for (uint32_t k = 0; k < 12; ++k) {
    const uint32_t a = 3 * k, b = 3 * ((k + 1) % 12);
    for (uint32_t y = 0; y < 2; ++y) {
      halves.triangles.push_back({a + y, a + y + 1, b + y + 1});
      halves.triangles.push_back({a + y, b + y + 1, b + y});
    }
    halves.triangles.push_back({36, a, b});
    halves.triangles.push_back({37, b + 2, a + 2});
  }
  CHECK(check_solid(halves).faults.empty());
  const TriangleMesh box = moved_by(make_mesh::box(Vec3(2, 1, 2)), Vec3(0, -1, 0));
  const SolidReport along = check_solid(joined(box, halves));
  CHECK(along.find(Kind::self_intersection));
  CHECK_FALSE(along.solid());
  // The same prism standing on the box touches only.
  CHECK(kinds(check_solid(joined(box, moved_by(halves, Vec3(0, 1, 0))))) == "touching");
  // A tetrahedron in a cube with all corners at its corners: no corner of it is free.
  TriangleMesh inscribed;
  inscribed.vertices = {Vec3(-.5, -.5, -.5), Vec3(.5, .5, -.5), Vec3(.5, -.5, .5),
                        Vec3(-.5, .5, .5)};
  inscribed.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  if (mesh_integrals(inscribed).mass < 0) flip(inscribed);
  CHECK(check_solid(joined(cube, inscribed)).find(Kind::counted_twice));
}

TEST_CASE("neighbours: a fold onto each other is an intersection, a sharp edge is none") {
  TriangleMesh fin = unit_cube();
  // The last triangle's neighbour gets a flap: its side is drawn out and back.
  const Triangle t = fin.triangles[0];
  const Vec3 a = fin.vertices[t[0]], b = fin.vertices[t[1]];
  const auto tip = uint32_t(fin.vertices.size());
  fin.vertices.push_back(0.5 * (a + b) + Vec3(-0.5, 0, 0));
  fin.triangles.push_back({t[0], t[1], tip});
  fin.triangles.push_back({t[1], t[0], tip});
  const SolidReport r = check_solid(fin);
  CHECK(r.find(Kind::duplicate_triangle));
  CHECK(r.find(Kind::self_intersection));
  CHECK(r.find(Kind::non_manifold_edge));

  // Two triangles over one side, by the angle between them.
  for (int degrees : {0, 1, 90, 179, 180, 270, 359}) {
    TriangleMesh hinge;
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3 arm = degrees == 0     ? Vec3(0, 2, 0)
                     : degrees == 180 ? Vec3(0, -2, 0)
                                      : Vec3(0, 2 * std::cos(angle), 2 * std::sin(angle));
    hinge.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.3, 1, 0), Vec3(0.6, 0, 0) + arm};
    hinge.triangles = {{0, 1, 2}, {1, 0, 3}};
    CHECK(self_intersections(hinge).size() == (degrees == 0 ? 1u : 0u));
  }
  // Two over one corner: apart, through each other, touching beyond it.
  const auto over_corner = [](const Vec3& p, const Vec3& q) {
    TriangleMesh m;
    m.vertices = {Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0), p, q};
    m.triangles = {{0, 1, 2}, {0, 3, 4}};
    return self_intersections(m);
  };
  CHECK(over_corner(Vec3(-1, 0, 0), Vec3(0, -1, 0)).empty());
  CHECK(over_corner(Vec3(-1, 0, 1), Vec3(-1, 0, -1)).empty());
  REQUIRE(over_corner(Vec3(1, 1, 1), Vec3(1, 1, -1)).size() == 1);
  CHECK(over_corner(Vec3(1, 1, 1), Vec3(1, 1, -1))[0].relation == TriangleRelation::crossing);
  REQUIRE(over_corner(Vec3(1, 1, 1), Vec3(1, 1, 0)).size() == 1);
  CHECK(over_corner(Vec3(1, 1, 1), Vec3(1, 1, 0))[0].relation == TriangleRelation::touching);
  REQUIRE(over_corner(Vec3(2, 0.5, 0), Vec3(0.5, 2, 0)).size() == 1);
  CHECK(over_corner(Vec3(2, 0.5, 0), Vec3(0.5, 2, 0))[0].same_facing);
}

TEST_CASE("self-intersections of lattice soups against all pairs, corner by corner") {
  Random random(310);
  size_t clashes = 0, none = 0;
  for (int i = 0; i < draws::count(1000); ++i) {
    TriangleMesh m;  // 27 lattice points, shared or not, so that all kinds of contact occur
    for (int k = 0; k < 10; ++k) {
      Vec3 p = (1.5 * draws::in_box(random, 1)).array().round();
      m.vertices.push_back(p);
    }
    for (int k = 0; k < 4; ++k) {
      m.triangles.push_back(
          {uint32_t(random.below(10)), uint32_t(random.below(10)), uint32_t(random.below(10))});
    }
    const std::vector<TriangleClash> found = self_intersections(m);
    for (uint32_t a = 0; a < m.triangles.size(); ++a) {
      for (uint32_t b = a + 1; b < m.triangles.size(); ++b) {
        // They have more in common than shared corners when a side of one, without its shared
        // end, meets the other.
        const Triangle3 s = corners(m, a), t = corners(m, b);
        const auto flat = [](const Triangle3& c) {
          return ((c[1] - c[0]).cross(c[2] - c[0])).isZero(0);
        };
        std::vector<Vec3> shared;
        for (const Vec3& p : s) {
          for (const Vec3& q : t) {
            if (p == q) shared.push_back(p);
          }
        }
        bool expected = false;
        if (!flat(s) && !flat(t)) {
          if (shared.size() == 3) {
            expected = true;
          } else if (shared.empty()) {
            expected = triangles_intersect(s, t);
          } else {
            const auto sides_of = [](const Triangle3& c, size_t k) {
              return std::pair(c[k], c[(k + 1) % 3]);
            };
            const auto is_shared = [&](const Vec3& p) {
              return std::find(shared.begin(), shared.end(), p) != shared.end();
            };
            const auto pierces = [&](const Triangle3& from, const Triangle3& into) {
              for (size_t k = 0; k < 3; ++k) {
                const auto [p, q] = sides_of(from, k);
                if (shared.size() == 2 && is_shared(p) && is_shared(q)) continue;
                // The part of the side beyond its shared end, in 64ths: lattice coordinates up to
                // 2 give no common point nearer than that.
                const Vec3 from_p = is_shared(p) ? Vec3(p + (q - p) / 64) : p;
                const Vec3 to_q = is_shared(q) ? Vec3(q + (p - q) / 64) : q;
                if (segment_triangle_intersect(from_p, to_q, into)) return true;
              }
              return false;
            };
            expected = pierces(s, t) || pierces(t, s);
          }
        }
        const bool reported = std::any_of(found.begin(), found.end(), [&](const TriangleClash& c) {
          return c.ids == TriangleIds{a, b};
        });
        CHECK(reported == expected);
        ++(expected ? clashes : none);
      }
    }
  }
  if (draws::count(100) == 100) {
    CHECK(clashes > 300);
    CHECK(none > 300);
  }
}

TEST_CASE("hostile meshes are answered, not survived by luck") {
  CHECK(kinds(check_solid({})) == "invalid");
  TriangleMesh nan = unit_cube();
  nan.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  CHECK(kinds(check_solid(nan)) == "invalid");
  CHECK(check_solid(nan).status().error().message.find("vertex 3") != std::string::npos);
  TriangleMesh far = unit_cube();
  far.triangles[5][2] = 8;
  CHECK(kinds(check_solid(far)) == "invalid");
  TriangleMesh point;
  point.vertices = {Vec3::Ones()};
  point.triangles = {{0, 0, 0}, {0, 0, 0}};
  CHECK(check_solid(point).find(Kind::no_volume));
  TriangleMesh sheet;
  sheet.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
  CHECK(check_solid(sheet).find(Kind::no_volume));
  for (const hard_meshes::Family& family : hard_meshes::families()) {
    CAPTURE(family.name);
    check_texts(check_solid(*family.mesh));
  }
  // Triangles with a repeated corner change nothing about a cube.
  TriangleMesh spiked = unit_cube();
  spiked.triangles.push_back({0, 1, 0});
  spiked.triangles.push_back({2, 2, 2});
  const SolidReport r = check_solid(spiked);
  CHECK(kinds(r) == "degenerate_triangle");
  CHECK(r.faults[0].triangles == std::vector<uint32_t>{12, 13});
  CHECK(r.solid());
}
