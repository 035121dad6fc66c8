// Reference of the overlap depths: closed forms, and for polyhedra the least overlap of shadows
// over many drawn directions, which no true depth exceeds and a good one nearly reaches.
#include "engine/core/random.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/math/rotation.hpp"
#include "engine/scene/workloads/solid_depth.hpp"
#include "engine/scene/workloads/tori_overlaps.hpp"
#include "tests/support/test_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

Vec3 drawn_vector(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

Quat drawn_turn(Random& random) {
  return axis_angle(drawn_vector(random), random.uniform(0, 6));
}

std::shared_ptr<const Shape> box(const Vec3& half) {
  ShapeDef def;
  def.type = ShapeType::box;
  def.half_extents = half;
  return make_shape(def).value();
}
std::shared_ptr<const Shape> capsule(double radius, double half_length) {
  ShapeDef def;
  def.type = ShapeType::capsule;
  def.radius = radius;
  def.height = 2 * half_length;
  return make_shape(def).value();
}
std::shared_ptr<const Shape> ball(double radius) {
  ShapeDef def;
  def.radius = radius;
  return make_shape(def).value();
}
std::shared_ptr<const Shape> drawn_hull(Random& random) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int i = 0; i < 16; ++i) mesh->vertices.push_back(0.5 * drawn_vector(random).normalized());
  ShapeDef def;
  def.type = ShapeType::convex_hull;
  def.mesh = mesh;
  return make_shape(def).value();
}

double depth(const std::shared_ptr<const Shape>& a, const Pose& at_a,
             const std::shared_ptr<const Shape>& b, const Pose& at_b) {
  const MeasuredSolid solid_a = measured_solid(*a, at_a), solid_b = measured_solid(*b, at_b);
  const double d = solid_depth(solid_a, solid_b);
  CHECK(solid_depth(solid_b, solid_a) == doctest::Approx(d).epsilon(1e-12));
  if (d > 0) CHECK(solid_a.bounds.overlaps(solid_b.bounds));
  return d;
}

/// How far the shadows of two point sets overlap on the line of a unit vector, one way round.
double one_way(const MeasuredSolid& a, const MeasuredSolid& b, const Vec3& n) {
  double furthest_a = -1e9, nearest_b = 1e9;
  for (const Vec3& p : a.vertices) furthest_a = std::max(furthest_a, n.dot(p));
  for (const Vec3& p : b.vertices) nearest_b = std::min(nearest_b, n.dot(p));
  return furthest_a - nearest_b;
}

/// The least over many directions and ever smaller steps from the best of them, from eight starts.
double searched_depth(const MeasuredSolid& a, const MeasuredSolid& b, Random& random) {
  double least = 1e9;
  for (int start = 0; start < 8; ++start) {
    Vec3 best = Vec3::UnitX();
    double here = one_way(a, b, best);
    const auto attempt = [&](const Vec3& v) {
      const Vec3 n = v.normalized();
      if (const double d = one_way(a, b, n); d < here) here = d, best = n;
    };
    for (int i = 0; i < 400; ++i) attempt(drawn_vector(random));
    for (double step = 0.2; step > 1e-6; step *= 0.8)
      for (int i = 0; i < 20; ++i) attempt(best + step * drawn_vector(random));
    least = std::min(least, here);
  }
  return std::max(0.0, least);
}

}  // namespace

TEST_CASE("depths of polyhedra are the least that any direction gives") {
  Random random(5);
  int apart = 0, missed = 0, count = scaled(300);
  for (int i = 0; i < count; ++i) {
    const auto a = i % 2 == 0 ? drawn_hull(random) : box({0.5, 0.3, 0.4});
    const auto b = i % 3 == 0 ? drawn_hull(random) : box({0.2, 0.6, 0.3});
    const Pose at_a{drawn_vector(random), drawn_turn(random)};
    const Pose at_b{at_a.x + 0.8 * drawn_vector(random), drawn_turn(random)};
    const double told = depth(a, at_a, b, at_b);
    const double found = searched_depth(measured_solid(*a, at_a), measured_solid(*b, at_b), random);
    CHECK(told <= found + 1e-12);
    missed += found - told > 1e-4 ? 1 : 0;
    apart += told == 0 ? 1 : 0;
  }
  CHECK(missed <= 0.03 * count);  // by the search, which may end in a corner
  if (count > 50) {
    CHECK(apart > 0.2 * count);
    CHECK(apart < 0.8 * count);
  }
}

TEST_CASE("depths of round solids are those of closed forms") {
  const Quat lying = axis_angle(Vec3::UnitZ(), 0.5 * M_PI);
  const Vec3 x(3, -2, 7);
  const auto at = [&x](double dx, double dy, double dz, const Quat& q = Quat::Identity()) {
    return Pose{x + Vec3(dx, dy, dz), q};
  };
  CHECK(depth(ball(0.3), at(0, 0, 0), ball(0.2), at(0.3, 0.2, 0.2)) ==
        doctest::Approx(0.5 - std::sqrt(0.17)));
  CHECK(depth(ball(0.3), at(0, 0, 0), ball(0.2), at(0.6, 0, 0)) == 0);
  // Crossed, parallel and end to end.
  CHECK(depth(capsule(0.1, 0.5), at(0, 0, 0), capsule(0.2, 0.4), at(0.1, 0.2, 0.25, lying)) ==
        doctest::Approx(0.05));
  CHECK(depth(capsule(0.1, 0.5), at(0, 0, 0), capsule(0.2, 0.4), at(0.27, 0.3, 0)) ==
        doctest::Approx(0.03));
  CHECK(depth(capsule(0.1, 0.5), at(0, 0, 0), capsule(0.2, 0.4), at(0, 1.1, 0)) ==
        doctest::Approx(0.1));
  // A ball before a face, an edge and a corner of a box, and with its centre inside.
  const auto cube = box({1, 1, 1});
  CHECK(depth(ball(0.3), at(0.2, 1.25, 0.1), cube, at(0, 0, 0)) == doctest::Approx(0.05));
  CHECK(depth(ball(0.3), at(1.1, 1.2, 0.1), cube, at(0, 0, 0)) ==
        doctest::Approx(0.3 - std::sqrt(0.05)));
  CHECK(depth(ball(0.3), at(1.1, 1.2, 1.1), cube, at(0, 0, 0)) ==
        doctest::Approx(0.3 - std::sqrt(0.06)));
  CHECK(depth(ball(0.3), at(0.2, 0.9, 0), cube, at(0, 0, 0)) == doctest::Approx(0.4));
  // A capsule that stands on a face, lies across an edge, and crosses a corner region slantwise.
  CHECK(depth(capsule(0.1, 0.5), at(0, 1.55, 0), cube, at(0, 0, 0)) == doctest::Approx(0.05));
  CHECK(depth(capsule(0.1, 0.5), at(0.9, 1.06, 0, lying), cube, at(0, 0, 0)) ==
        doctest::Approx(0.04));
  const Quat slant = axis_angle(Vec3::UnitZ(), 0.25 * M_PI);
  CHECK(depth(capsule(0.1, 0.5), at(1.05, 1.05, 0, slant), cube, at(0, 0, 0)) ==
        doctest::Approx(0.1 - std::sqrt(0.005)));
  CHECK(box_distance({1, 2, 3}, {0, 0, 2.75}) == doctest::Approx(-0.25));
  CHECK(box_distance({1, 2, 3}, {1.3, 0, 3.4}) == doctest::Approx(0.5));
}

namespace {

/// Two tori high above the ground, the second 10 mm nearer to the first than it would just touch.
std::vector<RigidBody> touching_tori() {
  std::vector<RigidBody> two(2);
  for (RigidBody& b : two) {
    b.type = BodyType::dynamic;
    b.pose.x.y() = 10;
  }
  two[1].pose.x.x() = 1.39;
  return two;
}

}  // namespace

TEST_CASE("tori that meet where their points are overlap as far as they were moved") {
  const ToriOnTerrain tori{0.5, 0.2, 16, [](double, double) { return -1.0; }, nullptr, 0};
  std::vector<RigidBody> two = touching_tori();
  // Side by side with 10 mm in common: each sees a point of the other.
  OverlapDepths found = tori_overlaps(tori, two);
  CHECK(found.pairs == 2);
  CHECK(found.deepest == doctest::Approx(0.01));
  CHECK(found.mean() == doctest::Approx(0.01));
  // Through each other's holes they are far apart, though their bounds overlap.
  two[1].pose = {Vec3(0.5, 10, 0), axis_angle(Vec3::UnitX(), 0.5 * M_PI)};
  CHECK(tori_overlaps(tori, two).pairs == 0);
  // Flat on the ground, 20 mm deep, and standing, 30 mm deep; fallen through, and beyond the edge.
  two[0].pose = {Vec3(0, -1 + 0.18, 0), Quat::Identity()};
  two[1].pose = {Vec3(3, -1 + 0.67, 0), axis_angle(Vec3::UnitX(), 0.5 * M_PI)};
  found = tori_overlaps(tori, two);
  CHECK(found.pairs == 2);
  CHECK(found.deepest == doctest::Approx(0.03));
  CHECK(found.sum == doctest::Approx(0.05));
  two[0].pose.x.y() = -9;
  two[1].pose.x.x() = 20;
  found = tori_overlaps(tori, two);
  CHECK(found.pairs == 1);
  CHECK(found.deepest == 2);
}

TEST_CASE("tori that are meshes overlap by their facets") {
  const auto flat = [](double, double) { return -1.0; };
  const auto mesh = std::make_shared<TriangleMesh>(make_mesh::torus(0.5, 0.2, 24, 12));
  const ToriOnTerrain tori{0.5, 0.2, 16, flat, mesh, 64};
  std::vector<RigidBody> two = touching_tori();
  // Corner against corner with 10 mm in common: each is a little less than that from the faces
  // beside the other, whose normals are 7.5 and 15 degrees off.
  OverlapDepths found = tori_overlaps(tori, two);
  CHECK(found.pairs == 2);
  CHECK(found.deepest < 0.01);
  CHECK(found.deepest > 0.01 * std::cos(0.131) * std::cos(0.262) - 1e-9);
  // The middles of two edges face each other: they meet 8.6 mm sooner than the smooth tori say.
  const double middle = 0.7 * std::cos(M_PI / 24);
  for (RigidBody& b : two) b.pose.q = axis_angle(Vec3::UnitY(), M_PI / 24);
  two[1].pose.x.x() = 2 * middle + 1e-6;
  CHECK(tori_overlaps(tori, two).pairs == 0);
  two[1].pose.x.x() = 2 * middle - 0.004;
  found = tori_overlaps(tori, two);
  CHECK(found.deepest == doctest::Approx(0.004 * std::cos(M_PI / 12)).epsilon(0.01));
  // Lying on the ground.
  two[1].pose.x.x() = 30;
  two[0].pose = {Vec3(0, -1 + 0.18, 0), Quat::Identity()};
  CHECK(tori_overlaps(tori, two).deepest == doctest::Approx(0.02));
  // One square cut along its lower diagonal: there the ground is 1 m below the smooth one, and it
  // rises at right angles to it by 2 m on the 22.6 m to either corner.
  const auto saddle = [](double x, double z) { return x * z / 256; };
  const ToriOnTerrain valley{0.5, 0.2, 16, saddle, mesh, 1};
  two[0].pose.x.y() = 0.15;
  CHECK(tori_overlaps(valley, two).pairs == 0);
  for (const double aside : {-2.0, 0.0, 2.0}) {
    CAPTURE(aside);
    two[0].pose.x = {aside, -1 + std::abs(aside) / 8 + 0.2, aside};
    const double rise = tori_overlaps(valley, two).deepest;
    CHECK(rise > 0.5 / 11.32);
    CHECK(rise < 0.7 / 11.31);
  }
}

TEST_CASE("only what may collide counts, and what is lost counts as that") {
  Workload w;
  std::vector<RigidBody> bodies(3);
  for (RigidBody& b : bodies) {
    BodyDef def;
    def.type = BodyType::dynamic;
    def.group = 7;
    def.shapes.push_back({{}, {}, {}});  // a ball of radius 0.5 m
    w.bodies.push_back(def);
    b = make_body(def).value();
  }
  CHECK(measure_overlaps(w, bodies).pairs == 0);
  bodies[0].group = 8;
  bodies[1].pose.x.x() = 0.75;
  CHECK(measure_overlaps(w, bodies).pairs == 2);
  CHECK(measure_overlaps(w, bodies).deepest == doctest::Approx(1));
  bodies[2].pose.x.y() = -21;
  bodies[1].v = {3, 0, 4};
  bodies[2].v = {30, 0, 40};
  w.joints.push_back({JointKind::spherical, 0, 1, {Vec3(0.1, 0.2, 0), Quat::Identity()}});
  EndState end = measure_end_state(w, bodies);
  CHECK(end.escaped == 1);
  CHECK(end.overlap.pairs == 1);
  CHECK(end.overlap.deepest == doctest::Approx(0.25));
  CHECK(end.fastest == doctest::Approx(5));
  CHECK(end.kinetic_energy == doctest::Approx(0.5 * bodies[1].mass * 25));
  CHECK(end.joint_gap == doctest::Approx(0.75));
  bodies[2].pose.x = Vec3::Constant(NAN);
  bodies[0].pose.x.z() = 2e4;
  end = measure_end_state(w, bodies);
  CHECK(end.escaped == 2);
  CHECK(end.overlap.pairs == 0);
  w.collides = false;
  bodies[0].pose.x.setZero();
  CHECK(measure_overlaps(w, bodies).pairs == 0);
}
