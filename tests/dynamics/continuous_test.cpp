// Fast bodies do not pass through thin ones. Reference: plain geometry, on which side of the wall a
// body is; the collision of equal spheres for what follows.
#include "engine/geometry/make_mesh.hpp"
#include "tests/dynamics/piles.hpp"

using namespace tumble;
using namespace tumble::test;

namespace {

/// Fires bullets of a shape at a wall in the plane x = 3; gives how many came through.
int shoot(const ShapeDef& wall, const ShapeDef& bullet, int count, const Vec3& spin) {
  int through = 0;
  Random r(5);
  for (int i = 0; i < count; ++i) {
    RigidWorld w;
    w.gravity.setZero();
    w.fixed(wall, {3, 0, 0});
    BodyDef d = body(bullet, {r.uniform(-5, 2.9), 0, 0});
    d.velocity = {1000, r.uniform(-100, 100), r.uniform(-100, 100)};
    d.angular_velocity = spin;
    const uint32_t b = w.add(d);
    w.run(0.25);
    through += w.bodies[b].pose.x.x() > 3;
  }
  return through;
}

/// Balls of 5 mm at rest, scattered below y = 1; `turn` says whether they can, as particles cannot.
void scatter_balls(RigidWorld& w, int count, bool turn) {
  Random r(11);
  for (int i = 0; i < count; ++i) {
    BodyDef d = body(sphere(0.005), {r.uniform(-.25, .25), r.uniform(-1, 1), r.uniform(-.25, .25)});
    d.mass = 0.001;
    RigidBody& ball = w.bodies[w.add(d)];
    if (turn) continue;
    ball.inertia_body.setZero();
    ball.inverse_inertia_body.setZero();
  }
}

/// A kinematic wall of 4 mm that comes down at `speed` [m/s].
uint32_t add_falling_wall(RigidWorld& w, const ShapeDef& wall, double y, double speed) {
  BodyDef d = body(wall, {0, y, 0});
  d.type = BodyType::kinematic;
  d.velocity = {0, -speed, 0};
  return w.add(d);
}

/// How many of the balls are above y, or in the way of a wall of 4 mm there.
int left_behind(const RigidWorld& w, double y) {
  int count = 0;
  for (const RigidBody& b : w.bodies) count += b.bounding_radius < 0.01 && b.pose.x.y() > y - 0.002;
  return count;
}

/// A sheet of two triangles in the plane y = 0, whose normals point down.
ShapeDef sheet() {
  TriangleMesh m;
  m.vertices = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh(m);
}

}  // namespace

TEST_CASE("a kinematic wall leaves nothing behind that lies in its way, at any speed") {
  const ShapeDef plate = box(1, 0.002, 1), shell = mesh(make_mesh::box({1, 0.002, 1}));
  for (const ShapeDef& wall : {plate, shell}) {
    for (const bool turn : {true, false}) {
      for (const double speed : {60.0, 20.0, 6.0, 1.0}) {
        CAPTURE(speed);
        CAPTURE(turn);
        RigidWorld w;
        w.gravity.setZero();
        const uint32_t k = add_falling_wall(w, wall, speed < 6 ? 1.1 : 3, speed);
        scatter_balls(w, 40, turn);
        w.run((w.bodies[k].pose.x.y() + 1.2) / speed + 2 * w.h);
        CHECK(w.bodies[k].pose.x.y() < -1);
        CHECK(left_behind(w, w.bodies[k].pose.x.y()) == 0);
      }
    }
  }
}

TEST_CASE("a kinematic wall wakes and takes along what sleeps in its way") {
  for (const double speed : {2.0, 40.0}) {
    CAPTURE(speed);
    RigidWorld w;
    w.gravity.setZero();
    const uint32_t k = add_falling_wall(w, box(1, 0.002, 1), 1.1 + speed, speed);
    scatter_balls(w, 40, true);
    w.run(0.9);
    CHECK(w.awake() == 0);
    w.run(0.1 + 2.3 / speed + 2 * w.h);
    CHECK(w.bodies[k].pose.x.y() < -1);
    CHECK(left_behind(w, w.bodies[k].pose.x.y()) == 0);
  }
}

TEST_CASE("what a kinematic wall takes along is held by what is fixed") {
  RigidWorld w;
  w.gravity.setZero();
  w.fixed(box(1, 0.002, 1), {0, -0.5, 0});
  add_falling_wall(w, box(1, 0.002, 1), 3, 60);
  for (const double x : {-0.2, 0.1}) w.add(body(sphere(0.005), {x, -0.3, 0}));
  w.run(0.1);
  for (const RigidBody& b : w.bodies)
    if (b.dynamic()) CHECK(b.pose.x.y() > -0.5);
}

TEST_CASE("a turning vane takes along what lies in its way") {
  RigidWorld w;
  w.gravity.setZero();
  BodyDef d = body(box(1, 0.1, 0.002), {0, 0, 0});
  d.type = BodyType::kinematic;
  d.angular_velocity = {0, -40, 0};  // 0.67 rad in a tick
  const uint32_t k = w.add(d);
  Random r(3);
  std::vector<uint32_t> balls;
  for (int i = 0; i < 30; ++i) {
    const double angle = r.uniform(0.3, 1.2), radius = r.uniform(0.2, 0.8);
    balls.push_back(
        w.add(body(sphere(0.005), {radius * std::cos(angle), 0, radius * std::sin(angle)})));
  }
  w.run(2.5 * w.h);  // past all of them, before half a turn
  for (const uint32_t i : balls) {
    const Vec3 local = w.bodies[k].pose.inverse().point(w.bodies[i].pose.x);
    CHECK(local.z() > 0);
  }
}

TEST_CASE("what slept on a body that a kinematic one takes away falls") {
  RigidWorld w;
  w.fixed(box(1, 0.5, 1), {0, -0.5, 0});
  w.add(body(box(0.1, 0.1, 0.1), {0, 0.1, 0}));
  const uint32_t upper = w.add(body(box(0.1, 0.1, 0.1), {0, 0.3, 0}));
  w.run(1.5);
  REQUIRE(w.awake() == 0);
  BodyDef bar = body(box(0.02, 0.04, 0.5), {-0.8, 0.1, 0});
  bar.type = BodyType::kinematic;
  bar.velocity = {60, 0, 0};
  w.add(bar);
  w.run(0.5);
  CHECK(w.bodies[upper].pose.x.y() < 0.15);
}

TEST_CASE("a small ball without friction stays at the bottom of a drum that turns fast") {
  RigidWorld w;
  BodyDef drum = body(box(0.3, 0.01, 0.2), {0, 0, 0}, 0);
  const BodyShapeDef plate = drum.shapes[0];
  drum.shapes.clear();
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * M_PI * i / 24;
    BodyShapeDef& wall = drum.shapes.emplace_back(plate);
    wall.pose.x = {0.5 * std::sin(angle), -0.5 * std::cos(angle), 0};
    wall.pose.q = Quat(std::cos(angle / 2), 0, 0, std::sin(angle / 2));
  }
  drum.type = BodyType::kinematic;
  drum.angular_velocity = {0, 0, 2 * M_PI};
  w.add(drum);
  const uint32_t ball = w.add(body(sphere(0.003), {0, -0.48, 0}, 0));
  double farthest = 0;
  for (int i = 0; i < 60; ++i) {
    w.run(w.h);
    farthest = std::max(farthest, std::fabs(w.bodies[ball].pose.x.x()));
  }
  CHECK(farthest < 0.1);  // the wall goes 3 m
}

TEST_CASE("bullets at 1000 m/s stop at a plate of 0.5 mm and at a mesh of 0.1 mm" *
          doctest::test_suite("long")) {
  const int count = scaled(60, 10);
  const Vec3 spin(100, 200, 300);
  const ShapeDef plate = box(0.00025, 20, 20);
  const ShapeDef shell = mesh(make_mesh::box({0.00005, 20, 20}));
  for (const ShapeDef& wall : {plate, shell}) {
    CHECK(shoot(wall, sphere(0.005), count, Vec3::Zero()) == 0);
    CHECK(shoot(wall, box(0.01, 0.005, 0.005), count, spin) == 0);
    CHECK(shoot(wall, capsule(0.004, 0.02), count, spin) == 0);
  }
}

TEST_CASE("two bullets meet in flight") {
  RigidWorld w;
  w.gravity.setZero();
  BodyDef a = body(sphere(0.005), {-4, 0, 0}, 0, 1), b = body(sphere(0.005), {4, 0, 0}, 0, 1);
  a.velocity = {500, 0, 0};
  b.velocity = {-600, 0, 0};
  w.add(a);
  w.add(b);
  w.run(0.1);
  CHECK(w.bodies[0].v.x() == doctest::Approx(-600).epsilon(1e-9));
  CHECK(w.bodies[1].v.x() == doctest::Approx(500).epsilon(1e-9));
  CHECK(w.bodies[0].pose.x.x() < w.bodies[1].pose.x.x());
}

TEST_CASE("a bullet that is stopped gets into the way of the next one") {
  RigidWorld w;
  w.gravity.setZero();
  w.fixed(box(0.0005, 5, 5), {3, 0, 0});
  for (int i = 0; i < 3; ++i) {
    BodyDef d = body(sphere(0.01), {-0.5 * i, 0, 0}, 0.5, 0);
    d.velocity = {800, 0, 0};
    w.add(d);
  }
  w.run(0.2);
  for (uint32_t i = 1; i <= 3; ++i) CHECK(w.bodies[i].pose.x.x() < 3);
  CHECK(w.bodies[1].pose.x.x() > w.bodies[2].pose.x.x());
  CHECK(w.bodies[2].pose.x.x() > w.bodies[3].pose.x.x());
}

TEST_CASE("the tip of a spinning rod does not cut through a plate") {
  RigidWorld w;
  w.gravity.setZero();
  BodyDef rod = body(capsule(0.01, 2), Vec3::Zero());
  rod.angular_velocity = {0, 0, 50};  // turns by 48 degrees a tick, counter-clockwise from +y
  const uint32_t i = w.add(rod);
  w.fixed(box(0.3, 0.0005, 0.3), {-0.8, 0, 0});
  double before = w.bodies[i].omega.z();
  for (int k = 0; k < 30; ++k) {
    w.step();
    before = std::min(before, w.bodies[i].omega.z());
  }
  CHECK(before < 40);  // it was hit
}

TEST_CASE("what slides fast along the floor is not held up by it") {
  RigidWorld w;
  w.floor(0);
  BodyDef d = body(sphere(0.05), {0, 0.05, 0}, 0);
  d.velocity = {30, 0, 0};
  const uint32_t i = w.add(d);
  w.run(1);
  CHECK(w.bodies[i].pose.x.x() == doctest::Approx(30).epsilon(1e-3));
}

TEST_CASE("a ball rolls fast over a floor of triangles without stumbling") {
  RigidWorld w;
  w.fixed(mesh(make_mesh::terrain(80, 80, [](double, double) { return 0.0; })), Vec3::Zero(), 0.5);
  BodyDef d = body(sphere(0.1), {-35, 0.1, 0.3}, 0.5);
  d.velocity = {20, 0, 0.4};
  d.angular_velocity = {4, 0, -200};
  const uint32_t i = w.add(d);
  w.run(3);
  CHECK(w.bodies[i].pose.x.x() == doctest::Approx(25).epsilon(0.01));
  CHECK(w.bodies[i].pose.x.y() == doctest::Approx(0.1).epsilon(0.05));
}

namespace {

/// Corners of a box, ends of a capsule's axis, points of a cylinder's rims; world axes [m].
std::vector<Vec3> ends(const RigidBody& b) {
  const ShapeDef& d = b.shapes[0].shape->def();
  std::vector<Vec3> points;
  for (int k = 0; k < 8; ++k) {
    const double x = k & 1 ? 1 : -1, y = k & 2 ? 1 : -1, z = k & 4 ? 1 : -1;
    Vec3 p = d.half_extents.cwiseProduct(Vec3(x, y, z));
    if (d.type == ShapeType::capsule) p = Vec3(0, 0.5 * y * d.height, 0);
    if (d.type == ShapeType::cylinder)
      p = Vec3(x * d.radius * std::sqrt(0.5), 0.5 * y * d.height, z * d.radius * std::sqrt(0.5));
    points.push_back(b.pose.point(p));
  }
  return points;
}

}  // namespace

TEST_CASE("whirling needles and plates stay wholly on their side of glass, and make no energy") {
  const ShapeDef thin[] = {capsule(0.0025, 0.3), box(0.15, 0.002, 0.003), box(0.06, 0.0005, 0.045),
                           cylinder(0.05, 0.0015)};
  const ShapeDef walls[] = {box(0.0005, 20, 20), mesh(make_mesh::box({0.0005, 20, 20}))};
  Random r(11);
  for (int i = 0; i < scaled(200, 16); ++i) {
    CAPTURE(i);
    RigidWorld w(i % 3 == 0 ? 30 : 60);
    w.gravity.setZero();
    w.fixed(walls[i / 4 % 2], {3, 0, 0}, 0.3);
    BodyDef d = body(thin[i % 4], {r.uniform(2, 2.8), 0, 0}, 0.3);
    d.velocity = {r.uniform(5, 100), r.uniform(-10, 10), r.uniform(-10, 10)};
    d.angular_velocity =
        r.uniform(10, 1000) * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
    const uint32_t b = w.add(d);
    double energy = w.bodies[b].kinetic_energy();
    for (int k = 0; k < 30; ++k) {
      w.step();
      const double now = w.bodies[b].kinetic_energy();
      CHECK(now <= energy * 1.01);
      energy = now;
      for (const Vec3& x : ends(w.bodies[b])) CHECK(x.x() < 3);
    }
  }
}

TEST_CASE("blows give a needle no energy, whatever it turns by in a tick") {
  Random r(17);
  for (int i = 0; i < scaled(150, 15); ++i) {
    CAPTURE(i);
    const double hz[] = {30, 120, 1000};
    RigidWorld w(hz[i % 3]);
    w.gravity.setZero();
    const double restitution[] = {0, 0.5, 1}, e = restitution[i / 3 % 3];
    w.fixed(box(1, 20, 20), {4, 0, 0}, 0, e);
    const ShapeDef thin = i % 2 ? capsule(0.0025, 0.3) : box(0.15, 0.001, 0.002);
    for (const double x : {2.6, 2.3}) {  // the second one strikes the first
      BodyDef d = body(thin, {x, 0, 0}, 0, e);
      d.velocity = {x > 2.5 ? r.uniform(5, 20) : 40, 0, 0};
      d.angular_velocity = 150 * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
      w.add(d);
    }
    double energy = w.kinetic_energy();
    for (int k = 0; k < int(0.1 * hz[i % 3]); ++k) {
      w.step();
      const double now = w.kinetic_energy();
      CHECK(now <= 1.01 * energy);
      energy = now;
    }
  }
}

TEST_CASE("boxes, hulls and meshes stop at a sheet of triangles from either side") {
  TriangleMesh wedge;
  wedge.vertices = {{-0.1, 0, -0.1}, {0.1, 0, -0.1}, {0, 0, 0.1}, {0, 0.1, 0}};
  for (const double from : {1.0, -1.0}) {
    for (const double speed : {300.0, 30.0, 3.0, 0.3}) {
      for (const ShapeDef& shape : {box(0.01, 0.01, 0.01), box(0.2, 0.1, 0.2), hull(wedge),
                                    mesh(make_mesh::torus(0.1, 0.04, 10, 6))}) {
        CAPTURE(from);
        CAPTURE(speed);
        RigidWorld w;
        w.gravity.setZero();
        w.fixed(sheet());
        BodyDef d = body(shape, {0.1, 0.4 * from, 0.2});
        d.velocity = {0, -speed * from, 0};
        d.angular_velocity = {0.3, 0.2, 0.1};
        const uint32_t i = w.add(d);
        w.run(0.6 / speed + 0.1);
        CHECK(w.bodies[i].pose.x.y() * from > 0);
      }
    }
  }
}

TEST_CASE("round bodies stop at a sheet of triangles from either side") {
  for (const double from : {1.0, -1.0}) {
    for (const double speed : {300.0, 30.0, 3.0, 0.3}) {
      for (const ShapeDef& shape :
           {sphere(0.002), sphere(0.05), capsule(0.02, 0.1), cylinder(0.05, 0.1)}) {
        CAPTURE(from);
        CAPTURE(speed);
        RigidWorld w;
        w.gravity.setZero();
        w.fixed(sheet());
        BodyDef d = body(shape, {0.1, 0.4 * from, 0.2});
        d.velocity = {0, -speed * from, 0};
        const uint32_t i = w.add(d);
        w.run(0.6 / speed + 0.1);
        CHECK(w.bodies[i].pose.x.y() * from > 0);
      }
    }
  }
}
