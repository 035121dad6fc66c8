// The flyball governor of the IFToMM library of benchmarks (Gonzalez et al. 2006) under the event
// stepper: its arms hold the sleeve by springs so stiff that they are next to rods. Reference:
// Lagrange's equations of its three coordinates, written here and integrated by small steps.
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"
#include "tests/support/scale.hpp"

#include <array>
#include <cmath>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81, stiffness = 8e5, damping = 4e4, rest = 0.5;
constexpr double rod = 0.3, ball = 5, arm_mass = rod + ball, sleeve_mass = 3;
constexpr double centre = (0.5 * rod + ball) / arm_mass;  ///< of an arm, from its hinge [m]
constexpr double across = rod / 12 + rod * (centre - 0.5) * (centre - 0.5) +
                          ball * (1 - centre) * (1 - centre),
                 along = 1e-3, upright = 0.02;  ///< moments of inertia [kg m2]

/// Angle of the arms from the downward vertical and its rate, way of the sleeve below the hinge and
/// its speed, rate of the spindle.
struct State {
  double angle = std::numbers::pi / 6, rate = 0, way = 2 * 0.5 * std::cos(std::numbers::pi / 6),
         speed = 0, spin = 2 * std::numbers::pi;
};

struct Governor : EventWorld {
  Governor() : EventWorld(20000) {
    const State s;
    lump({0, -0.5, 0}, Quat::Identity(), 1, Vec3::Constant(upright));
    lump({0, -s.way, 0}, Quat::Identity(), sleeve_mass, Vec3::Constant(upright));
    for (const double side : {1.0, -1.0}) {
      const Quat q(axis_angle(Vec3::UnitZ(), side * s.angle));
      lump(q * Vec3(0, -centre, 0), q, arm_mass, {across, along, across});
    }
    for (RigidBody& b : bodies) {
      b.omega = {0, s.spin, 0};
      b.v = b.omega.cross(b.pose.x);
    }
    const Quat up = rotation_between(Vec3::UnitZ(), Vec3::UnitY());
    join(JointKind::revolute, no_body, 0, {Vec3::Zero(), up});
    join(JointKind::prismatic, 0, 1, {Vec3::Zero(), up});
    join(JointKind::revolute, 0, 2, {});
    join(JointKind::revolute, 0, 3, {});
    extra_force = [this](uint32_t slot, RigidBody& b) {
      if (slot == 2 || slot == 3) hold(b, b, bodies[1], 1);
      if (slot == 1)
        for (const uint32_t i : {2u, 3u}) hold(b, bodies[i], b, -1);
    };
  }
  void lump(const Vec3& x, const Quat& q, double mass, const Vec3& inertia) {
    BodyDef d;
    d.pose = {x, q};
    d.mass = mass;
    d.inertia = inertia;
    add(d);
  }
  /// Adds to `b` the force of the spring between the middle of an arm and the sleeve.
  static void hold(RigidBody& b, const RigidBody& arm, const RigidBody& sleeve, double sign) {
    const Vec3 lever = arm.pose.q * Vec3(0, centre - 0.5, 0);
    const Vec3 apart = sleeve.pose.x - arm.pose.x - lever;
    const Vec3 rate = sleeve.v - arm.v - arm.omega.cross(lever);
    const double length = apart.norm();
    const Vec3 n = apart / length;
    const Vec3 force = sign * (stiffness * (length - rest) + damping * n.dot(rate)) * n;
    b.force += force;
    if (&b == &arm) b.torque += lever.cross(force);
  }
  State state() const {
    const Vec3 down = bodies[0].pose.q.inverse() * (bodies[2].pose.q * -Vec3::UnitY());
    const Vec3 turning = bodies[2].omega - bodies[0].omega;
    return {std::atan2(down.x(), -down.y()), turning.dot(bodies[0].pose.q * Vec3::UnitZ()),
            -bodies[1].pose.x.y(), -bodies[1].v.y(), bodies[0].omega.y()};
  }
};

/// Change of angle, rate, way and speed; the spin follows from the angular momentum.
std::array<double, 4> change(const std::array<double, 4>& y, double spin) {
  const auto [a, rate, way, speed] = y;
  const double sine = std::sin(a), cosine = std::cos(a);
  const double length = std::hypot(0.5 * sine, way - 0.5 * cosine);
  const double by_angle = 0.5 * way * sine / length, by_way = (way - 0.5 * cosine) / length;
  const double pull = stiffness * (length - rest) + damping * (by_angle * rate + by_way * speed);
  const double moment = arm_mass * centre * centre + across;
  return {rate,
          ((moment - along) * sine * cosine * spin * spin - arm_mass * g * centre * sine -
           pull * by_angle) /
              moment,
          speed, g - 2 * pull * by_way / sleeve_mass};
}

double inertia_about_spindle(double angle) {
  const double sine = std::sin(angle);
  return 2 * upright + 2 * along + 2 * (arm_mass * centre * centre + across - along) * sine * sine;
}

State after(double seconds) {
  const State s;
  std::array<double, 4> y{s.angle, s.rate, s.way, s.speed};
  const double momentum = inertia_about_spindle(s.angle) * s.spin;
  const int steps = int(seconds * 2e5 + 0.5);
  const double h = seconds / steps;
  const auto at = [&](const std::array<double, 4>& d, double share) {
    std::array<double, 4> out = y;
    for (size_t i = 0; i < 4; ++i) out[i] += share * d[i];
    return out;
  };
  const auto rate_of = [&](const std::array<double, 4>& x) {
    return change(x, momentum / inertia_about_spindle(x[0]));
  };
  for (int k = 0; k < steps; ++k) {
    const auto a = rate_of(y), b = rate_of(at(a, h / 2)), c = rate_of(at(b, h / 2)),
               d = rate_of(at(c, h));
    for (size_t i = 0; i < 4; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return {y[0], y[1], y[2], y[3], momentum / inertia_about_spindle(y[0])};
}

}  // namespace

TEST_CASE("a flyball governor with stiff springs swings out as Lagrange's equations say") {
  Governor w;
  const double seconds = all_counts() ? 1 : only_to_run() ? 0.001 : 0.06;
  w.run(seconds);
  const State seen = w.state(), wanted = after(seconds);
  CHECK(seen.angle == doctest::Approx(wanted.angle).epsilon(1e-7));
  CHECK(seen.rate == doctest::Approx(wanted.rate).epsilon(1e-6));
  CHECK(seen.way == doctest::Approx(wanted.way).epsilon(1e-7));
  CHECK(seen.speed == doctest::Approx(wanted.speed).epsilon(1e-6));
  CHECK(seen.spin == doctest::Approx(wanted.spin).epsilon(1e-7));
  CHECK(w.joint_error() < 1e-12);
}
