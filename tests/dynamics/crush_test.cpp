// What nothing rigid can bear. References: of a ball in a wedge the angle of friction from which it
// locks itself, a half of what the walls' normals lack to a straight angle; kinematics of plates
// that close; of what is not crushed, velocities that are known to satisfy all conditions.
#include "engine/dynamics/event/impulses/crush.hpp"

#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"

#include <algorithm>
#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double pi = 3.14159265358979323846;

/// A ball of radius 1 as block 1 between the world and block 0, which moves; the normals are
/// towards the ball, in the plane.
struct SqueezedBall {
  std::vector<DofBlock> blocks{2};
  std::vector<ImpactPoint> points{2};

  SqueezedBall(double angle, double friction, const Vec3& v) {
    blocks[0].v = v;
    blocks[1].inverse_mass = 0.5;
    blocks[1].inverse_inertia = Mat3::Identity() * 1.25;
    const Vec3 normals[2] = {Vec3(0, 1, 0), Vec3(std::sin(angle), std::cos(angle), 0)};
    for (size_t k = 0; k < 2; ++k) {
      points[k].a = k == 0 ? no_block : 0, points[k].b = 1;
      points[k].normal = normals[k];
      points[k].arm_b = -normals[k];
      points[k].arm_a = 3 * normals[k];
      points[k].friction = friction;
    }
  }
};

Vec3 random_vector(Random& r) {
  Vec3 v;
  for (int k = 0; k < 3; ++k) v[k] = r.uniform(-1, 1);
  return v;
}

}  // namespace

TEST_CASE("crush: a ball between plates that come together, at their speed, not if they part") {
  SqueezedBall closing(pi, 0, {0, -2, 0});
  const std::optional<Crush> crush = find_crush(closing.blocks, closing.points);
  REQUIRE(crush);
  CHECK(!crush->by_friction);
  CHECK(crush->speed == doctest::Approx(2).epsilon(1e-6));
  CHECK(crush->shares[0] == doctest::Approx(1).epsilon(1e-6));
  CHECK(crush->shares[1] == doctest::Approx(1).epsilon(1e-6));
  SqueezedBall parting(pi, 0.5, {0, 2, 0});
  CHECK(!find_crush(parting.blocks, parting.points));
}

TEST_CASE("crush: a wedge that closes locks itself from the angle of friction on, not below it") {
  for (const double degrees : {60.0, 90.0, 120.0, 160.0}) {
    const double angle = degrees * pi / 180, bound = std::tan(0.5 * (pi - angle));
    for (const double share : {0.0, 0.9, 0.99, 1.01, 1.5}) {
      CAPTURE(degrees);
      CAPTURE(share);
      const SqueezedBall ball(angle, share * bound,
                              1.5 * Vec3(std::sin(angle), std::cos(angle), 0));
      const std::optional<Crush> jam = find_crush(ball.blocks, ball.points);
      CHECK(jam.has_value() == (share > 1));
      if (jam) CHECK(jam->by_friction);
    }
  }
}

TEST_CASE("crush: nothing is where velocities are known that satisfy all conditions") {
  Random r(77);
  for (int round = 0; round < 200; ++round) {
    std::vector<DofBlock> blocks(5);
    for (size_t i = 1; i < blocks.size(); ++i) {
      blocks[i].inverse_mass = r.uniform(0.1, 3);
      blocks[i].inverse_inertia =
          Vec3(r.uniform(1, 9), r.uniform(1, 9), r.uniform(1, 9)).asDiagonal();
    }
    std::vector<Vec3> v, omega;
    for (size_t i = 0; i < blocks.size(); ++i) {
      v.push_back(random_vector(r)), omega.push_back(random_vector(r));
      blocks[i].v = i == 0 ? v[0] : random_vector(r);
      blocks[i].omega = i == 0 ? omega[0] : random_vector(r);
    }
    std::vector<ImpactPoint> points;
    while (points.size() < 12) {
      ImpactPoint p;
      p.a = r.below(5), p.b = r.below(5);
      if (p.a == p.b) continue;
      p.normal = random_vector(r).normalized();
      p.arm_a = random_vector(r), p.arm_b = random_vector(r);
      p.friction = r.uniform(0, 1.5);
      const Vec3 u = v[p.b] + omega[p.b].cross(p.arm_b) - v[p.a] - omega[p.a].cross(p.arm_a);
      const double rate = p.normal.dot(u);
      if (rate > p.friction * (u - rate * p.normal).norm()) points.push_back(p);
    }
    CAPTURE(round);
    CHECK(!find_crush(blocks, points));
  }
}

TEST_CASE("event: a ball bounces off the end of a belt as off any wall") {
  // Reference: (restitution) times the speed. The belt's velocity along the normal was taken for
  // one of the wall, and what it held for leaving came on and on.
  for (const double belt : {-3.0, 3.0}) {
    EventWorld w(60);
    w.gravity.setZero();
    BodyDef wall = body(box(0.5, 2, 2), {1, 0, 0}, 0);
    wall.type = BodyType::fixed;
    wall.shapes[0].material.surface_velocity = {belt, 0, 0};
    w.add(wall);
    BodyDef ball = body(sphere(0.2), {0, 0, 0}, 0);
    ball.shapes[0].material.restitution = 0.5;
    ball.velocity = {2, 0, 0};
    const uint32_t i = w.add(ball);
    w.run(0.5);
    CHECK(w.bodies[i].v.x() == doctest::Approx(-1).epsilon(1e-12));
    CHECK(w.deepest < 1e-8);
  }
}

TEST_CASE("event: a box on a belt comes to rest at the belt that meets its end") {
  EventWorld w(240);
  for (const double side : {-1.0, 1.0}) {
    BodyDef belt = body(box(1, 0.5, 1), {1.0 * side, side < 0 ? -0.5 : -0.25, 0}, 0.7);
    belt.type = BodyType::fixed;
    belt.shapes[0].material.surface_velocity = {side < 0 ? 1.0 : 1.6, 0, -1.4};
    if (side < 0) belt.shapes[0].material.surface_velocity.z() = 0;
    w.add(belt);
  }
  const uint32_t i = w.add(body(box(0.2, 0.1, 0.2), {-0.6, 0.1, 0}, 0.7));
  w.run(1.2);
  CHECK(w.bodies[i].pose.x.x() == doctest::Approx(-0.2).epsilon(1e-6));
  CHECK(std::fabs(w.bodies[i].v.x()) < 1e-6);
  CHECK(w.deepest < 1e-8);
}

TEST_CASE("event: what is squeezed out of a wedge goes on, at the speed of kinematics") {
  // A plate at 45 degrees and one that comes at it along x: v = (V, V).
  EventWorld w(240);
  w.gravity.setZero();
  BodyDef plate = body(box(0.5, 5, 5), {-0.5 - 0.3, 0, 0}, 0);
  plate.type = BodyType::kinematic;
  plate.velocity = {1.5, 0, 0};
  w.add(plate);
  const double half = std::sqrt(0.5);
  BodyDef slope = body(box(0.5, 5, 5), Vec3(half, -half, 0) * 0.8, 0);
  slope.pose.q = axis_angle(Vec3::UnitZ(), -pi / 4);
  slope.type = BodyType::fixed;
  w.add(slope);
  const uint32_t i = w.add(body(sphere(0.3), {0, 0, 0}, 0));
  w.run(0.5);
  CHECK((w.bodies[i].v - Vec3(1.5, 1.5, 0)).norm() < 1e-9);
  CHECK(w.deepest < 1e-8);
}

TEST_CASE("event: bodies that overlapped go freely within what was accepted") {
  // Two balls meet halfway and the lower one comes back to where it was let into the floor.
  // Reference: uniform motion. A step ended at every 1e-8 m of the way back.
  EventWorld w(10);
  w.gravity.setZero();
  w.settings.recovery_speed = 0;
  w.floor(0);
  for (const double y : {0.4, 1.41}) {
    BodyDef ball = body(sphere(0.5), {0, y, 0}, 0);
    ball.shapes[0].material.restitution = 1;
    ball.velocity = {0, y < 1 ? 1.0 : -1.0, 0};
    w.add(ball);
  }
  w.step();
  CHECK(w.events < 10);
  CHECK(w.bodies[1].pose.x.y() == doctest::Approx(0.49).epsilon(1e-7));
  CHECK(w.bodies[1].v.y() == doctest::Approx(1).epsilon(1e-9));
}

TEST_CASE(
    "event: of bodies that overlap the points change as they slide, and nothing is in deeper") {
  // Reference: a capsule put into the edge of a box hits it at once, without restitution; along the
  // box's long side, where nothing acts, it goes on as before. The second point of its manifold,
  // where the face ends, is another one all the time: as its own depth was held to that of the
  // last, a tick took ten thousand steps.
  EventWorld w(1000);
  w.gravity.setZero();
  w.fixed(box(1.5, 0.15, 0.1), {0, 0.16, 0}, 0);
  BodyDef d = body(capsule(0.16, 0.553), {0.5308, 0.5, 0.2746}, 0);
  d.pose.q = Quat(0.1246, 0.0807, -0.7607, -0.6319).normalized();
  d.velocity = {0.982, -0.282, 0.089};
  const uint32_t i = w.add(d);
  const double energy = w.energy();
  for (int k = 0; k < 3; ++k) {
    w.step();
    CHECK(w.stepper.stats.steps < 10);
  }
  CHECK(w.bodies[i].v.x() == doctest::Approx(0.982).epsilon(1e-9));
  CHECK(w.energy() < energy);
  CHECK(w.deepest < 1e-8);
}
