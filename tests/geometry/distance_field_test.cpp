// Signed distance fields. References: every triangle by brute force; the generalised winding number
// by solid angles (Van Oosterom & Strackee 1983, Jacobson et al. 2013) for the sign, which shares
// nothing with scan lines; closed forms of box and half space; central differences for gradients.
// Nodes are exact to 1e-6 of the diagonal; between them the bound that each sample states holds.
#include "engine/geometry/distance_field/distance_field.hpp"

#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/math/rotation.hpp"
#include "tests/geometry/draws.hpp"
#include "tests/geometry/hierarchy_meshes.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>
#include <hwy/targets.h>

using namespace tumble;

namespace {

/// Solid angles of all triangles over 4 pi.
double generalised_winding(const TriangleMesh& mesh, const Vec3& p) {
  double sum = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0) - p, b = mesh.corner(t, 1) - p, c = mesh.corner(t, 2) - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

double brute_distance(const TriangleMesh& mesh, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    least = std::min(least,
                     closest_on_triangle(p, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2))
                         .squared_distance);
  return generalised_winding(mesh, p) > 0.5 ? -std::sqrt(least) : std::sqrt(least);
}

TriangleMesh at(const TriangleMesh& mesh, const Vec3& x, const Quat& q = Quat::Identity()) {
  return transformed(mesh, {x, q});
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  append(a, b);
  return a;
}

TriangleMesh turned_inside_out(TriangleMesh mesh) {
  flip(mesh);
  return mesh;
}

/// A plate of a hundredth of a cell's thickness.
TriangleMesh thin_plate() {
  return at(make_mesh::box({0.5, 0.0001, 0.3}), {0.01, 0.013, 0}, axis_angle(Vec3::UnitZ(), 0.3));
}

std::vector<hard_meshes::Family> solids() {
  using hard_meshes::share;
  const TriangleMesh ball = make_mesh::icosphere(0.5, 2);
  std::vector<hard_meshes::Family> out;
  out.push_back({"box", share(make_mesh::box({0.5, 0.3, 0.2}))});
  out.push_back({"ball", share(at(ball, {100, 200, -50}))});
  out.push_back({"torus", share(at(make_mesh::torus(0.5, 0.2, 24, 12), Vec3::Zero(),
                                   axis_angle(Vec3(1, 2, 3).normalized(), 0.7)))});
  out.push_back({"thin plate", share(thin_plate())});
  // Sides a thousand times as long as wide: too narrow for normals.
  out.push_back({"rod", share(at(make_mesh::cylinder(0.5, 0.04, 300), Vec3::Zero(),
                                 axis_angle(Vec3(1, 2, 3).normalized(), 0.7)))});
  out.push_back({"cavity", share(joined(make_mesh::box(Vec3::Constant(0.5)),
                                        turned_inside_out(make_mesh::icosphere(0.3, 1))))});
  out.push_back(
      {"touching boxes", share(joined(at(make_mesh::box(Vec3::Constant(0.25)), {0.25, 0, 0}),
                                      at(make_mesh::box(Vec3::Constant(0.25)), {-0.25, 0, 0})))});
  out.push_back(
      {"overlapping balls", share(joined(at(ball, {0.2, 0, 0}), at(ball, {-0.2, 0.1, 0})))});
  return out;
}

DistanceField field_of(const Hierarchy& surface, double cells) {
  DistanceFieldOptions options;
  options.cell = surface.bounds().extent().maxCoeff() / cells;
  auto field = make_distance_field(surface, options);
  REQUIRE_MESSAGE(field.ok(), test::why_not(field));
  return *std::move(field);
}

}  // namespace

TEST_CASE("nodes of a field are exact, in the band and at the corners of blocks, inside and out") {
  Random random(3);
  for (const auto& [name, mesh] : solids()) {
    const auto& shown_name = name;
    CAPTURE(shown_name);
    const AabbTree tree(mesh);
    const DistanceField field = field_of(tree, 40);
    const FieldLayout& layout = field.layout();
    const double diagonal = tree.bounds().extent().norm();
    int fine = 0, inside = 0;
    for (int i = 0; i < draws::count(3000); ++i) {
      std::array<int, 3> n;
      for (size_t k = 0; k < 3; ++k)
        n[k] = int(random.uniform(0, double(FieldLayout::cells_along * layout.blocks[k])));
      if (i % 4 == 0)
        for (int& k : n) k -= k % FieldLayout::cells_along;
      const Vec3 p = layout.node(n[0], n[1], n[2]);
      const double exact = brute_distance(*mesh, p);
      const bool corner = n[0] % 8 == 0 && n[1] % 8 == 0 && n[2] % 8 == 0;
      if (std::fabs(exact) > field.band() && !corner) continue;
      ++fine;
      inside += exact < 0;
      CHECK(std::fabs(field.value(p) - exact) <= 1e-6 * diagonal);
    }
    CHECK(fine > draws::count(3000) / 8);
    CHECK((inside > 0 || std::string_view(name) == "thin plate"));
  }
}

TEST_CASE("every point of the band has a fine answer, every answer keeps its stated bound") {
  Random random(4);
  for (const auto& [name, mesh] : solids()) {
    const auto& shown_name = name;
    CAPTURE(shown_name);
    const AabbTree tree(mesh);
    const DistanceField field = field_of(tree, 30);
    const Aabb box = tree.bounds();
    int of_level[3] = {0, 0, 0};
    for (int i = 0; i < draws::count(3000); ++i) {
      const double size = i % 3 == 0 ? 3.0 : 0.55;
      const Vec3 p =
          box.centre() +
          (box.extent().array() + 0.1).matrix().cwiseProduct(draws::in_box(random, size));
      const double exact = brute_distance(*mesh, p);
      const DistanceSample sample = field.sample(p);
      ++of_level[size_t(sample.level)];
      if (std::fabs(exact) <= field.band()) CHECK(sample.level == FieldLevel::band);
      CHECK(std::fabs(sample.distance - exact) <= sample.error * (1 + 1e-9) + 1e-12);
      if (sample.level == FieldLevel::band)
        CHECK(sample.error <= field.report().band_error * (1 + 1e-12));
      CHECK(field.value(p) == sample.distance);
      Vec3 gradient;
      CHECK(field.value(p, gradient) == sample.distance);
      CHECK(gradient == sample.gradient);
      const ExactDistance by_tree = exact_distance(tree, p);
      CHECK(std::fabs(by_tree.distance - exact) <= 1e-12 * (1 + box.max.norm()));
    }
    for (const int n : of_level) CHECK(n > draws::count(3000) / 60);
  }
}

TEST_CASE("gradients are those of the interpolated field, by central differences") {
  Random random(5);
  const auto mesh = hard_meshes::share(make_mesh::torus(0.5, 0.2, 24, 12));
  const AabbTree tree(mesh);
  const DistanceField field = field_of(tree, 50);
  const double h = 1e-6 * field.cell();
  int met = 0;
  for (int i = 0; i < draws::count(2000); ++i) {
    // Within a cell: derivatives jump between cells.
    const Vec3 p = draws::in_box(random, 0.6);
    const Vec3 place = (p - field.layout().origin) / field.cell();
    const Vec3 fraction = place.array() - place.array().floor();
    if (fraction.minCoeff() < 1e-4 || fraction.maxCoeff() > 1 - 1e-4) continue;
    const DistanceSample sample = field.sample(p);
    if (sample.level != FieldLevel::band) continue;
    ++met;
    for (int k = 0; k < 3; ++k) {
      const Vec3 way = h * Vec3::Unit(k);
      const double slope = (field.value(p + way) - field.value(p - way)) / (2 * h);
      CHECK(std::fabs(slope - sample.gradient[k]) < 1e-6);
    }
  }
  CHECK(met > draws::count(2000) / 20);
}

TEST_CASE("a field of a plane is the plane: distance, gradient and foot to the digits stored") {
  Random random(6);
  const auto slab = hard_meshes::share(make_mesh::box({2, 1, 2}));
  const AabbTree tree(slab);
  const DistanceField field = field_of(tree, 64);
  for (int i = 0; i < draws::count(500); ++i) {
    const Vec3 p(random.uniform(-1.5, 1.5), 1 + random.uniform(-1, 1) * field.band(),
                 random.uniform(-1.5, 1.5));
    const DistanceSample sample = field.sample(p);
    CHECK(std::fabs(sample.distance - (p.y() - 1)) <= field.report().node_error);
    CHECK((sample.gradient - Vec3::UnitY()).norm() < 8 * field.report().node_error / field.cell());
    const FieldFoot foot = field.foot(p);
    CHECK((foot.point - Vec3(p.x(), 1, p.z())).norm() < 1e-3 * field.cell());
  }
}

TEST_CASE("a foot lies on the surface within the field's error and is near") {
  Random random(7);
  const auto mesh = hard_meshes::share(make_mesh::icosphere(0.5, 4));
  const AabbTree tree(mesh);
  const DistanceField field = field_of(tree, 64);
  for (int i = 0; i < draws::count(300); ++i) {
    const bool far = i % 2 == 0;
    const Vec3 p =
        (far ? random.uniform(0.3, 1.5) : random.uniform(0.47, 0.53)) * draws::direction(random);
    const FieldFoot foot = field.foot(p);
    const ExactDistance exact = exact_distance(tree, p);
    CHECK(std::fabs(exact_distance(tree, foot.point).distance) < 0.05 * field.cell());
    if (!far) CHECK((foot.point - exact.closest).norm() < 0.2 * field.cell());
  }
}

TEST_CASE("the error between nodes falls with the square of the cells where the surface is smooth" *
          doctest::test_suite("long")) {
  // A fine ball, so that its own edges are far below the cells' errors.
  const auto mesh = hard_meshes::share(make_mesh::icosphere(0.5, 4));
  const AabbTree tree(mesh);
  const FieldError coarse = measure_field_error(field_of(tree, 12), tree, 1000),
                   fine = measure_field_error(field_of(tree, 24), tree, 1000);
  CHECK(coarse.rms / fine.rms > 3);
  CHECK(fine.largest <= field_of(tree, 24).report().band_error);
  // Of an error asked for, the measured one is below.
  DistanceFieldOptions options;
  options.error = 0.01;
  const auto field = make_distance_field(tree, options);
  REQUIRE(field.ok());
  CHECK(field->report().band_error <= 0.01);
  CHECK(field->report().band_error > 0.0099);
  CHECK(measure_field_error(*field, tree, 1000).largest <= 0.01);
}

TEST_CASE("parts that overlap are reported and count as their union, clean solids report none") {
  for (const auto& [name, mesh] : solids()) {
    const auto& shown_name = name;
    CAPTURE(shown_name);
    const AabbTree tree(mesh);
    const DistanceField field = field_of(tree, 30);
    CHECK((field.report().overlapped_nodes > 0) == (std::string_view(name) == "overlapping balls"));
  }
}

TEST_CASE("any number of threads builds the same field, and 16 bits take half of 32" *
          doctest::test_suite("long")) {
  const auto mesh = hard_meshes::share(make_mesh::torus(0.5, 0.2, 48, 24));
  const AabbTree tree(mesh);
  DistanceFieldOptions options;
  options.cell = 0.01;
  const auto alone = make_distance_field(tree, options);
  REQUIRE(alone.ok());
  CHECK(alone->report().bits == 16);
  for (const int threads : {1, 2, 3}) {
    Crew crew(threads);
    options.crew = &crew;
    const auto shared = make_distance_field(tree, options);
    REQUIRE(shared.ok());
    CHECK(shared->hash() == alone->hash());
  }
  options.crew = nullptr;
  CHECK(alone->report().bytes_per_area * surface_area(*mesh) ==
        doctest::Approx(double(alone->report().bytes)));
  options.cell = 0.05;
  const auto small = make_distance_field(tree, options);
  REQUIRE(small.ok());
  CHECK(small->report().bits == 32);
  CHECK(small->report().node_error < 1e-6 * tree.bounds().extent().norm());
}

TEST_CASE("every instruction set builds the same field") {
  // Triangles smaller than cells, larger than blocks, and so narrow that they are measured alone.
  TriangleMesh mesh = at(make_mesh::icosphere(0.2, 4), {0.3, 0.5, 0});
  append(mesh, at(make_mesh::box({0.5, 0.1, 0.4}), Vec3::Zero(), axis_angle(Vec3::UnitX(), 0.2)));
  append(mesh, thin_plate());
  const AabbTree tree(hard_meshes::share(std::move(mesh)));
  const uint64_t best = field_of(tree, 40).hash();
  int tried = 0;
  for (int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    const int64_t target = left & -left;
    CAPTURE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    CHECK(field_of(tree, 40).hash() == best);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    ++tried;
  }
  CHECK(tried > 0);
}

TEST_CASE(
    "open meshes, bad options and fields too large are refused with a cure, a stop is heard") {
  const AabbTree open(
      hard_meshes::share(make_mesh::terrain(1, 4, [](double, double) { return 0; })));
  const auto refused = make_distance_field(open);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.error().message.find("16 open edges") != std::string::npos);
  CHECK_FALSE(make_distance_field(AabbTree(hard_meshes::share({}))).ok());
  const AabbTree box(hard_meshes::share(make_mesh::box({1, 1, 1})));
  for (const auto& bad : {DistanceFieldOptions{.cell = -1},
                          {.cell = std::nan("")},
                          {.error = -1},
                          {.band = 0},
                          {.band = 1e9},
                          {.cell = 0.1, .error = 0.01}}) {
    const auto field = make_distance_field(box, bad);
    REQUIRE_FALSE(field.ok());
    CHECK(field.error().code == ErrorCode::invalid_argument);
  }
  const auto large = make_distance_field(box, {.cell = 1e-4, .max_bytes = 1000000});
  REQUIRE_FALSE(large.ok());
  CHECK(large.error().cure.find("would do") != std::string::npos);
  CHECK_FALSE(make_distance_field(box, {.cell = 1e-300}).ok());
  StopFlag stop;
  stop.request();
  const Stoppable stoppable(&stop);
  const auto stopped = make_distance_field(box, {.cell = 0.05});
  REQUIRE_FALSE(stopped.ok());
  CHECK(stopped.error().code == ErrorCode::cancelled);
}

TEST_CASE("points that are not numbers, or far away, have answers that say what they are") {
  const AabbTree box(hard_meshes::share(make_mesh::box({1, 1, 1})));
  const DistanceField field = field_of(box, 20);
  const DistanceSample far = field.sample({1e6, 0, 0});
  CHECK(far.level == FieldLevel::outside);
  CHECK(std::fabs(far.distance - (1e6 - 1)) <= far.error);
  CHECK(far.error < 2);
  CHECK((far.gradient - Vec3::UnitX()).norm() < 1e-5);
}
