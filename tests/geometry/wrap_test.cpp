// References: the checker of solids, which decides intersections exactly; exact point in object; a
// brute-force search for distances; Steiner's formula for the volume of a convex body's
// neighbourhood (Steiner 1840), and the bounds that wrap_mesh.hpp proves.
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

#include <numbers>

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

WrappedMesh wrap_of(const TriangleMesh& mesh, const WrapOptions& options) {
  auto made = wrap_mesh(AabbTree(std::make_shared<const TriangleMesh>(mesh)), options);
  REQUIRE_MESSAGE(made.ok(), made.error().text());
  return *std::move(made);
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
  };
  double gap = 0;
  for (const auto& [name, mesh] : meshes) {
    CAPTURE(name);
    const auto shared = std::make_shared<const TriangleMesh>(mesh);
    // Every other one back from a ball that is wider than the offset.
    gap = gap > 0.1 ? 0.05 : 0.5;
    WrapOptions options;
    options.gap = gap;
    options.offset = 0.16;
    options.cell = 0.09;
    const WrappedMesh wrap = wrap_of(mesh, options);
    const SolidReport report = check_solid(wrap.mesh);
    CHECK_MESSAGE(report.faults.empty(), report.text());
    CHECK(report.cavities == 0);
    const AabbTree solid(std::make_shared<const TriangleMesh>(wrap.mesh));
    bool inside = true;
    for (const Triangle& t : mesh.triangles)
      for (const uint32_t v : t)
        inside = inside && point_in_object(mesh.vertices[v], solid).side == PointSide::inside;
    CHECK(inside);
    CHECK(wrap.report.missing == 0);
    CHECK(wrap.report.gap == std::max(gap, 0.32));
    // Corners of the wrap against all triangles of the mesh.
    const BruteForceHierarchy all(shared);
    double added = 0;
    for (size_t v = 0; v < wrap.mesh.vertices.size(); v += 7)
      added = std::max(added, all.closest(wrap.mesh.vertices[v], 10)->squared_distance);
    added = std::sqrt(added);
    CHECK(added <= wrap.report.bound);
    CHECK(added <= wrap.report.added + 0.5 * options.cell);
    CHECK(wrap.report.added <= wrap.report.bound);
    CHECK(wrap.report.added > 0.9 * options.offset);
  }
}

TEST_CASE("the volume of a wrap of a convex body, flat ones included, is Steiner's") {
  constexpr double pi = std::numbers::pi, d = 0.1;
  WrapOptions options;
  options.offset = d;
  options.cell = d / 2;
  const double cube = 1 + 6 * d + 3 * pi * d * d + 4 * pi / 3 * d * d * d;
  const double flat = 2 * d + 2 * pi * d * d + 4 * pi / 3 * d * d * d;
  options.gap = 0.01;
  CHECK(volume_of_wrap(wrap_of(make_mesh::box({0.5, 0.5, 0.5}), options)) ==
        doctest::Approx(cube).epsilon(0.02));
  options.gap = 0.5;
  CHECK(volume_of_wrap(wrap_of(sheet_mesh(), options)) == doctest::Approx(flat).epsilon(0.05));
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
  near.offset = 0.1;
  CHECK(refusal(open_box(), near).find("offset of 0.175 m") != std::string::npos);
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
  coarse.cell = 0.1;
  const size_t count = wrap_of(open_box(), coarse).mesh.triangles.size();
  coarse.max_triangles = count + count / 10;
  CHECK(wrap_of(open_box(), coarse).mesh.triangles.size() == count);
  coarse.cell = 0.05;
  const std::string text = refusal(open_box(), coarse), before = "cells of ";
  CHECK(text.find("triangles, at most") != std::string::npos);
  REQUIRE(text.rfind(before) != std::string::npos);
  coarse.cell = std::stod(text.substr(text.rfind(before) + before.size()));
  CHECK(coarse.cell > 0.05);
  CHECK(wrap_of(open_box(), coarse).mesh.triangles.size() <= coarse.max_triangles);
}
