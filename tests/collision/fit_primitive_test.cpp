// Primitives that stand for meshes. References: meshes that are made of primitives of known sizes,
// whose fit is known up to the chord of their facets; distances of round solids by their planes;
// Hausdorff distances of concentric balls, of a ball in a shell and of a shifted box.
#include "engine/collision/fitting/fit_primitive.hpp"

#include "engine/collision/fitting/primitive_kinds.hpp"
#include "engine/core/random.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/shape_reference.hpp"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// A closed surface of revolution about y from (radius, height) pairs, upwards; the first and the
/// last lie on the axis.
TriangleMesh turned(const std::vector<Vec2>& profile, int round) {
  TriangleMesh mesh;
  const size_t n = size_t(round), rings = profile.size() - 2;
  mesh.vertices.push_back({0, profile.front().y(), 0});
  for (size_t r = 1; r <= rings; ++r)
    for (size_t k = 0; k < n; ++k) {
      const double a = 2 * std::numbers::pi * double(k) / round;
      mesh.vertices.push_back(
          {profile[r].x() * std::cos(a), profile[r].y(), profile[r].x() * std::sin(a)});
    }
  mesh.vertices.push_back({0, profile.back().y(), 0});
  const auto at = [&](size_t ring, size_t k) { return uint32_t(1 + ring * n + k % n); };
  for (size_t k = 0; k < n; ++k) {
    mesh.triangles.push_back({0, at(0, k), at(0, k + 1)});
    mesh.triangles.push_back({uint32_t(1 + rings * n), at(rings - 1, k + 1), at(rings - 1, k)});
    for (size_t r = 0; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, k), at(r + 1, k), at(r + 1, k + 1)});
      mesh.triangles.push_back({at(r, k), at(r + 1, k + 1), at(r, k + 1)});
    }
  }
  return mesh;
}

/// The outline of two balls about the ends of a height and of what is between, in the half plane.
std::vector<Vec2> rounded_outline(double low, double top, double height) {
  std::vector<Vec2> out;
  const double lean = std::asin((low - top) / height), half = std::numbers::pi / 2;
  constexpr int steps = 24;
  for (int k = 0; k <= steps; ++k) {
    const double a = -half + (half + lean) * k / steps;
    out.push_back({low * std::cos(a), -0.5 * height + low * std::sin(a)});
  }
  for (int k = 0; k <= steps; ++k) {
    const double a = lean + (half - lean) * k / steps;
    out.push_back({top * std::cos(a), 0.5 * height + top * std::sin(a)});
  }
  out.front().x() = out.back().x() = 0;
  return out;
}

TriangleMesh block(const Vec3& half) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back(
        half.cwiseProduct(Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh mesh_of(const ShapeDef& s) {
  constexpr int round = 64;
  switch (s.type) {
    case ShapeType::box:
      return block(s.half_extents);
    case ShapeType::sphere:
      return turned(rounded_outline(s.radius, s.radius, 1e-3 * s.radius), round);
    case ShapeType::capsule:
      return turned(rounded_outline(s.radius, s.radius, s.height), round);
    case ShapeType::tapered_capsule:
      return turned(rounded_outline(s.radius, s.top_radius, s.height), round);
    case ShapeType::cylinder:
      return turned({{0, -0.5 * s.height},
                     {s.radius, -0.5 * s.height},
                     {s.radius, 0.5 * s.height},
                     {0, 0.5 * s.height}},
                    round);
    default:
      return turned({{0, -0.5 * s.height}, {s.radius, -0.5 * s.height}, {0, 0.5 * s.height}},
                    round);
  }
}

/// Sizes that tell one kind from the others.
ShapeDef drawn_def(Random& r, ShapeType type) {
  ShapeDef def;
  def.type = type;
  def.radius = r.uniform(0.2, 0.3);
  def.height = r.uniform(0.7, 1);
  def.top_radius = def.radius * r.uniform(0.4, 0.6);
  def.half_extents = {r.uniform(0.2, 0.3), r.uniform(0.35, 0.5), r.uniform(0.6, 0.8)};
  return def;
}

AabbTree tree_of(TriangleMesh mesh) {
  return AabbTree(std::make_shared<const TriangleMesh>(std::move(mesh)));
}

Pose drawn_pose(Random& r) {
  const Quat q(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
  return {Vec3(r.uniform(-3, 3), r.uniform(-3, 3), r.uniform(-3, 3)), q.normalized()};
}

}  // namespace

TEST_CASE("distances that fits go by are those of the solids") {
  Random r(7);
  for (const PrimitiveKind& kind : primitive_kinds())
    for (int draw = 0; draw < 20; ++draw) {
      const std::array<double, 3> size =
          kind.type == ShapeType::tapered_capsule
              ? std::array{r.uniform(0.1, 0.4), r.uniform(0.1, 0.4), r.uniform(0.4, 1)}
              : std::array{r.uniform(0.1, 1), r.uniform(0.1, 1), r.uniform(0.1, 1)};
      REQUIRE(kind.valid(size));
      const ShapeDef def = kind.shape(size);
      const auto shape = make_shape(def);
      REQUIRE(shape.ok());
      int outside = 0;
      for (int k = 0; k < 50; ++k) {
        const Vec3 p(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
        const double d = kind.distance(size, p);
        CHECK((d < 0) == (test::level(def, p) < 0));
        outside += d > 0;
        // Of a round solid the nearest of all planes that part the point from it.
        if (kind.round) CHECK(d == doctest::Approx(test::distance_by_planes(def, p)).epsilon(1e-6));
      }
      CHECK(outside > 5);
    }
}

TEST_CASE("a mesh that is a primitive gets that primitive, wherever it lies") {
  Random r(11);
  for (const PrimitiveKind& kind : primitive_kinds())
    for (int draw = 0; draw < test::graded_count(2, 2); ++draw) {
      const ShapeDef def = drawn_def(r, kind.type);
      TriangleMesh mesh = mesh_of(def);
      const Pose pose = drawn_pose(r);
      for (Vec3& v : mesh.vertices) v = pose.point(v);
      const auto fit = fit_primitive(tree_of(mesh));
      REQUIRE(fit.ok());
      INFO(shape_entry(def.type).name << " " << def.radius << " " << def.top_radius << " "
                                      << def.height << ", got "
                                      << shape_entry(fit->shape.type).name);
      REQUIRE(fit->shape.type == def.type);
      const double coarse = 0.003;  // a chord of a 64th of a circle is off by 0.0012 of its radius
      CHECK(fit->error.larger() < coarse);
      CHECK(fit->volume == doctest::Approx(fit->mesh_volume).epsilon(0.02));
      const auto shape = make_shape(fit->shape);
      REQUIRE(shape.ok());
      const Vec3 centre = (*shape)->mass_properties().value().centre;
      const Vec3 wanted = mesh_mass(mesh).value().centre;
      CHECK((fit->pose.point(centre) - wanted).norm() < coarse);
    }
}

TEST_CASE("errors of solids both ways: concentric balls, a filled shell, a shifted box") {
  const auto ball = [](double radius) {
    ShapeDef def;
    def.radius = radius;
    return mesh_of(def);
  };
  const auto against = [](const TriangleMesh& mesh, const ShapeDef& def, const Pose& pose) {
    const std::vector<PlacedShape> shapes{{make_shape(def).value(), pose}};
    return solid_error(shapes, tree_of(mesh), true, 2000);
  };
  ShapeDef sphere;
  sphere.radius = 0.5;
  const SolidError inside = against(ball(0.6), sphere, {});
  CHECK(inside.added == 0);
  CHECK(inside.missing == doctest::Approx(0.1).epsilon(0.02));
  const SolidError about = against(ball(0.4), sphere, {});
  CHECK(about.added == doctest::Approx(0.1).epsilon(0.02));
  CHECK(about.missing == 0);

  TriangleMesh shell = ball(0.5);
  TriangleMesh hollow = ball(0.4);
  for (auto& t : hollow.triangles) {
    std::swap(t[1], t[2]);
    for (uint32_t& v : t) v += uint32_t(shell.vertices.size());
  }
  shell.vertices.insert(shell.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
  shell.triangles.insert(shell.triangles.end(), hollow.triangles.begin(), hollow.triangles.end());
  const SolidError filled = against(shell, sphere, {});
  CHECK(filled.added == doctest::Approx(0.4).epsilon(0.1));  // the middle of the hollow
  CHECK(filled.missing < 0.001);

  ShapeDef box;
  box.type = ShapeType::box;
  box.half_extents = {0.3, 0.2, 0.1};
  const SolidError moved =
      against(block(box.half_extents), box, {Vec3(0.05, 0, 0), Quat(1, 0, 0, 0)});
  CHECK(moved.added == doctest::Approx(0.05).epsilon(0.02));
  CHECK(moved.missing == doctest::Approx(0.05).epsilon(0.02));
}

TEST_CASE("what no primitive can stand for is refused") {
  CHECK_FALSE(fit_primitive(tree_of({})).ok());
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  flat.triangles = {{0, 1, 2}, {1, 3, 2}};
  const auto fit = fit_primitive(tree_of(flat));
  REQUIRE_FALSE(fit.ok());
  CHECK(fit.error().message.find("plane") != std::string::npos);
}

TEST_CASE("a plain with one small bump, of which samples see nothing, is fitted or refused") {
  // Most samples lie in the plane, in which the first boxes have no thickness.
  TriangleMesh plain;
  constexpr uint32_t n = 40;
  for (uint32_t i = 0; i <= n; ++i)
    for (uint32_t k = 0; k <= n; ++k)
      plain.vertices.push_back({double(i), i == n / 2 && k == n / 2 ? 1e-3 : 0, double(k)});
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t k = 0; k < n; ++k) {
      const uint32_t a = i * (n + 1) + k, b = a + n + 1;
      plain.triangles.push_back({a, a + 1, b});
      plain.triangles.push_back({b, a + 1, b + 1});
    }
  const auto fits = fit_primitives(tree_of(plain));
  if (!fits.ok()) return;
  for (const FittedPrimitive& fit : *fits) CHECK(std::isfinite(fit.volume));
}

TEST_CASE("no primitive is offered that reaches farther out than the mesh is large") {
  // A plate of 6 x 0.1 x 6 m whose surface is rough by some nanometres: the sphere that runs
  // nearest to it in the mean square is hundreds of metres large.
  TriangleMesh plate;
  constexpr int n = 24;
  Random random(5);
  for (const double y : {0.0, 0.1})
    for (int i = 0; i <= n; ++i)
      for (int k = 0; k <= n; ++k)
        plate.vertices.push_back({6.0 * i / n, y + random.uniform(0, 1e-9), 6.0 * k / n});
  const auto at = [&](int layer, int i, int k) {
    return uint32_t((layer * (n + 1) + i) * (n + 1) + k);
  };
  for (int layer = 0; layer < 2; ++layer)
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        const uint32_t a = at(layer, i, k), b = at(layer, i + 1, k), c = at(layer, i + 1, k + 1),
                       d = at(layer, i, k + 1);
        if (layer == 1)
          plate.triangles.insert(plate.triangles.end(), {{a, d, c}, {a, c, b}});
        else
          plate.triangles.insert(plate.triangles.end(), {{a, b, c}, {a, c, d}});
      }
  const auto fits = fit_primitives(AabbTree(std::make_shared<const TriangleMesh>(plate)));
  REQUIRE(fits.ok());
  CHECK(shape_entry(fits->front().shape.type).name == "box");
  for (const FittedPrimitive& fit : *fits) CHECK(fit.error.added < 8.5);
}

TEST_CASE("an open mesh gets a primitive through its surface") {
  ShapeDef def;
  TriangleMesh mesh = mesh_of(def);
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return mesh.vertices[t[0]].y() + mesh.vertices[t[1]].y() + mesh.vertices[t[2]].y() > 1.45;
  });
  const auto fit = fit_primitive(tree_of(mesh));
  REQUIRE(fit.ok());
  CHECK(fit->mesh_volume == 0);
  CHECK(fit->shape.type == ShapeType::sphere);
  CHECK(fit->shape.radius == doctest::Approx(0.5).epsilon(0.01));
}
