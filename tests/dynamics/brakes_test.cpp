// Friction of joints, and of contacts beside joints, under the realtime solver, in precise and in
// ordinary islands. References: a wheel of inertia I at the rate w with the friction torque T
// stands still after I w / T, at the angle I w^2 / (2 T), whatever carries it, as long as that is
// not turned by the reaction; a block slows down by mu g.
#include "tests/dynamics/joint_world.hpp"

#include <cmath>
#include <memory>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double torque = 0.4, omega = 8;

constexpr double g = 9.81;

/// How a wheel stands still.
struct Stand {
  double time = 0, angle = 0;  ///< over those of the closed form
};

struct BrakeWorld : JointWorld {
  uint32_t wheel = 0;

  explicit BrakeWorld(double hz, bool ordinary) : JointWorld(hz) {
    gravity.setZero();
    if (ordinary) settings.max_substeps = settings.substeps;  // as in large islands
  }
  uint32_t block(const Vec3& half, const Vec3& at, double mass) {
    BodyDef d = body(box(half.x(), half.y(), half.z()), at, 0.6);
    d.mass = mass;
    return add(d);
  }
  /// On a braked hinge at its centre, along z of `at`.
  void add_wheel(uint32_t base, const Pose& at) {
    BodyDef d = body(box(0.3, 0.3, 0.1), at.x, 0.6);
    d.pose.q = at.q;
    d.mass = 2;
    d.angular_velocity = omega * (at.q * Vec3::UnitZ());
    wheel = add(d);
    join(JointKind::revolute, base, wheel, at);
    JointDrives drives;
    drives[0].friction = torque;
    joints.back().drives = std::make_shared<JointDrives>(drives);
  }
  /// Links along x on hinges along z; the last of them.
  uint32_t row(int count) {
    uint32_t last = no_body;
    for (int i = 0; i < count; ++i) {
      const uint32_t slot = block({0.25, 0.05, 0.05}, {0.5 * i + 0.25, 0, 0}, 1);
      join(JointKind::revolute, last, slot, {Vec3(0.5 * i, 0, 0), Quat::Identity()});
      last = slot;
    }
    return last;
  }
  Stand stop() {
    const Joint& joint = joints.back();
    const double inertia = bodies[wheel].inertia_body(2, 2);
    const auto rate = [&] {
      const Vec3 along = bodies[wheel].pose.q * Vec3::UnitZ();
      const Vec3 base = joint.a == no_body ? Vec3(Vec3::Zero()) : bodies[joint.a].omega;
      return std::fabs(along.dot(bodies[wheel].omega - base));
    };
    const double time = inertia * omega / torque;
    Stand out;
    double before = rate();
    int ticks = 0;
    for (; ticks * h < 2 * time && before > 1e-3 * omega; ++ticks) {
      step();
      const double now = rate();
      // Within the last tick it stands where the straight line ends.
      out.time += now > 1e-3 * omega ? h : before * inertia / torque;
      before = now;
    }
    out.time /= time;
    out.angle = std::fabs(joint.value[0]) / (0.5 * omega * time);
    return out;
  }
};

}  // namespace

TEST_CASE("a brake stops its wheel after I w / T, alone, at the end of a chain and in a pile") {
  for (const bool ordinary : {false, true})
    for (const double hz : {60.0, 240.0, 960.0}) {
      CAPTURE(ordinary);
      CAPTURE(hz);
      const auto stops = [](BrakeWorld& w) {
        const Stand stand = w.stop();
        CHECK(stand.time == doctest::Approx(1).epsilon(2e-3));
        CHECK(stand.angle == doctest::Approx(1).epsilon(3e-3));
      };
      BrakeWorld alone(hz, ordinary);
      alone.add_wheel(no_body, {});
      stops(alone);
      // The reaction twists the chain, which its hinges do not follow.
      BrakeWorld chain(hz, ordinary);
      chain.add_wheel(chain.row(10), frame_along({5.2, 0, 0}, Vec3::UnitX(), Vec3::UnitY()));
      stops(chain);
      // A block that friction keeps where it is, between stacks of others.
      BrakeWorld pile(hz, ordinary);
      pile.gravity = {0, -g, 0};
      pile.floor(0.6);
      const uint32_t base = pile.block({0.5, 0.2, 0.5}, {0, 0.2, 0}, 20);
      for (const double x : {-1.25, -0.75, 0.75, 1.25})
        for (int k = 0; k < 4; ++k) pile.block({0.25, 0.25, 0.25}, {x, 0.25 + 0.5 * k, 0}, 5);
      pile.add_wheel(base, frame_along({0, 0.6, 0}, Vec3::UnitY(), Vec3::UnitX()));
      stops(pile);
    }
}

TEST_CASE("blocks in a joint lose no more friction while they sink in than one alone") {
  for (const bool ordinary : {false, true})
    for (const double hz : {60.0, 240.0, 960.0}) {
      CAPTURE(ordinary);
      CAPTURE(hz);
      BrakeWorld w(hz, ordinary);
      w.gravity = {0, -g, 0};
      w.floor(0.3);
      const double mu = std::sqrt(0.3 * 0.6);
      const auto sliding = [&](const Vec3& at) {
        const uint32_t slot = w.block({0.2, 0.1, 0.2}, at, 1);
        w.bodies[slot].v = {4, 0, 3};
        return slot;
      };
      const uint32_t behind = sliding({0, 0.1, 0}), ahead = sliding({0.8, 0.1, 0.6});
      w.join(JointKind::rigid, behind, ahead, {Vec3(0.4, 0.1, 0.3), Quat::Identity()});
      w.run(0.5);
      for (const uint32_t slot : {behind, ahead})
        CHECK((5 - w.bodies[slot].v.norm()) / (mu * g * 0.5) == doctest::Approx(1).epsilon(5e-3));
    }
}
