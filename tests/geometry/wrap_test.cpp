// References: the checker of solids, which decides intersections exactly; exact point in object; a
// brute-force search for distances; volumes and areas in closed form, and the bounds that
// wrap_mesh.hpp proves.
#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/decomposition/convex_decomposition.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/brute_force.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"
#include "engine/geometry/solid/solid_report.hpp"
#include "engine/geometry/wrap/wrap_mesh.hpp"
#include "tests/geometry/draws.hpp"

#include <limits>
#include <numbers>
#include <string_view>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

TriangleMesh open_box() {
  TriangleMesh out = make_mesh::box({0.5, 0.5, 0.5});
  // Without its lid.
  std::erase_if(out.triangles, [&](const Triangle& t) {
    return out.vertices[t[0]].y() > 0 && out.vertices[t[1]].y() > 0 && out.vertices[t[2]].y() > 0;
  });
  return out;
}

TriangleMesh sheet_mesh() {
  return make_mesh::terrain(1, 3, [](double, double) { return 0.0; });
}

TriangleMesh sphere_with_holes() {
  TriangleMesh out = make_mesh::icosphere(0.5, 2), whole = out;
  out.triangles.clear();
  for (size_t t = 0; t < whole.triangles.size(); ++t)
    if (t % 9 != 4) out.triangles.push_back(whole.triangles[t]);
  return out;
}

/// Some turned inside out, all passing through each other.
TriangleMesh heap_of_boxes() {
  Random draw(5);
  TriangleMesh out;
  for (int n = 0; n < 8; ++n) {
    TriangleMesh box = make_mesh::box({0.3, 0.2, 0.1});
    if (n % 3 == 0) flip(box);
    append(out, transformed(box, Pose{draws::in_box(draw, 0.3), draws::rotation(draw)}));
  }
  return out;
}

TriangleMesh triangle_soup(uint64_t seed) {
  Random draw(seed);
  TriangleMesh out;
  for (uint32_t n = 0; n < 30; ++n) {
    const Vec3 at = draws::in_box(draw, 0.5);
    for (int k = 0; k < 3; ++k) out.vertices.push_back(at + draws::in_box(draw, 0.3));
    out.triangles.push_back({3 * n, 3 * n + 1, 3 * n + 2});
  }
  // A triangle that is a line, and one that is a point.
  out.triangles.push_back({0, 1, 1});
  out.triangles.push_back({2, 2, 2});
  return out;
}

/// A cube with specks about it, each a part of its own and far smaller than a cell.
TriangleMesh dusty_cube() {
  Random draw(11);
  TriangleMesh out = make_mesh::box({0.5, 0.5, 0.5});
  for (int n = 0; n < 300; ++n) {
    Vec3 at = draws::in_box(draw, 0.5);
    at[n % 3] = (n % 2 ? 1 : -1) * draw.uniform(0.503, 0.54);
    const auto first = uint32_t(out.vertices.size());
    for (int k = 0; k < 3; ++k) out.vertices.push_back(at + draws::in_box(draw, 1e-4));
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

WrappedMesh wrap_of(const TriangleMesh& mesh, const WrapOptions& options) {
  auto made = wrap_mesh(AabbTree(std::make_shared<const TriangleMesh>(mesh)), options);
  REQUIRE_MESSAGE(made.ok(), made.error().text());
  return *std::move(made);
}

/// All corners of a mesh inside, no triangle of it met: exact, and told apart from the wrap's own
/// tests.
bool encloses(const TriangleMesh& wrap, const TriangleMesh& mesh) {
  const AabbTree solid(std::make_shared<const TriangleMesh>(wrap));
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : t)
      if (point_in_object(mesh.vertices[v], solid).side != PointSide::inside) return false;
  return !solid.intersects(AabbTree(std::make_shared<const TriangleMesh>(mesh)), Pose{});
}

/// Least distance of two surfaces, by all pairs of triangles.
double least_distance(const TriangleMesh& a, const TriangleMesh& b) {
  double least = std::numeric_limits<double>::infinity();
  for (uint32_t i = 0; i < a.triangles.size(); ++i)
    for (uint32_t j = 0; j < b.triangles.size(); ++j)
      least =
          std::min(least, closest_triangle_triangle(corners(a, i), corners(b, j)).squared_distance);
  return std::sqrt(least);
}

bool holds(const TriangleMesh& mesh, const Vec3& p) {
  return point_in_object(p, AabbTree(std::make_shared<const TriangleMesh>(mesh))).side ==
         PointSide::inside;
}

double volume_of_wrap(const WrappedMesh& wrap) {
  return mesh_mass(wrap.mesh).value().mass;
}

}  // namespace

TEST_CASE("a wrap is a solid with all of its mesh inside, no farther from it than proven") {
  const std::vector<std::pair<const char*, TriangleMesh>> meshes = {
      {"open box", open_box()},
      {"sphere with holes", sphere_with_holes()},
      {"heap of boxes", heap_of_boxes()},
      {"sheet", sheet_mesh()},
      {"torus", make_mesh::torus(0.4, 0.15, 12, 8)},
      {"soup 1", triangle_soup(1)},
      {"soup 2", triangle_soup(2)},
      {"dusty cube", dusty_cube()},
  };
  double gap = 0;
  for (size_t i = 0; i < meshes.size(); i += test::only_to_run() ? 3 : 1) {
    const auto& [name, mesh] = meshes[i];
    const auto& shown_name = name;
    CAPTURE(shown_name);
    const auto shared = std::make_shared<const TriangleMesh>(mesh);
    // Every other one back from a ball that is much wider than the first surface stands off.
    gap = gap > 0.1 ? 0.05 : 0.8;
    WrapOptions options;
    options.gap = gap;
    // Specks are passed over, and not met, where triangles are large and keep little clear.
    const bool dusty = std::string_view(name) == "dusty cube";
    options.offset = dusty ? 0.002 : 0.02;
    options.cell = 0.06;
    const WrappedMesh wrap = wrap_of(mesh, options);
    const SolidReport report = check_solid(wrap.mesh);
    CHECK_MESSAGE(report.faults.empty(), report.text());
    CHECK(report.cavities == 0);
    CHECK(encloses(wrap.mesh, mesh));
    CHECK(wrap.report.missing == 0);
    CHECK(wrap.report.gap == doctest::Approx(std::max(gap, 2 * (options.offset + 1.75 * 0.06))));
    // It keeps half of the offset at least.
    const double nearest = least_distance(wrap.mesh, mesh);
    CHECK(nearest >= 0.5 * options.offset * (1 - 1e-9));
    CHECK(wrap.report.nearest == doctest::Approx(nearest));
    // Points of the wrap against all triangles of the mesh.
    const BruteForceHierarchy all(shared);
    double added = 0;
    constexpr int parts = 4;
    for (uint32_t t = 0; t < wrap.mesh.triangles.size(); ++t) {
      const TriangleCorners c = corners(wrap.mesh, t);
      for (int i = 0; i <= parts; ++i)
        for (int j = 0; i + j <= parts; ++j) {
          const Vec3 p =
              c[0] + double(i) / parts * (c[1] - c[0]) + double(j) / parts * (c[2] - c[0]);
          added = std::max(added, all.closest(p, 10)->squared_distance);
        }
    }
    added = std::sqrt(added);
    CHECK(added <= wrap.report.bound);
    CHECK(added > 0.8 * wrap.report.added);
    CHECK(wrap.report.added <= wrap.report.bound);
  }
}

TEST_CASE("a wrap of flat walls lies at the offset before them, in few triangles") {
  constexpr double d = 0.01;
  WrapOptions options;
  options.offset = d;
  options.cell = 1.0 / 32;
  options.gap = 0.1;
  const Pose turned{Vec3(0.3, -0.2, 0.1), Quat(0.8, 0.36, 0.48, 0)};
  for (const bool tilted : {false, true}) {
    if (!tilted && test::only_to_run()) continue;
    CAPTURE(tilted);
    TriangleMesh cube = make_mesh::box({0.5, 0.4, 0.3});
    if (tilted) cube = transformed(cube, turned);
    const WrappedMesh wrap = wrap_of(cube, options);
    // The grid gives some 8 triangles to each of the 3,800 cells along the faces.
    CHECK(wrap.mesh.triangles.size() < 300);
    // Edges may be cut off by a part of the offset, which leaves the neighbourhood of the box at
    // least.
    const double box = (1 + 2 * d) * (0.8 + 2 * d) * (0.6 + 2 * d);
    const double edges = 4 * (1 + 0.8 + 0.6) * (1 - std::numbers::pi / 4) * d * d;
    CHECK(volume_of_wrap(wrap) < box * (1 + 2e-3));
    CHECK(volume_of_wrap(wrap) > box - 2 * edges);
    CHECK(wrap.report.added < 0.75 * options.cell);
    // Nearly all of its area is in the six planes.
    double there = 0;
    for (size_t t = 0; t < wrap.mesh.triangles.size(); ++t) {
      const Vec3 n =
          tilted ? turned.inverse_direction(face_normal(wrap.mesh, t)) : face_normal(wrap.mesh, t);
      const Vec3 c = tilted ? turned.inverse_point(wrap.mesh.corner(t, 0)) : wrap.mesh.corner(t, 0);
      for (int k = 0; k < 3; ++k)
        if (std::fabs(n[k]) > 0.999 &&
            std::fabs(std::fabs(c[k]) - Vec3(0.5, 0.4, 0.3)[k] - d) < 1e-3)
          there += face_area_vector(wrap.mesh, t).norm();
    }
    CHECK(there > 0.95 * surface_area(cube));
  }
}

TEST_CASE("a wrap of a sheet is a shell of twice the offset, one of a ball a larger ball") {
  constexpr double pi = std::numbers::pi, d = 0.01;
  WrapOptions options;
  options.offset = d;
  options.cell = 0.03;
  const double shell = volume_of_wrap(wrap_of(sheet_mesh(), options));
  CHECK(shell > 2 * d);
  CHECK(shell < 2 * d * (1 + 2 * d) * (1 + 2 * d) * 1.1);
  const TriangleMesh sphere = make_mesh::icosphere(0.5, 4);
  const WrappedMesh ball = wrap_of(sphere, options);
  const auto volume = [&](double r) { return 4 * pi / 3 * r * r * r; };
  CHECK(volume_of_wrap(ball) > volume(0.5));
  CHECK(volume_of_wrap(ball) < volume(0.5 + 2 * d));
  CHECK(ball.report.added < d + 1.5 * options.cell);
}

TEST_CASE("vertices of a wrap do not stay behind over valleys") {
  // A ring whose hole is a saddle, and boxes that pass through each other; what lies between these
  // nearer than the gap is closed up, and so farther off.
  WrapOptions options;
  const auto behind = [&](const TriangleMesh& mesh, double cells) {
    const auto shared = std::make_shared<const TriangleMesh>(mesh);
    options.cell = bounds(mesh).extent().maxCoeff() / cells;
    const WrappedMesh wrap = wrap_of(mesh, options);
    CHECK(check_solid(wrap.mesh).faults.empty());
    CHECK(encloses(wrap.mesh, mesh));
    const BruteForceHierarchy all(shared);
    size_t out = 0;
    for (const Vec3& p : wrap.mesh.vertices)
      out += std::sqrt(all.closest(p, 10)->squared_distance) >
             wrap.report.offset + 0.5 * wrap.report.cell;
    return double(out) / double(wrap.mesh.vertices.size());
  };
  CHECK(behind(make_mesh::torus(0.4, 0.15, 24, 16), 64) == 0);
  CHECK(behind(heap_of_boxes(), 40) < 0.01);
}

TEST_CASE("a wrap closes what a ball of the gap does not pass and nothing wider") {
  WrapOptions options;
  options.cell = 0.08;
  options.gap = 0.8;
  const WrappedMesh open = wrap_of(open_box(), options);
  CHECK_FALSE(holds(open.mesh, Vec3::Zero()));
  options.gap = 1.2;
  const WrappedMesh filled = wrap_of(open_box(), options);
  CHECK(holds(filled.mesh, Vec3::Zero()));
  CHECK(volume_of_wrap(filled) > 1.1 * volume_of_wrap(open));
  // Holes of .2 m in a sphere: its hollow is filled.
  options.gap = 0.3;
  const WrappedMesh ball = wrap_of(sphere_with_holes(), options);
  CHECK(holds(ball.mesh, Vec3::Zero()));
  CHECK(check_solid(ball.mesh).shells.size() == 1);
}

TEST_CASE("a wrapped mesh has pieces, a field and a mass") {
  WrapOptions options;
  options.cell = 0.12;
  options.offset = 0.1;
  const auto wrap = std::make_shared<const TriangleMesh>(wrap_of(open_box(), options).mesh);
  const AabbTree tree(wrap);
  const auto pieces = decompose_approximately(tree, {.concavity = 0.15});
  REQUIRE_MESSAGE(pieces.ok(), pieces.error().text());
  CHECK(pieces->pieces.size() >= 5);
  CHECK(pieces->mesh_volume == doctest::Approx(mesh_mass(*wrap).value().mass));
  const auto field = make_distance_field(tree, {.cell = 0.1});
  REQUIRE(field.ok());
  CHECK(field->value({0.5, 0, 0}) < 0);
  CHECK(field->value({0, 0, 0}) > 0.2);
}

TEST_CASE("a wrap is the same with any threads, and stops when asked") {
  const TriangleMesh mesh = triangle_soup(7);
  WrapOptions options;
  options.cell = 0.1;
  const WrappedMesh alone = wrap_of(mesh, options);
  Crew crew(3);
  options.crew = &crew;
  const WrappedMesh together = wrap_of(mesh, options);
  CHECK(alone.mesh.vertices == together.mesh.vertices);
  CHECK(alone.mesh.triangles == together.mesh.triangles);
  CHECK(alone.report.added == together.report.added);
  options.crew = nullptr;
  for (const int64_t looks : {0, 1, 200, 700, 1000}) {
    StopFlag flag;
    flag.request_after(looks);
    const Stoppable scope(&flag);
    const auto stopped = wrap_mesh(AabbTree(std::make_shared<const TriangleMesh>(mesh)), options);
    REQUIRE_FALSE(stopped.ok());
    CHECK(stopped.error().code == ErrorCode::cancelled);
    CHECK(flag.looks_left() < 0);
  }
}

TEST_CASE("wraps that cannot be made are refused with what would do") {
  const auto refusal = [](const TriangleMesh& mesh, const WrapOptions& options) {
    const auto made = wrap_mesh(AabbTree(std::make_shared<const TriangleMesh>(mesh)), options);
    REQUIRE_FALSE(made.ok());
    return made.error().text();
  };
  WrapOptions fine;
  fine.cell = 1e-4;
  CHECK(refusal(open_box(), fine).find("would do") != std::string::npos);
  WrapOptions near;
  near.cell = 0.1;
  near.offset = 1e-9;
  CHECK(refusal(open_box(), near).find("offset of 1e-06 m") != std::string::npos);
  WrapOptions wrong;
  wrong.gap = -1;
  CHECK(refusal(open_box(), wrong).find("gap of a wrap") != std::string::npos);
  CHECK(refusal({{Vec3::Zero()}, {{0, 0, 0}}}, {}).find("without extent") != std::string::npos);
  CHECK_FALSE(refusal({}, {}).empty());
  // The size that is named does.
  WrapOptions small;
  small.cell = 0.02;
  small.max_bytes = 2'000'000;
  CHECK(refusal(open_box(), small).find("cells of") != std::string::npos);
  // So does the size that is named where there would be too many triangles.
  WrapOptions coarse;
  coarse.cell = 0.05;
  coarse.max_triangles = 5000;
  const std::string text = refusal(open_box(), coarse), before = "cells of ";
  CHECK(text.find("triangles, at most") != std::string::npos);
  REQUIRE(text.rfind(before) != std::string::npos);
  coarse.cell = std::stod(text.substr(text.rfind(before) + before.size()));
  CHECK(coarse.cell > 0.05);
  CHECK(wrap_of(open_box(), coarse).mesh.triangles.size() <= coarse.max_triangles);
}
