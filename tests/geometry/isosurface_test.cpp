// Reference: volume and area of spheres and tori in closed form, Euler characteristics, and for any
// field whatever the definition of a closed oriented 2-manifold, edge by edge and vertex by vertex.
#include "engine/core/crew.hpp"
#include "engine/core/random.hpp"
#include "engine/geometry/isosurface/marching_tetrahedra.hpp"
#include "engine/geometry/isosurface/smoothed_balls.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mesh_topology.hpp"
#include "tests/geometry/draws.hpp"

#include <map>
#include <numbers>
#include <set>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr double circle = 2 * std::numbers::pi;

double volume_of(const TriangleMesh& mesh) {
  double six = 0;
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    six += mesh.corner(i, 0).dot(mesh.corner(i, 1).cross(mesh.corner(i, 2)));
  return six / 6;
}

/// Every directed edge once and its opposite too, the triangles about each vertex one fan, no
/// vertex unused, no triangle with coinciding corners: why not, or nothing.
std::string manifold_fault(const TriangleMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> directed;
  std::map<uint32_t, std::map<uint32_t, uint32_t>> rings;  // about a vertex: who follows whom
  for (const Triangle& t : mesh.triangles)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      if (a == b || mesh.vertices[a] == mesh.vertices[b]) return "coinciding corners";
      ++directed[{a, b}];
      rings[a][b] = c;
    }
  for (const auto& [way, count] : directed) {
    const auto back = directed.find({way.second, way.first});
    if (count != 1 || back == directed.end() || back->second != 1) return "an edge";
  }
  for (const auto& [vertex, next] : rings) {
    size_t steps = 0;
    const uint32_t start = next.begin()->first;
    for (uint32_t at = start; steps == 0 || at != start; ++steps) {
      const auto found = next.find(at);
      if (found == next.end() || steps > next.size()) return "an open fan";
      at = found->second;
    }
    if (steps != next.size()) return "two fans";
  }
  return rings.size() == mesh.vertices.size() ? "" : "an unused vertex";
}

Aabb cube(double half) {
  return {Vec3::Constant(-half), Vec3::Constant(half)};
}

double sphere_field(const Vec3& x) {
  return (x - Vec3(0.013, -0.021, 0.037)).norm() - 0.8;
}

double torus_field(const Vec3& x) {
  const double ring = std::hypot(x.x(), x.z()) - 0.7;
  return std::hypot(ring, x.y()) - 0.25;
}

/// Volume and area errors of a field's surface for a spacing and half of it.
struct Errors {
  double volume, area;
};
Errors errors_of(double (*field)(const Vec3&), double spacing, double volume, double area) {
  const auto sampled = sample_field(field, cube(1.1), spacing);
  REQUIRE(sampled.ok());
  const TriangleMesh mesh = isosurface(*sampled);
  CHECK(manifold_fault(mesh) == "");
  return {std::fabs(volume_of(mesh) / volume - 1), std::fabs(surface_area(mesh) / area - 1)};
}

}  // namespace

TEST_CASE("volume and area of sphere and torus converge at second order") {
  struct Case {
    const char* name;
    double (*field)(const Vec3&);
    double volume, area;
  };
  const double r = 0.8, big = 0.7, small = 0.25;
  for (const Case& c :
       {Case{"sphere", sphere_field, 2 * circle / 3 * r * r * r, 2 * circle * r * r},
        Case{"torus", torus_field, circle * big * circle / 2 * small * small,
             circle * circle * big * small}}) {
    CAPTURE(c.name);
    const Errors coarse = errors_of(c.field, 0.1, c.volume, c.area);
    const Errors middle = errors_of(c.field, 0.05, c.volume, c.area);
    if (test::only_to_run()) continue;
    const Errors fine = errors_of(c.field, 0.025, c.volume, c.area);
    for (const auto& [a, b] : {std::pair{coarse, middle}, {middle, fine}}) {
      CHECK(a.volume / b.volume == doctest::Approx(4).epsilon(0.15));
      CHECK(a.area / b.area == doctest::Approx(4).epsilon(0.15));
    }
    CHECK(fine.volume < 0.01);
    CHECK(fine.area < 0.01);
  }
}

TEST_CASE("a sphere has Euler characteristic 2, a torus 0, outward and whole in any brick") {
  const auto sphere = isosurface(*sample_field(sphere_field, cube(1.1), 0.07));
  CHECK(build_topology(sphere).euler_characteristic == 2);
  CHECK(build_topology(sphere).closed_and_oriented());
  for (size_t i = 0; i < sphere.triangles.size(); ++i)
    CHECK(face_area_vector(sphere, i).dot(sphere.corner(i, 0)) > 0);
  const auto torus = isosurface(*sample_field(torus_field, cube(1.1), 0.07));
  CHECK(build_topology(torus).euler_characteristic == 0);
  CHECK(volume_of(torus) > 0);
}

TEST_CASE("any field gives a closed oriented manifold: noise, zeros, checkers, cut at the edge") {
  for (int round = 0; round < draws::count(20); ++round) {
    CAPTURE(round);
    Random random(100 + uint64_t(round));
    SparseField field;
    field.spacing = 0.3;
    // Bricks here and there, among them neighbours across corners only.
    std::set<GridIndex> places;
    for (int i = 0; i < 5; ++i)
      places.insert(
          {int(random.uniform(-2, 2)), int(random.uniform(-2, 2)), int(random.uniform(-2, 2))});
    for (const GridIndex& place : places) {
      field.bricks.emplace_back().at = place;
      for (size_t n = 0; n < field.bricks.back().value.size(); ++n) {
        const double noise = random.uniform(-1, 1);
        const double kinds[] = {noise, noise < -0.3 ? -1.0 : 0.0, (n * 73 & 1) ? -1.0 : 1.0,
                                noise < 0 ? -1e-300 : 1e300, -1.0};
        field.bricks.back().value[n] = kinds[round % 5];
      }
    }
    const TriangleMesh mesh = isosurface(field);
    CHECK(mesh.triangles.size() > 100);
    CHECK(manifold_fault(mesh) == "");
    CHECK(volume_of(mesh) > 0);
  }
}

TEST_CASE("nothing inside is an empty mesh, one inside node a small closed one") {
  SparseField field;
  CHECK(isosurface(field).triangles.empty());
  field.bricks.emplace_back().value.fill(1);
  CHECK(isosurface(field).vertices.empty());
  field.bricks[0].value[0] = -1;
  const TriangleMesh mesh = isosurface(field);
  CHECK(manifold_fault(mesh) == "");
  CHECK(mesh.triangles.size() == 24);  // of as many tetrahedra about a node
  CHECK(build_topology(mesh).euler_characteristic == 2);
}

TEST_CASE("an affine field gives its plane exactly") {
  const Vec3 normal = Vec3(1, 2, -0.5).normalized();
  const auto field =
      sample_field([&](const Vec3& x) { return normal.dot(x) - 0.1; }, cube(1), 0.13);
  REQUIRE(field.ok());
  const TriangleMesh mesh = isosurface(*field);
  // Its triangles are apart from the walls where the bricks end, which have `outside` behind them.
  double area = 0;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    bool on = true;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& x = mesh.corner(i, k);
      on = on && std::fabs(normal.dot(x) - 0.1) < 1e-12 && x.cwiseAbs().maxCoeff() < 0.9;
    }
    if (!on) continue;
    area += face_area_vector(mesh, i).norm();
    CHECK(face_normal(mesh, i).dot(normal) == doctest::Approx(1).epsilon(1e-9));
  }
  CHECK(area > 1);
}

TEST_CASE("a lone ball is wrapped as the sphere that it is, two that touch in one skin") {
  const std::vector<Vec3> centres = {{0.3, 7, -2}, {0.5, 7, -2}};
  const std::vector<double> radii = {0.1, 0.1};
  const auto one = smoothed_balls(std::span(centres).first(1), std::span(radii).first(1), 0.02);
  REQUIRE(one.ok());
  const TriangleMesh ball = isosurface(*one);
  CHECK(manifold_fault(ball) == "");
  for (const Vec3& x : ball.vertices)
    CHECK((x - centres[0]).norm() == doctest::Approx(0.1).epsilon(0.02));
  const auto two = smoothed_balls(centres, radii, 0.02);
  REQUIRE(two.ok());
  const TriangleMesh skin = isosurface(*two);
  CHECK(manifold_fault(skin) == "");
  CHECK(build_topology(skin).euler_characteristic == 2);
  // On the plane between them both weigh the same: a circle of the balls' radius.
  for (const Vec3& x : skin.vertices)
    if (std::fabs(x.x() - 0.4) < 1e-3)
      CHECK((x - Vec3(0.4, 7, -2)).norm() == doctest::Approx(0.1).epsilon(0.03));
}

TEST_CASE("the field of balls is that of its definition at every node, far away too") {
  Random random(5);
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (int i = 0; i < 60; ++i) {
    centres.push_back(Vec3(900, -400, 70) + draws::in_box(random, 0.5));
    radii.push_back(random.uniform(0.01, 0.08));
  }
  const auto field = smoothed_balls(centres, radii, 0.03);
  REQUIRE(field.ok());
  CHECK(manifold_fault(isosurface(*field)) == "");
  for (int threads : {2, 4}) {
    Crew crew(threads);
    const auto shared = smoothed_balls(centres, radii, 0.03, &crew);
    REQUIRE(shared.ok());
    REQUIRE(shared->bricks.size() == field->bricks.size());
    for (size_t b = 0; b < field->bricks.size(); ++b) {
      CHECK(shared->bricks[b].at == field->bricks[b].at);
      CHECK(shared->bricks[b].value == field->bricks[b].value);
    }
  }
  size_t met = 0, nodes = 0;
  for (const auto& brick : field->bricks)
    for (int n = 0; n < 512; ++n) {
      const Vec3 x = field->position(
          {8 * brick.at[0] + n % 8, 8 * brick.at[1] + n / 8 % 8, 8 * brick.at[2] + n / 64});
      double weight = 0, radius = 0;
      Vec3 mean = Vec3::Zero();
      for (size_t i = 0; i < centres.size(); ++i) {
        const double s = (x - centres[i]).norm() / (4 * radii[i]);
        const double w = s < 1 ? std::pow(1 - s * s, 3) : 0;
        weight += w;
        radius += w * radii[i];
        mean += w * (centres[i] - x);
      }
      ++nodes;
      if (weight < 1e-9) continue;  // within rounding of the end of the reach
      ++met;
      CHECK(brick.value[size_t(n)] ==
            doctest::Approx(mean.norm() / weight - radius / weight).epsilon(1e-5));
    }
  CHECK(met > nodes / 4);
}

TEST_CASE("cells that are not numbers, too small or too many are refused with a cure") {
  const std::vector<Vec3> far = {{1e6, 0, 0}};
  const std::vector<double> radius = {1};
  for (const double spacing : {0.0, -1.0, 1e-5, std::nan("")})
    CHECK_FALSE(smoothed_balls(far, radius, spacing).ok());
  CHECK_FALSE(sample_field(sphere_field, cube(100), 0.01).ok());
  CHECK_FALSE(smoothed_balls(std::vector<Vec3>{Vec3::Constant(std::nan(""))}, radius, 0.1).ok());
  CHECK(isosurface(*smoothed_balls(far, std::vector<double>{0}, 0.1)).triangles.empty());
}
