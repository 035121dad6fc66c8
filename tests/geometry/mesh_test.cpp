// Meshes, topology, clean-up. References: Euler characteristics and volumes of known solids, signed
// distance from the pseudo-normals against ray parity, and meshes broken on purpose.
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/hierarchy/brute_force.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mesh_cleanup.hpp"
#include "engine/geometry/mesh_orientation.hpp"
#include "engine/geometry/mesh_sides.hpp"
#include "engine/geometry/mesh_slivers.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "engine/geometry/solid/solid_report.hpp"
#include "tests/geometry/draws.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

struct Solid {
  const char* name;
  TriangleMesh mesh;
  int euler;
  double volume;
};

std::vector<Solid> solids() {
  using namespace make_mesh;
  return {{"box", box(Vec3(1, 2, 3)), 2, 48},
          {"tetrahedron", tetrahedron(std::sqrt(3.0)), 2, 8.0 / 3},
          {"icosphere", icosphere(1, 3), 2, -1},
          {"torus", torus(1, 0.3, 30, 12), 0, torus_volume(1, 0.3, 30, 12)},
          {"cylinder", cylinder(0.5, 0.3, 17), 2, cylinder_volume(0.5, 0.3, 17)},
          {"capsule", capsule(0.5, 0.3, 16, 5), 2, -1}};
}

/// Every triangle with corners of its own, as an STL file stores them.
TriangleMesh unshared(const TriangleMesh& mesh) {
  TriangleMesh out;
  for (const Triangle& t : mesh.triangles) {
    const auto k = uint32_t(out.vertices.size());
    for (uint32_t v : t) out.vertices.push_back(mesh.vertices[v]);
    out.triangles.push_back({k, k + 1, k + 2});
  }
  return out;
}

bool same_shape(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles.size() == b.triangles.size() && a.vertices.size() == b.vertices.size() &&
         std::fabs(mesh_integrals(a).mass - mesh_integrals(b).mass) <
             1e-12 * std::fabs(mesh_integrals(b).mass);
}

}  // namespace

TEST_CASE("meshes from formulas are closed, outward, of the right genus and volume") {
  for (const Solid& s : solids()) {
    CAPTURE(s.name);
    CHECK(validate(s.mesh).ok());
    const MeshTopology t = build_topology(s.mesh);
    CHECK(t.closed_and_oriented());
    CHECK(t.euler_characteristic == s.euler);
    const double volume = mesh_integrals(s.mesh).mass;
    CHECK(volume > 0);
    if (s.volume > 0) CHECK(volume == doctest::Approx(s.volume).epsilon(1e-13));
    CHECK(2 * t.edges.size() == 3 * s.mesh.triangles.size());
    for (const MeshEdge& e : t.edges) CHECK(e.face_count == 2);
    size_t uses = 0;
    for (uint32_t v = 0; v < s.mesh.vertices.size(); ++v) uses += t.faces_of_vertex(v).size();
    CHECK(uses == 3 * s.mesh.triangles.size());
  }
  const TriangleMesh hills =
      make_mesh::terrain(4, 10, [](double x, double z) { return std::sin(x) * std::cos(z); });
  const MeshTopology t = build_topology(hills);
  CHECK(t.euler_characteristic == 1);
  CHECK(t.open_edges == 40);
  for (const Vec3& n : t.vertex_normals) CHECK(n.y() > 0);
}

TEST_CASE("faults of edges are counted as the topology counts them") {
  Random random(8);
  int met[3] = {0, 0, 0};
  for (int i = 0; i < 50; ++i) {
    // Triangles are left out, turned, or there twice.
    TriangleMesh mesh = make_mesh::icosphere(1, 1), hurt;
    hurt.vertices = mesh.vertices;
    for (Triangle t : mesh.triangles) {
      const int kind = i == 0 ? 0 : int(random.uniform(0, 40));
      if (kind == 1) std::swap(t[0], t[1]);
      if (kind != 2) hurt.triangles.push_back(t);
      if (kind == 3) hurt.triangles.push_back(t);
    }
    const MeshTopology topology = build_topology(hurt);
    const EdgeFaults faults = edge_faults(hurt);
    CHECK(faults.open == topology.open_edges);
    CHECK(faults.non_manifold == topology.non_manifold_edges);
    CHECK(faults.misoriented == topology.misoriented_edges);
    CHECK(faults.any() != topology.closed_and_oriented());
    met[0] += faults.open > 0, met[1] += faults.non_manifold > 0, met[2] += faults.misoriented > 0;
  }
  for (const int n : met) CHECK(n > 15);
}

TEST_CASE("edges bend as the solid does") {
  const auto count = [](const TriangleMesh& m, EdgeBend bend) {
    const MeshTopology t = build_topology(m);
    return std::count_if(t.edges.begin(), t.edges.end(),
                         [&](const MeshEdge& e) { return e.bend == bend; });
  };
  const TriangleMesh box = make_mesh::box(Vec3(1, 2, 3));
  CHECK(count(box, EdgeBend::convex) == 12);
  CHECK(count(box, EdgeBend::flat) == 6);
  TriangleMesh inverted = box;
  flip(inverted);
  CHECK(count(inverted, EdgeBend::concave) == 12);
  CHECK(count(make_mesh::icosphere(1, 2), EdgeBend::convex) == 480);
  CHECK(count(make_mesh::torus(1, 0.3, 12, 8), EdgeBend::concave) > 0);
}

TEST_CASE("pseudo-normals give the sign of the distance, also nearest to edges and vertices") {
  Random random(90);
  for (const Solid& s : solids()) {
    CAPTURE(s.name);
    const MeshTopology topology = build_topology(s.mesh);
    const BruteForceHierarchy mesh(std::make_shared<const TriangleMesh>(s.mesh));
    const Vec3 extent = mesh.bounds().extent();
    int inside = 0, at_edges = 0;
    const int n = draws::count(1500);
    for (int i = 0; i < n; ++i) {
      const Vec3 p = 0.7 * extent.cwiseProduct(draws::in_box(random, 1));
      const auto near = mesh.closest(p, 1e9);
      REQUIRE(near);
      if (near->squared_distance < 1e-12) continue;
      Vec3 normal = topology.face_normals[near->triangle];
      const unsigned k = feature_index(near->feature);
      if (is_vertex(near->feature)) {
        normal = topology.vertex_normals[s.mesh.triangles[near->triangle][k]];
      } else if (is_edge(near->feature)) {
        normal = topology.edges[topology.face_edges[near->triangle][k]].normal;
        ++at_edges;
      }
      const bool says_inside = (p - near->point).dot(normal) < 0;
      // Parity along a generic direction.
      const RayShear shear({p, Vec3(0.5377, 0.6123, 0.7459)});
      int crossings = 0;
      for (size_t t = 0; t < s.mesh.triangles.size(); ++t) {
        crossings +=
            shear.triangle(s.mesh.corner(t, 0), s.mesh.corner(t, 1), s.mesh.corner(t, 2), 1e9)
                .has_value();
      }
      CHECK(says_inside == (crossings % 2 == 1));
      inside += says_inside;
    }
    if (n > 1000) {
      CHECK(inside > n / 50);
      CHECK(at_edges > 0);
    }
  }
}

TEST_CASE("validate names what is wrong") {
  const auto says = [](const TriangleMesh& m, const char* what, MeshLimits limits = {}) {
    const Status s = validate(m, limits);
    REQUIRE_FALSE(s.ok());
    CHECK_MESSAGE(s.error().message.find(what) != std::string::npos, s.error().text());
  };
  says({}, "no triangles");
  TriangleMesh m = make_mesh::tetrahedron(1);
  CHECK(validate(m).ok());
  says(m, "4 vertices, at most 3", {.max_vertices = 3});
  says(m, "4 triangles, at most 2", {.max_triangles = 2});
  says(scaled(m, Vec3::Constant(1e10)), "further than");
  m.vertices[2].y() = NAN;
  says(m, "vertex 2");
  m = make_mesh::tetrahedron(1);
  m.triangles[3][1] = 4;
  says(m, "triangle 3 refers to vertex 4, but there are only 4");
}

TEST_CASE("cleaning mends what can be mended and reports it") {
  for (const Solid& s : solids()) {
    CAPTURE(s.name);
    TriangleMesh intact = s.mesh;
    const CleanupReport nothing = clean_up(intact);
    CHECK_FALSE(nothing.changed());
    CHECK(nothing.text().empty());
    CHECK(nothing.parts == 1);

    TriangleMesh m = unshared(s.mesh);
    const CleanupReport welded = clean_up(m);
    CHECK(welded.welded_vertices == 3 * s.mesh.triangles.size() - s.mesh.vertices.size());
    CHECK(same_shape(m, s.mesh));
    CHECK(build_topology(m).closed_and_oriented());

    // A third of the triangles turned, one repeated, one collapsed, a stray vertex.
    m = unshared(s.mesh);
    size_t turned = 0;
    for (size_t t = 0; t < m.triangles.size(); t += 3, ++turned) {
      std::swap(m.triangles[t][1], m.triangles[t][2]);
    }
    m.triangles.push_back(m.triangles[1]);
    m.triangles.push_back({0, 1, 0});
    m.vertices.push_back(Vec3(7, 7, 7));
    const CleanupReport mended = clean_up(m);
    CHECK(mended.duplicate_triangles == 1);
    CHECK(mended.degenerate_triangles == 1);
    CHECK(mended.unused_vertices == 1);
    CHECK(mended.flipped_triangles == turned);
    // The lists name what the counts count, by the numbers before.
    const auto before = uint32_t(s.mesh.triangles.size());
    CHECK(mended.duplicates == std::vector<std::array<uint32_t, 2>>{{before, 1}});
    CHECK(mended.degenerate == std::vector<uint32_t>{before + 1});
    CHECK(mended.unused == std::vector<uint32_t>{3 * before});
    CHECK(mended.welded.size() == mended.welded_vertices);
    for (const auto& [from, to] : mended.welded) CHECK(to < from);
    REQUIRE(mended.flipped.size() == turned);
    // Half of the tetrahedron's triangles: either half will do.
    if (2 * turned < before) {
      for (uint32_t i = 0; i < turned; ++i) CHECK(mended.flipped[i] == 3 * i);
    }
    REQUIRE(mended.triangle_origin.size() == before);
    for (uint32_t t = 0; t < before; ++t) CHECK(mended.triangle_origin[t] == t);
    CHECK(same_shape(m, s.mesh));
    CHECK(build_topology(m).closed_and_oriented());

    m = s.mesh;
    flip(m);
    CHECK(clean_up(m).flipped_parts == 1);
    CHECK(mesh_integrals(m).mass > 0);
  }
}

TEST_CASE("vertices within the weld distance become one") {
  Random random(91);
  TriangleMesh m = unshared(make_mesh::icosphere(1, 2));
  for (Vec3& v : m.vertices) v += draws::in_box(random, 1e-5);
  CHECK(clean_up(m, {.weld_distance = 1e-4}).open_edges == 0);
  CHECK(m.vertices.size() == make_mesh::icosphere(1, 2).vertices.size());
  TriangleMesh untouched = unshared(make_mesh::box(Vec3::Ones()));
  CHECK(clean_up(untouched, {.weld_distance = -1}).welded_vertices == 0);
}

TEST_CASE("welding a plane of many points takes no time, at any tolerance" *
          doctest::test_suite("long")) {
  // All on one plane across each axis in turn: what a sweep along one axis alone compares pairwise.
  for (int axis = 0; axis < 3; ++axis) {
    TriangleMesh m;
    constexpr uint32_t n = 300;
    for (uint32_t i = 0; i < n; ++i) {
      for (uint32_t j = 0; j < n; ++j) {
        Vec3 p = Vec3::Zero();
        p[(axis + 1) % 3] = i;
        p[(axis + 2) % 3] = j;
        m.vertices.push_back(p);
        m.vertices.push_back(p + Vec3::Constant(1e-4));
        if (i > 0 && j > 0)
          m.triangles.push_back({2 * (i * n + j), 2 * ((i - 1) * n + j) + 1, 2 * (i * n + j - 1)});
      }
    }
    CHECK(clean_up(m, {.weld_distance = 1e-3}).welded_vertices > (n - 2) * (n - 2));
    for (const Triangle& t : m.triangles) CHECK_FALSE(t[0] == t[1]);
  }
}

TEST_CASE("a sliver that closes a T-junction splits its neighbour: closed stays closed") {
  // Reference: topology and volume of the tetrahedron before a point was put into one of its edges,
  // for every edge, either side, one to four points, and points off the edge by rounding.
  const TriangleMesh tetrahedron = make_mesh::tetrahedron(1);
  const double volume = mesh_integrals(tetrahedron).mass;
  Random random(8);
  for (size_t face = 0; face < 4; ++face) {
    for (size_t k = 0; k < 3; ++k) {
      for (uint32_t points = 1; points <= 4; ++points) {
        TriangleMesh m = tetrahedron;
        const Triangle whole = m.triangles[face];
        const uint32_t a = whole[k], b = whole[(k + 1) % 3], c = whole[(k + 2) % 3];
        // The face's side a-b becomes a chain; a fan of slivers from a lies between it and a-b of
        // the neighbour.
        std::vector<uint32_t> chain{a};
        for (uint32_t i = 1; i <= points; ++i) {
          const double s = i / (points + 1.0);
          chain.push_back(uint32_t(m.vertices.size()));
          m.vertices.push_back((1 - s) * m.vertices[a] + s * m.vertices[b]);
        }
        chain.push_back(b);
        m.triangles.erase(m.triangles.begin() + std::ptrdiff_t(face));
        for (size_t i = 0; i + 1 < chain.size(); ++i)
          m.triangles.push_back({chain[i], chain[i + 1], c});
        for (size_t i = 1; i + 1 < chain.size(); ++i)
          m.triangles.push_back({chain[i + 1], chain[i], a});
        REQUIRE(build_topology(m).closed_and_oriented());
        const CleanupReport report = clean_up(m, {.weld_distance = 1e-12});
        CAPTURE(report.text());
        CHECK(report.split_triangles == points);
        CHECK(report.degenerate_triangles == 0);
        CHECK(build_topology(m).closed_and_oriented());
        CHECK(check_solid(m).solid());
        CHECK(mesh_integrals(m).mass == doctest::Approx(volume).epsilon(1e-12));
        for (const Triangle& t : m.triangles) CHECK(triangle_height(m, t) > 1e-3);
      }
    }
  }
}

TEST_CASE("T-junctions that nothing closes split the side that they lie on: open becomes closed") {
  // Reference: topology and volume of a box, each face of which was cut into strips of its own
  // before the corners were welded, so that edges have other points on either side. Moved by less
  // than the weld distance they close too, by more they do not.
  Random random(17);
  const Quat turn = Quat(0.3, 0.5, -0.7, 0.2).normalized();
  for (const double weld : {0.0, 1e-6}) {
    for (uint32_t round = 0; round < 20; ++round) {
      TriangleMesh m;
      const TriangleMesh box = make_mesh::box(Vec3(0.5, 1, 1.5));
      size_t points = 0;
      for (size_t face = 0; face < 6; ++face) {
        // Of the four corners around, two opposite sides are cut at the same random parts.
        const Triangle &t = box.triangles[2 * face], &u = box.triangles[2 * face + 1];
        const auto of_u = [&](uint32_t v) { return v == u[0] || v == u[1] || v == u[2]; };
        size_t lone = 0;
        while (of_u(t[lone])) ++lone;
        const Vec3 a = box.vertices[t[lone]], b = box.vertices[t[(lone + 1) % 3]],
                   d = box.vertices[t[(lone + 2) % 3]];
        std::vector<double> cuts{0, 1};
        for (uint32_t k = random.below(4); k > 0; --k) cuts.push_back(random.uniform());
        std::sort(cuts.begin(), cuts.end());
        points += 2 * (cuts.size() - 2);
        const auto at = [&](const Vec3& p) {
          m.vertices.push_back(turn * p + 0.2 * weld * draws::in_box(random, 1));
          return uint32_t(m.vertices.size() - 1);
        };
        for (size_t k = 0; k + 1 < cuts.size(); ++k) {
          const Vec3 p = a + cuts[k] * (b - a), q = a + cuts[k + 1] * (b - a), across = d - a;
          const uint32_t w = at(p), x = at(q), y = at(q + across), z = at(p + across);
          m.triangles.insert(m.triangles.end(), {{w, x, y}, {w, y, z}});
        }
      }
      if (weld > 0)
        CHECK_FALSE([&] {
          TriangleMesh loose = m;
          clean_up(loose, {.weld_distance = 1e-9});
          return build_topology(loose).closed();
        }());
      const CleanupReport report = clean_up(m, {.weld_distance = std::max(weld, 1e-14)});
      CAPTURE(report.text());
      CHECK(report.split_triangles >= points);
      CHECK(report.triangle_origin.size() == m.triangles.size());
      CHECK(build_topology(m).closed_and_oriented());
      CHECK(build_topology(m).euler_characteristic == 2);
      CHECK(mesh_integrals(m).mass == doctest::Approx(6).epsilon(1e-12 + 5 * weld));
    }
  }
}

TEST_CASE("a side with hundreds of T-junctions is split at each of them") {
  // Reference: a sixth, the volume of the corner of a cube, one edge of which has a long fan of
  // slivers. The points are exact in binary.
  TriangleMesh m;
  m.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  m.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const auto [a, c, b] = m.triangles[0];
  constexpr uint32_t points = 511;
  std::vector<uint32_t> chain{b};
  for (uint32_t i = 1; i <= points; ++i) {
    chain.push_back(uint32_t(m.vertices.size()));
    m.vertices.push_back({1 - i / 512.0, 0, 0});
  }
  chain.push_back(a);
  m.triangles.erase(m.triangles.begin());
  for (size_t i = 0; i + 1 < chain.size(); ++i) m.triangles.push_back({chain[i], chain[i + 1], c});
  for (size_t i = 1; i + 1 < chain.size(); ++i) m.triangles.push_back({chain[i + 1], chain[i], b});
  TriangleMesh open = m;  // without its slivers, which are put in again
  open.triangles.resize(open.triangles.size() - points);
  for (TriangleMesh* each : {&m, &open}) {
    CHECK(clean_up(*each).split_triangles == points);
    CHECK(build_topology(*each).closed_and_oriented());
    CHECK(mesh_integrals(*each).mass == doctest::Approx(1 / 6.0).epsilon(1e-12));
  }
}

TEST_CASE("a needle folded back upon its neighbour is called that, and welding cures it") {
  for (const double off : {1e-7, -1e-7}) {
    TriangleMesh m;
    m.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, off, 0}};
    m.triangles = {{0, 2, 1}, {0, 3, 2}, {1, 2, 3}, {0, 4, 3}, {4, 1, 3}, {0, 1, 4}};
    const SolidReport report = check_solid(m);
    CHECK(report.solid());
    CHECK(report.find(SolidFaultKind::self_intersection) == nullptr);
    const SolidFault* fold = report.find(SolidFaultKind::needle_fold);
    CHECK((fold != nullptr) == (off > 0));  // moved outwards it folds nothing
    if (fold) CHECK(fold->text.find("1e-07 m high") != std::string::npos);
    CHECK(mesh_mass(m)->mass == doctest::Approx(4.0 / 3).epsilon(1e-6));
    CHECK(clean_up(m, {.weld_distance = 2e-7}).split_triangles == 1);
    CHECK(check_solid(m).find(SolidFaultKind::needle_fold) == nullptr);
    CHECK(build_topology(m).closed_and_oriented());
  }
}

TEST_CASE("parts, holes and cavities are told apart") {
  TriangleMesh two = make_mesh::box(Vec3::Ones());
  append(two, transformed(make_mesh::icosphere(1, 1), {Vec3(5, 0, 0), Quat::Identity()}));
  CHECK(split_parts(two).size() == 2);
  CHECK(split_parts(two)[0].vertices.size() == 8);
  CHECK(clean_up(two).parts == 2);

  TriangleMesh holed = make_mesh::box(Vec3::Ones());
  holed.triangles.erase(holed.triangles.begin() + 10, holed.triangles.end());  // +z is open
  holed.triangles.erase(holed.triangles.begin());                              // half of -x too
  const auto holes = find_holes(holed);
  REQUIRE(holes.size() == 1);  // they share an edge
  CHECK(holes[0].size() == 5);
  TriangleMesh two_holes = make_mesh::cylinder(1, 0.5, 12);
  std::erase_if(two_holes.triangles, [](const Triangle& t) { return t[0] == 0 || t[0] == 25; });
  const CleanupReport open = clean_up(two_holes);
  CHECK(open.holes == 2);
  CHECK(open.open_edges == 24);
  CHECK(open.hole_loops.size() == 2);
  for (const auto& loop : open.hole_loops) CHECK(loop.size() == 12);
  CHECK(open.text() == "dropped 2 unused points; 24 open edges, 2 holes");

  TriangleMesh hollow = make_mesh::box(Vec3::Constant(2));
  TriangleMesh cavity = make_mesh::box(Vec3::Ones());
  flip(cavity);
  append(hollow, cavity);
  CHECK(clean_up(hollow).flipped_parts == 0);
  CHECK(mesh_mass(hollow)->mass == doctest::Approx(64 - 8));

  // Five triangles around a Moebius strip.
  TriangleMesh moebius;
  for (int i = 0; i < 5; ++i) {
    moebius.vertices.push_back(Vec3(std::cos(i * 1.2566), 0.1 * i, std::sin(i * 1.2566)));
    moebius.triangles.push_back({uint32_t(i), uint32_t((i + 1) % 5), uint32_t((i + 2) % 5)});
  }
  CHECK(clean_up(moebius).unorientable_parts == 1);
}
