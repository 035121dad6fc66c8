// Mass properties and thickness of bodies. References: closed forms of solid bodies and the
// parallel axis theorem, written out here; half the thickness of plates and the radius of axles; of
// heaps of cubes the distances to all empty cells.
#include "engine/core/random.hpp"
#include "engine/dynamics/bodies/bare_surface.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/rigid_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

std::string refusal(const BodyDef& def) {
  const Result<RigidBody> made = make_body(def);
  return made ? "" : made.error().text();
}

bool mentions(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a box body has the mass and inertia of a solid box, and its frame at the centre") {
  BodyDef d = body(box(0.5, 1, 1.5), {1, 2, 3});
  d.shapes[0].material.density = 10;
  d.shapes[0].pose.x = {0, 4, 0};
  d.pose.q = axis_angle(Vec3::UnitZ(), 1.0);
  const RigidBody b = *make_body(d);
  CHECK(b.mass == doctest::Approx(60).epsilon(1e-14));
  CHECK(b.inverse_mass * b.mass == doctest::Approx(1).epsilon(1e-14));
  CHECK(b.inertia_body(0, 0) == doctest::Approx(60.0 / 12 * (4 + 9)).epsilon(1e-13));
  CHECK(b.inertia_body(1, 1) == doctest::Approx(60.0 / 12 * (1 + 9)).epsilon(1e-13));
  CHECK(b.inertia_body(2, 2) == doctest::Approx(60.0 / 12 * (1 + 4)).epsilon(1e-13));
  CHECK((b.centre_body - Vec3(0, 4, 0)).norm() < 1e-14);
  CHECK((b.body_frame().x - Vec3(1, 2, 3)).norm() < 1e-14);
  CHECK(b.shapes[0].pose.x.norm() < 1e-14);
  CHECK(b.inner_radius == doctest::Approx(0.5));
  CHECK(b.bounding_radius == doctest::Approx(Vec3(0.5, 1, 1.5).norm()));
}

TEST_CASE("a body is as thick as the whole that its shapes make, however it is cut") {
  // A bar cut across into slices, one cut into cubes, and its slices moved apart by a slit.
  BodyDef slices = body(box(0.05, 0.3, 0.4), Vec3::Zero()), cubes = slices, apart = slices;
  slices.shapes.clear(), cubes.shapes.clear(), apart.shapes.clear();
  for (int i = 0; i < 20; ++i) {
    slices.shapes.push_back({box(0.05, 0.3, 0.4), {{0.1 * i, 0, 0}, Quat::Identity()}, {}});
    apart.shapes.push_back({box(0.049, 0.3, 0.4), {{0.1 * i, 0, 0}, Quat::Identity()}, {}});
  }
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        cubes.shapes.push_back(
            {box(0.1, 0.1, 0.1), {{0.2 * i, 0.2 * j, 0.2 * k}, Quat::Identity()}, {}});
  CHECK(make_body(slices)->inner_radius == doctest::Approx(0.3).epsilon(1e-9));
  CHECK(make_body(apart)->inner_radius == doctest::Approx(0.049).epsilon(1e-9));
  CHECK(make_body(cubes)->inner_radius == doctest::Approx(0.3).epsilon(1e-9));
  // A ring of hulls of two octagons each: the face of a piece lies at cos(15 degrees) of the
  // apothem.
  BodyDef ring = body(sphere(1), Vec3::Zero());
  ring.shapes.clear();
  for (int k = 0; k < 12; ++k) {
    ShapeDef piece;
    piece.type = ShapeType::convex_hull;
    auto mesh = std::make_shared<TriangleMesh>();
    for (int end = 0; end < 2; ++end)
      for (int j = 0; j < 8; ++j) {
        const double turn = M_PI / 6 * (k + end), around = M_PI / 4 * (j + 0.5);
        const double out = 0.5 + 0.2 * std::cos(around);
        mesh->vertices.push_back(
            {out * std::cos(turn), 0.2 * std::sin(around), -out * std::sin(turn)});
      }
    piece.mesh = std::move(mesh);
    ring.shapes.push_back({std::move(piece), {}, {}});
  }
  CHECK(make_body(ring)->inner_radius ==
        doctest::Approx(0.2 * std::cos(M_PI / 8) * std::cos(M_PI / 12)).epsilon(1e-9));
  // A thin pin in a ball.
  BodyDef pin = body(sphere(0.3), Vec3::Zero());
  pin.shapes.push_back({cylinder(0.05, 1), {{0, 0.75, 0}, Quat::Identity()}, {}});
  CHECK(make_body(pin)->inner_radius == doctest::Approx(0.05).epsilon(0.02));
}

TEST_CASE("a thin part through the middle of a thick one leaves a body as thin as it is") {
  // References: half the thickness of discs and fins, the radius of axles, a ball's own.
  const auto through_ball = [](ShapeDef part) {
    BodyDef d = body(sphere(0.3), Vec3::Zero());
    d.shapes.push_back({std::move(part), {{0.01, 0, 0.02}, Quat::Identity()}, {}});
    return make_body(d)->inner_radius;
  };
  CHECK(through_ball(cylinder(0.5, 0.01)) == doctest::Approx(0.005).epsilon(0.02));
  CHECK(through_ball(cylinder(0.02, 0.8)) == doctest::Approx(0.02).epsilon(0.02));
  CHECK(through_ball(box(0.5, 0.004, 0.1)) == doctest::Approx(0.004).epsilon(1e-6));
  CHECK(through_ball(box(0.7, 0.02, 0.02)) == doctest::Approx(0.02).epsilon(1e-6));
  // What does not stick out takes nothing away.
  CHECK(through_ball(cylinder(0.2, 0.01)) == doctest::Approx(0.3).epsilon(1e-6));
  CHECK(through_ball(box(0.2, 0.004, 0.1)) == doctest::Approx(0.3).epsilon(1e-6));
  // Two planks across each other are as thin as the thinner one.
  BodyDef planks = body(box(1, 0.1, 0.1), Vec3::Zero());
  planks.shapes.push_back({box(0.03, 0.03, 1), {}, {}});
  CHECK(make_body(planks)->inner_radius == doctest::Approx(0.03).epsilon(1e-6));
}

TEST_CASE("how thick a body is depends on where it is bare, not on what lies flush in it") {
  // References: half the length of a crate's edges, a bar's radius, a pillar's.
  BodyDef crate = body(box(1, 1, 1), Vec3::Zero());
  crate.shapes.push_back({box(1, 0.02, 1), {{0, 0.98, 0}, Quat::Identity()}, {}});
  CHECK(make_body(crate)->inner_radius == doctest::Approx(1).epsilon(1e-6));
  BodyDef barbell = body(cylinder(0.01, 2), Vec3::Zero());
  for (const double y : {-0.95, 0.0, 0.95})
    barbell.shapes.push_back({sphere(0.2), {{0, y, 0}, Quat::Identity()}, {}});
  CHECK(make_body(barbell)->inner_radius == doctest::Approx(0.01).epsilon(0.02));
  BodyDef pillar = body(cylinder(0.1, 1), Vec3::Zero());
  pillar.shapes.push_back({cylinder(0.1, 0.01), {{0, 0.505, 0}, Quat::Identity()}, {}});
  CHECK(make_body(pillar)->inner_radius == doctest::Approx(0.1).epsilon(0.02));
}

TEST_CASE("the bare surface of a heap of cubes is as far away as the empty cells about it") {
  // Reference: the distance to a box, of all cells of the grid that are empty.
  Random random(27);
  for (int heap = 0; heap < 4; ++heap) {
    std::vector<BodyShape> cubes;
    std::vector<Vec3> empty;
    const auto cube = make_shape(box(0.5, 0.5, 0.5)).value();
    for (int k = 0; k < 125; ++k) {
      const Vec3 at(k % 5, k / 5 % 5, k / 25);
      const bool border = (at - Vec3::Constant(2)).cwiseAbs().maxCoeff() > 1.5;
      if (border || random.uniform(0, 1) < 0.3)
        empty.push_back(at);
      else
        cubes.push_back({cube, {at, Quat::Identity()}, {}});
    }
    REQUIRE(cubes.size() > 10);
    const BareSurface surface(cubes);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p =
          cubes[size_t(i) % cubes.size()].pose.x +
          Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
      double least = 10;
      for (const Vec3& e : empty)
        least = std::min(least, ((p - e).cwiseAbs() - Vec3::Constant(0.5)).cwiseMax(0).norm());
      CHECK(std::abs((surface.nearest(p).value() - p).norm() - least) < 4e-5 * surface.size());
    }
  }
}

TEST_CASE("two spheres make a dumbbell: parallel axes") {
  BodyDef d = body(sphere(0.3), Vec3::Zero());
  d.shapes.push_back(d.shapes[0]);
  d.shapes[0].pose.x = {-1, 0, 0};
  d.shapes[1].pose.x = {2, 0, 0};
  d.shapes[1].material.density = 3000;
  const RigidBody b = *make_body(d);
  const double m1 = 1000 * 4.0 / 3 * M_PI * 0.027, m2 = 3 * m1;
  const double x = (-m1 + 2 * m2) / (m1 + m2);
  CHECK(b.mass == doctest::Approx(m1 + m2).epsilon(1e-13));
  CHECK(b.centre_body.x() == doctest::Approx(x).epsilon(1e-13));
  const double own = 0.4 * (m1 + m2) * 0.09;
  CHECK(b.inertia_body(0, 0) == doctest::Approx(own).epsilon(1e-12));
  CHECK(b.inertia_body(1, 1) ==
        doctest::Approx(own + m1 * (x + 1) * (x + 1) + m2 * (2 - x) * (2 - x)).epsilon(1e-12));
  CHECK(b.bounding_radius == doctest::Approx(x + 1 + 0.3));
}

TEST_CASE("a given mass overrides density, keeps the shape of the inertia, and needs no density") {
  BodyDef d = body(sphere(0.5), Vec3::Zero());
  d.mass = 7;
  CHECK(make_body(d)->inertia_body(1, 1) == doctest::Approx(0.4 * 7 * 0.25).epsilon(1e-13));
  d.shapes[0].material.density = 0;
  CHECK(make_body(d)->mass == doctest::Approx(7).epsilon(1e-14));
  CHECK(make_body(d)->inertia_body(1, 1) == doctest::Approx(0.4 * 7 * 0.25).epsilon(1e-13));
}

TEST_CASE("given moments of inertia stand in for what the shapes give, whatever the mass") {
  BodyDef d = body(box(0.5, 1, 1.5), Vec3::Zero());
  d.shapes[0].pose.x = {0, 4, 0};
  d.mass = 7;
  d.inertia = Vec3(2, 3, 4);
  const RigidBody b = *make_body(d);
  CHECK(b.mass == doctest::Approx(7).epsilon(1e-14));
  CHECK(b.inertia_body == Mat3(Vec3(2, 3, 4).asDiagonal()));
  CHECK((b.centre_body - Vec3(0, 4, 0)).norm() < 1e-14);
  d.inertia = Vec3(1, 2, 3);  // all mass in a plane
  CHECK(refusal(d).empty());
  for (const Vec3& wrong : {Vec3(1, 2, 3.1), Vec3(0, 1, 1), Vec3(-1, 1, 1), Vec3(1, 1, NAN)}) {
    d.inertia = wrong;
    CHECK(mentions(refusal(d), "moments of inertia must be > 0"));
  }
}

TEST_CASE("fixed and kinematic bodies have no inverse mass and keep their frame") {
  for (const BodyType type : {BodyType::fixed, BodyType::kinematic}) {
    BodyDef d = body(half_space(), {1, 2, 3});
    d.type = type;
    d.angular_velocity = {0, 1, 0};
    const RigidBody b = *make_body(d);
    CHECK(b.inverse_mass == 0);
    CHECK(b.mass == 0);
    CHECK(b.inverse_inertia_body.isZero(0));
    CHECK((b.pose.x - Vec3(1, 2, 3)).norm() == 0);
    CHECK(b.omega.isZero(0) == (type == BodyType::fixed));
  }
}

TEST_CASE("refused definitions say which value is wrong") {
  BodyDef d = body(sphere(-1), Vec3::Zero());
  CHECK(mentions(refusal(d), "shapes[0]"));
  CHECK(mentions(refusal(d), "-1"));
  d = body(sphere(1), Vec3::Zero());
  d.shapes.push_back(d.shapes[0]);
  d.shapes[1].material.friction = -0.25;
  CHECK(mentions(refusal(d), "shapes[1]"));
  CHECK(mentions(refusal(d), "friction must be >= 0, got -0.25"));
  d.shapes[1].material.friction = 0;
  d.shapes[1].material.restitution = 1.5;
  CHECK(mentions(refusal(d), "restitution must be in 0..1, got 1.5"));
  d.shapes[1].material.restitution = 0;
  CHECK(refusal(d).empty());
  d.mass = -3;
  CHECK(mentions(refusal(d), "mass must be > 0, got -3 kg"));
  d.mass.reset();
  d.velocity.x() = std::nan("");
  CHECK(mentions(refusal(d), "velocity"));
  d.velocity.setZero();
  d.pose.q = Quat(2, 0, 0, 0);
  CHECK(mentions(refusal(d), "unit quaternion"));
  CHECK_FALSE(refusal(body(half_space(), Vec3::Zero())).empty());
  CHECK(mentions(refusal(BodyDef{}), "at least one shape"));
}

TEST_CASE("an open mesh has no mass of its own and takes its hull's on request") {
  TriangleMesh open = make_mesh::box({0.5, 0.5, 0.5});
  open.triangles.pop_back();
  BodyDef d = body(mesh(open), Vec3::Zero());
  CHECK(mentions(refusal(d), "hull_mass"));
  d.hull_mass = true;
  const Result<RigidBody> made = make_body(d);
  REQUIRE_MESSAGE(made.ok(), refusal(d));
  CHECK(made->mass == doctest::Approx(1000).epsilon(1e-12));
  CHECK(made->inertia_body(0, 0) == doctest::Approx(1000.0 / 6).epsilon(1e-12));
}

TEST_CASE("a body whose mass, tensor and centre are given needs no shape") {
  BodyDef d;
  d.mass = 3;
  d.inertia = Vec3(2, 3, 4);
  d.products = Vec3(0.1, -0.2, 0.3);
  d.centre = Vec3(1, 0, -1);
  d.pose = {{5, 6, 7}, axis_angle(Vec3::UnitX(), 0.5)};
  DrawnShapeDef drawn;
  drawn.shape = sphere(0.25);
  drawn.pose.x = {1, 2, 3};
  drawn.colour = Vec3f(1, 0, 0);
  d.drawn.push_back(drawn);
  const Result<RigidBody> made = make_body(d);
  REQUIRE_MESSAGE(made.ok(), refusal(d));
  const Mat3 tensor(2, 0.1, -0.2, 0.1, 3, 0.3, -0.2, 0.3, 4);
  CHECK(made->inertia_body == tensor);
  CHECK((made->pose.x - d.pose.point({1, 0, -1})).norm() < 1e-15);
  CHECK(made->shapes.empty());
  REQUIRE(made->drawn);
  CHECK((*made->drawn)[0].part.pose.x == Vec3(0, 2, 4));
  // With shapes their mass counts no more.
  d.shapes = body(box(1, 1, 1), Vec3::Zero()).shapes;
  CHECK(make_body(d)->inertia_body == tensor);
  CHECK(make_body(d)->centre_body == Vec3(1, 0, -1));
  d.products = Vec3(3, 0, 0);  // principal moments -0.54, 5.54, 4
  CHECK(mentions(refusal(d), "moments of inertia"));
  d.inertia.reset();
  CHECK(mentions(refusal(d), "products of inertia need"));
  d.products.reset();
  CHECK(mentions(refusal(d), "a centre of mass needs"));
}

TEST_CASE("a turned body that is taken out and put back is turned as it was, bit by bit") {
  Random random(7);
  int moved_by_another_root = 0;
  for (int i = 0; i < 400; ++i) {
    Quat q;
    for (int k = 0; k < 4; ++k) q.coeffs()[k] = random.uniform(-1, 1);
    q.normalize();
    moved_by_another_root += q.normalized().coeffs() != q.coeffs();
    BodyDef def;
    def.shapes.emplace_back();
    def.pose.q = q;
    const auto once = make_body(def);
    REQUIRE(once.ok());
    CHECK(once->body_frame().q.coeffs() == q.coeffs());
    // What is off by more than rounding is made unit.
    def.pose.q.coeffs() *= 1 + 1e-14 * (1 + i);
    const auto longer = make_body(def);
    REQUIRE(longer.ok());
    CHECK(std::abs(longer->body_frame().q.squaredNorm() - 1) < 1e-15);
  }
  CHECK(moved_by_another_root > 10);
}
