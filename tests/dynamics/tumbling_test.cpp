// Convex bodies of every kind that tumble against each other under the event stepper. References:
// planes that separate the bodies (overlap_certificate.hpp), conservation of energy.
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"
#include "tests/dynamics/overlap_certificate.hpp"
#include "tests/dynamics/piles.hpp"
#include "tests/support/scale.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double accepted = 1e-5;  ///< depth that no contact may exceed [m]

ShapeDef draw_shape(Random& r, int kind) {
  const auto size = [&] { return r.uniform(0.08, 0.3); };
  switch (kind) {
    case 0:
      return sphere(size());
    case 1:
      return capsule(size(), r.uniform(0.1, 0.6));
    case 2:
      return box(size(), size(), size());
    case 3:
      return cylinder(size(), r.uniform(0.05, 0.6));
    default:
      return random_hull(r, 4 + int(r.below(20)), size());
  }
}
constexpr const char* kind_names[] = {"sphere", "capsule", "box", "cylinder", "hull"};

Vec3 draw_vector(Random& r, double size) {
  return {r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size)};
}

BodyDef draw_body(Random& r, int kind, const Vec3& x, double speed, double spin) {
  BodyDef d = body(draw_shape(r, kind), x, r.below(3) ? r.uniform(0, 1) : 0,
                   r.below(3) ? r.uniform(0, 1) : 0);
  d.pose.q = Quat(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
  d.pose.q.normalize();
  d.velocity = draw_vector(r, speed);
  d.angular_velocity = draw_vector(r, spin);
  return d;
}

/// Runs a world tick by tick and asserts what must hold at each. What the integrator errs by in
/// free rotation at 12 rad/s is below 3e-6 of the energy.
void watch(EventWorld& w, double seconds) {
  const int ticks = int(seconds / w.h + 0.5);
  double energy = w.energy();
  for (int i = 0; i < ticks; ++i) {
    w.step();
    CAPTURE(i);
    double scale = 0;
    for (const RigidBody& b : w.bodies)
      if (b.dynamic()) scale += b.kinetic_energy() + b.mass * 9.81 * 0.3;
    const double now = w.energy();
    REQUIRE(deepest_certified_overlap(w.bodies) <= accepted);
    CHECK(w.stepper.stats.deepest <= accepted);
    REQUIRE(now <= energy + 3e-6 * scale);
    energy = now;
  }
}

}  // namespace

TEST_CASE("tumbling: pairs of every kind of shape overlap by no more than is accepted" *
          doctest::test_suite("long")) {
  const int rounds = scaled(8, 1);
  for (int round = 0; round < rounds; ++round)
    for (int ka = 0; ka < 5; ++ka)
      for (int kb = ka; kb < 5; ++kb) {
        Random r(uint64_t(1000 * round + 10 * ka + kb + 1));
        EventWorld w;
        if (round % 2) {
          w.floor(0.5, 0.3);
        } else {
          w.fixed(box(20, 1, 20), {0, -1, 0}, 0.5, 0.3);
        }
        BodyDef a = draw_body(r, ka, {0, 1, 0}, 2, 12), b = draw_body(r, kb, {1.2, 1, 0}, 2, 12);
        a.velocity.x() = r.uniform(0, 3), b.velocity.x() = -r.uniform(0, 3);
        w.add(a);
        w.add(b);
        CAPTURE(kind_names[ka]);
        CAPTURE(kind_names[kb]);
        CAPTURE(round);
        watch(w, 2);
      }
}

TEST_CASE("tumbling: heaps of four to six bodies of any kind") {
  const int rounds = scaled(8, 1);
  for (int round = 0; round < rounds; ++round) {
    Random r(uint64_t(77 + round));
    EventWorld w;
    if (round % 2) {
      w.floor(0.5, 0.3);
    } else {
      w.fixed(box(20, 1, 20), {0, -1, 0}, 0.5, 0.3);
    }
    const int count = 4 + int(r.below(3));
    for (int i = 0; i < count; ++i) {
      const Vec3 x(r.uniform(-0.2, 0.2), 0.6 + 0.9 * i, r.uniform(-0.2, 0.2));
      w.add(draw_body(r, int(r.below(5)), x, 1, 20));
    }
    CAPTURE(round);
    watch(w, 2);
  }
}

TEST_CASE("tumbling: a cylinder's rim on a box's edges and corners, and between two boxes") {
  // These came 0.07 m deep within a tick when a rim on an edge was a frozen tangent plane.
  for (int i = 0; i < scaled(12, 2); ++i) {
    Random r(uint64_t(500 + i));
    EventWorld w;
    w.floor();
    w.fixed(box(0.3, 0.3, 0.3), {-0.5, 0.3, 0});
    w.fixed(box(0.3, 0.3, 0.3), {0.5, 0.3, 0.05});
    BodyDef d = body(cylinder(r.uniform(0.1, 0.4), r.uniform(0.05, 0.5)),
                     {r.uniform(-0.3, 0.3), 1.3, r.uniform(-0.3, 0.3)}, 0.4, 0.2);
    d.pose.q = Quat(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), 0.5).normalized();
    d.velocity = {0, -3, 0};
    d.angular_velocity = draw_vector(r, 20);
    w.add(d);
    CAPTURE(i);
    watch(w, 2);
  }
}

TEST_CASE("tumbling: coins that wobble, land flat and roll stay on the floor" *
          doctest::test_suite("long")) {
  for (const double tilt : {1.2, 0.5, 0.1, 0.01, 0.0}) {
    EventWorld w;
    w.floor(0.4, 0.2);
    const double radius = 0.3, half = 0.02;
    BodyDef d = body(cylinder(radius, 2 * half), {0, 0, 0}, 0.4, 0.2);
    d.pose.q = axis_angle(Vec3::UnitX(), tilt);
    d.pose.x.y() = radius * std::sin(tilt) + half * std::cos(tilt) + 0.01;
    d.angular_velocity = {0.3, 8, 0};
    w.add(d);
    CAPTURE(tilt);
    watch(w, test::only_to_run() ? 0.3 : 2);
  }
}
