// Reactions of joints at a moment. References: the tension of a pendulum, m g cos + m v^2 / L; two
// rods in a row by Lagrange's equations in long double with a Runge-Kutta method of the fourth
// order and a tenth of the tick, whose own error is below 1e-10 N here; the torque omega x I omega
// of a rotor that is out of balance; statics with a contact, and by symmetry where joints share a
// load in many ways.
#include "engine/math/rotation.hpp"
#include "engine/world/world.hpp"
#include "tests/support/why_not.hpp"

#include <array>
#include <cmath>
#include <string>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr double g = 9.81;

std::unique_ptr<World> world_of(const std::string& stepper, int hz) {
  WorldDef def;
  def.settings.stepper = stepper;
  def.settings.tick.num = hz;
  return std::move(*World::create(def));
}

BodyDef ball(const Vec3& x, double mass = 2) {
  BodyDef d;
  d.pose.x = x;
  d.shapes.emplace_back();
  d.shapes[0].shape.type = ShapeType::sphere;
  d.shapes[0].shape.radius = 0.1;
  d.mass = mass;
  return d;
}

BodyDef block(const Vec3& x, const Vec3& half, double mass) {
  BodyDef d = ball(x, mass);
  d.shapes[0].shape.type = ShapeType::box;
  d.shapes[0].shape.half_extents = half;
  return d;
}

JointDef joint(JointKind kind, BodyId a, BodyId b, const Vec3& on_a, const Vec3& on_b) {
  JointDef d;
  d.kind = kind;
  d.a = a;
  d.b = b;
  d.frame_a.x = on_a;
  d.frame_b.x = on_b;
  return d;
}

std::vector<JointReaction> reactions(const World& w) {
  auto found = w.joint_reactions();
  REQUIRE_MESSAGE(found.ok(), test::why_not(found));
  return *std::move(found);
}

void run(World& w, int ticks) {
  for (int i = 0; i < ticks; ++i) REQUIRE(w.step().ok());
}

/// A ball of 2 kg on a thread of 1.5 m, released at 60 degrees.
struct Pendulum {
  static constexpr double length = 1.5, mass = 2, angle = M_PI / 3;
  std::unique_ptr<World> world;
  BodyId id;
  Pendulum(const std::string& stepper, int hz) : world(world_of(stepper, hz)) {
    id = *world->create_body(ball({length * std::sin(angle), -length * std::cos(angle), 0}, mass));
    JointDef thread = joint(JointKind::distance, {}, id, Vec3::Zero(), Vec3::Zero());
    thread.length = length;
    REQUIRE(world->create_joint(thread).ok());
    REQUIRE(world->apply_commands().ok());
  }
  /// From its place and velocity.
  Vec3 tension() const {
    const RigidBody& b = *world->body(id);
    const Vec3 up = -b.pose.x.normalized();
    return (mass * g * up.y() + mass * b.v.squaredNorm() / b.pose.x.norm()) * up;
  }
  /// From its height alone, as it began at rest.
  double tension_of_energy() const {
    const double cosine = -world->body(id)->pose.x.y() / length;
    return mass * g * (3 * cosine - 2 * std::cos(angle));
  }
};

/// Two rods of 1 m and 1 kg that hang in a row, by their angles from the vertical.
struct Rods {
  using Real = long double;
  using State = std::array<Real, 4>;  // angles and their rates
  static constexpr Real l = 1, c = 0.5L, m = 1, I = 1.01L / 12, gravity = 9.81L;

  static std::array<Real, 2> accelerations(const State& y) {
    const Real cosine = std::cos(y[0] - y[1]), sine = std::sin(y[0] - y[1]);
    const Real m11 = I + m * c * c + m * l * l, m12 = m * l * c * cosine, m22 = I + m * c * c;
    const Real r1 = -m * l * c * sine * y[3] * y[3] - m * (c + l) * gravity * std::sin(y[0]);
    const Real r2 = m * l * c * sine * y[2] * y[2] - m * c * gravity * std::sin(y[1]);
    const Real det = m11 * m22 - m12 * m12;
    return {(m22 * r1 - m12 * r2) / det, (m11 * r2 - m12 * r1) / det};
  }
  static State rate(const State& y) {
    const auto a = accelerations(y);
    return {y[2], y[3], a[0], a[1]};
  }
  static State stepped(const State& y, Real h) {
    const auto at = [&](const State& k, Real s) {
      State out = y;
      for (size_t i = 0; i < 4; ++i) out[i] += s * k[i];
      return out;
    };
    const State k1 = rate(y), k2 = rate(at(k1, h / 2)), k3 = rate(at(k2, h / 2)),
                k4 = rate(at(k3, h));
    State out = y;
    for (size_t i = 0; i < 4; ++i) out[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    return out;
  }
  /// Forces on the upper rod at its pivot and on the lower one between them.
  static std::array<Vec3, 2> forces(const State& y) {
    const auto a = accelerations(y);
    // Acceleration of a point that is r from a pivot at an angle.
    const auto turned = [](Real angle, Real rate, Real acceleration, Real r) {
      const Real s = std::sin(angle), k = std::cos(angle);
      return Vec3(double(r * (acceleration * k - rate * rate * s)),
                  double(r * (acceleration * s + rate * rate * k)), 0);
    };
    const Vec3 first = turned(y[0], y[2], a[0], c);
    const Vec3 second = turned(y[0], y[2], a[0], l) + turned(y[1], y[3], a[1], c);
    const Vec3 up(0, double(gravity), 0);
    const Vec3 lower = double(m) * (second + up);
    return {double(m) * (first + up) + lower, lower};
  }
};

/// Greatest error of both forces at the ends of the ticks of a second, released horizontally.
double rods_error(const std::string& stepper, int hz) {
  const auto w = world_of(stepper, hz);
  const BodyId upper = *w->create_body(block({0.5, 0, 0}, {0.5, 0.05, 0.05}, 1));
  const BodyId lower = *w->create_body(block({1.5, 0, 0}, {0.5, 0.05, 0.05}, 1));
  REQUIRE(w->create_joint(joint(JointKind::spherical, {}, upper, {0, 0, 0}, {-0.5, 0, 0})).ok());
  REQUIRE(
      w->create_joint(joint(JointKind::revolute, upper, lower, {0.5, 0, 0}, {-0.5, 0, 0})).ok());
  REQUIRE(w->apply_commands().ok());
  Rods::State y{M_PIl / 2, M_PIl / 2, 0, 0};
  double worst = 0;
  for (int tick = 0; tick <= hz; ++tick) {
    const auto found = reactions(*w);
    const auto want = Rods::forces(y);
    for (size_t i = 0; i < 2; ++i) {
      worst = std::max(worst, (found[i].force - want[i]).norm());
      CHECK(found[i].torque.norm() < 1e-9);
    }
    run(*w, 1);
    for (int k = 0; k < 10; ++k) y = Rods::stepped(y, Rods::Real(1) / (10 * hz));
  }
  return worst;
}

}  // namespace

TEST_CASE("the tension of a pendulum at a moment, the first one too") {
  for (const char* stepper : {"event", "realtime"}) {
    INFO(stepper);
    Pendulum p(stepper, 200);
    for (int tick = 0; tick < 200; ++tick) {
      const auto found = reactions(*p.world);
      REQUIRE(found.size() == 1);
      CHECK((found[0].force - p.tension()).norm() < 1e-9);
      CHECK(found[0].torque.norm() < 1e-12);
      CHECK((found[0].x_world - p.world->body(p.id)->pose.x).norm() < 1e-14);
      if (std::string(stepper) == "event")
        CHECK(std::fabs(found[0].force.norm() - p.tension_of_energy()) < 1e-6);
      run(*p.world, 1);
    }
  }
  Pendulum first("event", 200);
  CHECK(reactions(*first.world)[0].force.norm() ==
        doctest::Approx(Pendulum::mass * g / 2).epsilon(1e-12));
  CHECK(first.world->frame()->joints->front().mean_force.isZero(0));
}

TEST_CASE("the mean over a tick is that of the moments in it") {
  // Simpson's rule over two ticks. Impulses are told along the thread as it is at the end of a
  // tick, so their size is compared.
  Pendulum p("event", 200);
  run(*p.world, 40);
  for (int i = 0; i < 20; ++i) {
    const auto force = [&] { return reactions(*p.world)[0].force.norm(); };
    const auto mean = [&] { return (*p.world->frame()->joints)[0].mean_force.norm(); };
    const double begin = force();
    run(*p.world, 1);
    const double middle = force(), first = mean();
    run(*p.world, 1);
    const double end = force(), second = mean();
    CHECK(std::fabs(0.5 * (first + second) - (begin + 4 * middle + end) / 6) < 1e-6);
    CHECK(std::fabs(second - end) > 1e-2);
  }
}

TEST_CASE("forces in a row of two rods are those of Lagrange's equations") {
  const double coarse = rods_error("event", 100), fine = rods_error("event", 200);
  const double realtime = rods_error("realtime", 200);
  MESSAGE("error at the end of ticks: event ", coarse, " N at 100 Hz, ", fine,
          " N at 200 Hz; realtime ", realtime, " N at 200 Hz");
  CHECK(fine < 1e-5);
  CHECK(fine < coarse / 12);
  CHECK(realtime < 1);
}

TEST_CASE("bearings of a rotor that is out of balance hold its torque") {
  for (const char* stepper : {"event", "realtime"}) {
    INFO(stepper);
    const auto w = world_of(stepper, 200);
    BodyDef rotor = block({0, 1, 0}, {0.5, 0.1, 0.2}, 3);
    rotor.pose.q = axis_angle(Vec3(1, 2, 0.5).normalized(), 0.4);
    rotor.angular_velocity = {0, 0, 12};
    const BodyId id = *w->create_body(rotor);
    JointDef bearing = joint(JointKind::revolute, {}, id, {0, 1, 0}, Vec3::Zero());
    bearing.frame_b.q = rotor.pose.q.conjugate();
    REQUIRE(w->create_joint(bearing).ok());
    REQUIRE(w->apply_commands().ok());
    for (int i = 0; i < 60; ++i) {
      const RigidBody& b = *w->body(id);
      const Vec3 want = b.omega.cross(b.inertia_world() * b.omega);
      const JointReaction found = reactions(*w)[0];
      CHECK(want.norm() > 9);
      CHECK((found.torque - want).norm() < 1e-4 * want.norm());
      CHECK((found.force - Vec3(0, 3 * g, 0)).norm() < 1e-6);
      run(*w, 1);
    }
    // A mean of what turns with the rotor is a little shorter: by sin(x) / x, x = half the turn.
    const Vec3 mean = w->frame()->joints->front().mean_torque;
    const double half = 0.5 * 12 / 200;
    if (std::string(stepper) == "event")
      CHECK(mean.norm() ==
            doctest::Approx(reactions(*w)[0].torque.norm() * std::sin(half) / half).epsilon(1e-4));
  }
}

TEST_CASE("joints that share a load in many ways take it alike") {
  for (const char* stepper : {"event", "realtime"}) {
    INFO(stepper);
    const auto w = world_of(stepper, 60);
    const BodyId beam = *w->create_body(block({0, 0, 0}, {1, 0.1, 0.1}, 4));
    for (const double x : {-1.0, 1.0})
      REQUIRE(w->create_joint(joint(JointKind::rigid, {}, beam, {x, 0, 0}, {x, 0, 0})).ok());
    const BodyId bob = *w->create_body(ball({0, -1, 0}));
    for (int i = 0; i < 3; ++i)
      REQUIRE(w->create_joint(joint(JointKind::spherical, beam, bob, {0, -1, 0}, {})).ok());
    for (int i = 0; i < 2; ++i) {
      run(*w, 30 * i);
      REQUIRE(w->apply_commands().ok());
      const auto found = reactions(*w);
      REQUIRE(found.size() == 5);
      for (size_t k = 0; k < 2; ++k) CHECK((found[k].force - Vec3(0, 3 * g, 0)).norm() < 1e-6);
      CHECK((found[0].torque + found[1].torque).norm() < 1e-6);
      for (size_t k = 2; k < 5; ++k) CHECK((found[k].force - Vec3(0, 2 * g / 3, 0)).norm() < 1e-6);
    }
  }
}

TEST_CASE("contacts carry their share of what joints would carry without them") {
  for (const char* stepper : {"event", "realtime"}) {
    INFO(stepper);
    const auto w = world_of(stepper, 60);
    BodyDef post = ball({0.5, -0.15, 0});
    post.type = BodyType::fixed;
    post.shapes[0].material.friction = 0;
    REQUIRE(w->create_body(post).ok());
    const BodyId plank = *w->create_body(block({0, 0, 0}, {1, 0.05, 0.1}, 4));
    REQUIRE(w->create_joint(joint(JointKind::revolute, {}, plank, {-1, 0, 0}, {-1, 0, 0})).ok());
    run(*w, 20);
    // About the hinge: 1.5 N = 1 m g.
    CHECK((reactions(*w)[0].force - Vec3(0, 4 * g / 3, 0)).norm() < 1e-2);
    run(*w, 100);  // and asleep under realtime
    CHECK((reactions(*w)[0].force - Vec3(0, 4 * g / 3, 0)).norm() < 1e-2);
  }
}

TEST_CASE("who asks for reactions changes nothing") {
  for (const char* stepper : {"event", "realtime"}) {
    INFO(stepper);
    std::array<std::unique_ptr<World>, 2> worlds{world_of(stepper, 60), world_of(stepper, 60)};
    for (const auto& w : worlds) {
      const BodyId bob = *w->create_body(ball({1, 0, 0}));
      REQUIRE(w->create_joint(joint(JointKind::spherical, {}, bob, {}, {-1, 0, 0})).ok());
      ParticleSystemDef dust;
      for (const double x : {1.5, 2.0}) dust.particles.push_back({.x = {x, 0, 0}, .mass = 0.1});
      const ParticleSystemId particles = *w->create_particles(dust);
      SpringDef spring;
      spring.a = {Anchor::Kind::body, bob, {}, 0, Vec3::Zero()};
      spring.b = {Anchor::Kind::particle, {}, particles, 1, Vec3::Zero()};
      spring.stiffness = 20;
      REQUIRE(w->create_force(spring).ok());
      REQUIRE(w->create_force(LinearDragDef{}).ok());
    }
    for (int i = 0; i < 40; ++i) {
      const auto found = reactions(*worlds[0]);
      CHECK(found.size() == (i > 0 ? 1 : 0));  // commands wait for the first tick
      for (const auto& w : worlds) run(*w, 1);
      REQUIRE(worlds[0]->state_hash() == worlds[1]->state_hash());
    }
  }
}
