// Joints under the event stepper. References: the energy of the double pendulum of the published
// comparison; reactions of the conical and of the physical pendulum; the centre of percussion, the
// double pendulum's impulse by Lagrange's equations, and the collision of one merged body. Of
// joints that do not fit: what they are off by less EventSettings::recovery_speed times the time.
#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"
#include "tests/support/scale.hpp"

#include <cmath>
#include <numeric>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81;

BodyDef slim_rod(const Vec3& centre) {
  BodyDef d = body(box(0.5, 0.05, 0.05), centre);
  d.mass = 1;
  return d;
}

/// Two rods of 1 m and 1 kg in a row, horizontal, hung at the origin and between them.
struct HungRods : EventWorld {
  HungRods(double hz, JointKind kind, const std::string& integrator = "rk4") : EventWorld(hz) {
    settings.integrator = integrator;
    const uint32_t first = add(slim_rod({0.5, 0, 0})), second = add(slim_rod({1.5, 0, 0}));
    join(kind, no_body, first, {});
    join(kind, first, second, {{1, 0, 0}, Quat::Identity()});
  }
};

/// Greatest error of the energy over a minute, relative to its range, 19.62 J.
double energy_error(double hz, const std::string& integrator = "rk4") {
  HungRods w(hz, JointKind::spherical, integrator);
  double worst = 0;
  const int ticks = int((test::only_to_run() ? 2 : 60) * hz + 0.5);
  for (int i = 0; i < ticks; ++i) {
    w.step();
    worst = std::max(worst, std::fabs(w.energy()) / 19.62);
    CHECK(w.joint_error() < 1e-12);
  }
  return worst;
}

/// Rods of 1 m and 1 kg that hang in a row, struck by a ball of 2 kg along x at a height.
struct StruckRods : EventWorld {
  explicit StruckRods(uint32_t rods) {
    for (uint32_t i = 0; i < rods; ++i) {
      BodyDef d = body(box(0.05, 0.5, 0.05), {0, -0.5 - i, 0});
      d.mass = 1;
      add(d);
      join(JointKind::spherical, i == 0 ? no_body : i - 1, i,
           {{0, -double(i), 0}, Quat::Identity()});
    }
  }
  static constexpr double ball_mass = 2, speed = 3, restitution = 0.6;
  /// By the law, with the ball as the last block.
  ImpactReport strike(ImpactLaw law, double y, uint32_t rod, std::vector<DofBlock>& blocks) const {
    std::vector<uint32_t> slots(bodies.size()), which(joints.size());
    std::iota(slots.begin(), slots.end(), 0u);
    std::iota(which.begin(), which.end(), 0u);
    Articulation held({joints}, {which}, slots, bodies, bodies.size() + 1);
    blocks = blocks_of(bodies, slots);
    DofBlock& ball = blocks.emplace_back();
    ball.inverse_mass = 1 / ball_mass;
    ball.inverse_inertia = Mat3::Identity();
    ball.v = {speed, 0, 0};
    held.update(bodies, blocks);
    ImpactPoint p;
    p.a = uint32_t(bodies.size());
    p.b = rod;
    p.arm_b = {-0.05, y - bodies[rod].pose.x.y(), 0};
    p.normal = Vec3::UnitX();
    p.restitution = restitution;
    return law(blocks, std::vector{p}, held);
  }
};

constexpr double rod_inertia = (1.0 + 0.01) / 12;  ///< of a rod about its centre

}  // namespace

TEST_CASE("what is kept of joints' equations from tick to tick changes no bit") {
  // Its reference makes everything anew in every tick. A chain whose joints turn into others on the
  // way: other kinds, other bodies, fewer of them, and a body that stands still.
  struct Chain : EventWorld {
    Chain() : EventWorld(240) {
      for (uint32_t i = 0; i < 6; ++i) {
        const uint32_t rod = add(slim_rod({0.5 + i, 0, 0}));
        join(JointKind::revolute, i == 0 ? no_body : rod - 1, rod,
             {{double(i), 0, 0}, i % 2 == 0 ? Quat::Identity() : axis_angle(Vec3::UnitX(), 1)});
      }
    }
    void change(int tick) {
      if (tick == 10) joints[2].kind = JointKind::spherical;
      if (tick == 20) joints.erase(joints.begin() + 3);
      if (tick == 30) std::swap(joints[3], joints[4]);
      if (tick == 40) bodies[5].type = BodyType::kinematic, bodies[5].inverse_mass = 0;
    }
  };
  Chain kept, anew;
  for (int tick = 0; tick < 50; ++tick) {
    kept.change(tick);
    anew.change(tick);
    anew.stepper = EventStepper{};
    kept.step();
    anew.step();
    for (size_t i = 0; i < kept.bodies.size(); ++i) {
      CAPTURE(tick);
      CAPTURE(i);
      CHECK(kept.bodies[i].pose.x == anew.bodies[i].pose.x);
      CHECK(kept.bodies[i].omega == anew.bodies[i].omega);
    }
  }
}

TEST_CASE("joints that do not fit close at the recovery speed, and nothing is faster for it") {
  const Vec3 v(0.5, 0.2, -0.1);
  for (const JointKind kind : {JointKind::distance, JointKind::spherical, JointKind::rigid}) {
    EventWorld w;
    w.gravity.setZero();
    for (int i = 0; i < 2; ++i) {
      BodyDef d = body(box(0.3, 0.2, 0.1), {2.0 * i, 0.1 * i, 0});
      d.mass = 1 + 2 * i;
      d.velocity = v;
      w.add(d);
    }
    Joint& joint = w.join(kind, 0, 1, {{1, 0, 0}, Quat::Identity()});
    if (kind == JointKind::distance) joint.length = 0.1;
    joint.frame_b.x += Vec3(0.06, -0.03, 0.02);
    JointRows off;
    joint_rows(kind, joint_sides(joint, w.bodies), off);
    double whole = 0;
    for (const JointRow& r : off.all()) whole += r.error * r.error;
    whole = std::sqrt(whole);
    REQUIRE(whole > 0.02);
    const Vec3 centre = 0.25 * w.bodies[0].pose.x + 0.75 * w.bodies[1].pose.x;
    const double energy = w.energy();
    for (int n = 1; n * w.h < 2; ++n) {
      w.step();
      CAPTURE(int(kind));
      CAPTURE(n);
      const double left = std::max(0.0, 1 - n * w.h * w.settings.recovery_speed / whole);
      JointRows now;
      joint_rows(kind, joint_sides(joint, w.bodies), now);
      for (size_t i = 0; i < now.size(); ++i)
        CHECK(std::fabs(now[i].error - left * off[i].error) < 1e-10);
      for (const RigidBody& b : w.bodies) CHECK((b.v - v).norm() + b.omega.norm() < 1e-12);
      const Vec3 now_centre = 0.25 * w.bodies[0].pose.x + 0.75 * w.bodies[1].pose.x;
      CHECK((now_centre - centre - n * w.h * v).norm() < 1e-12);
    }
    CHECK(w.joint_error() < 1e-10);
    CHECK(w.energy() == doctest::Approx(energy).epsilon(1e-12));
  }
}

TEST_CASE("a coupling that does not fit turns its joints at the recovery speed") {
  EventWorld w;
  w.gravity.setZero();
  for (uint32_t i = 0; i < 2; ++i) {
    w.add(slim_rod({0, 2.0 * i, 0}));
    w.join(JointKind::revolute, no_body, i, {{0, 2.0 * i, 0}, Quat::Identity()}).coupled = 1;
  }
  JointCoupling& gear = w.couplings.emplace_back();
  gear.a = 0, gear.b = 1, gear.ratio = -2, gear.offset = 0.04;
  const auto angle = [&](size_t i) { return 2 * std::asin(w.bodies[i].pose.q.z()); };
  for (int n = 1; n * w.h < 1; ++n) {
    w.step();
    CAPTURE(n);
    const double done = std::min(gear.offset, n * w.h * w.settings.recovery_speed);
    CHECK(std::fabs(angle(0) + 2 * angle(1) - done) < 1e-10);
    CHECK(w.bodies[0].omega.norm() + w.bodies[1].omega.norm() < 1e-12);
  }
}

TEST_CASE("a double pendulum under the event stepper keeps its energy for a minute" *
          doctest::test_suite("long")) {
  const double coarse = energy_error(240), fine = energy_error(480);
  const double adaptive = energy_error(240, "rk45");
  MESSAGE("energy error at 1/240, 1/480 and adaptive: " << coarse << " " << fine << " "
                                                        << adaptive);
  CHECK(coarse < 2e-5);
  CHECK(fine < 1e-6);
  CHECK(adaptive < 1e-6);
}

TEST_CASE("jointed bodies move with the fourth order under the event stepper") {
  const auto end = [](double hz) {
    HungRods w(hz, JointKind::revolute);
    w.run(2);
    return w.bodies[1].pose.x;
  };
  const Vec3 coarse = end(500), middle = end(1000), fine = end(2000);
  const double order = std::log2((coarse - middle).norm() / (middle - fine).norm());
  MESSAGE("order " << order);
  CHECK(order > 3.7);
  CHECK(order < 4.4);
}

TEST_CASE("a blow at the centre of percussion is not felt at the pivot") {
  const StruckRods w(1);
  const double about_pivot = rod_inertia + 0.25, percussion = about_pivot / 0.5;
  for (const ImpactLawEntry& law : all_impact_laws()) {
    INFO(law.name);
    for (const double depth : {percussion, 0.9}) {
      std::vector<DofBlock> blocks;
      const ImpactReport report = w.strike(law.resolve, -depth, 0, blocks);
      REQUIRE(report.status == ImpactStatus::solved);
      const double impulse =
          (1 + w.restitution) * w.speed / (1 / w.ball_mass + depth * depth / about_pivot);
      CHECK(report.impulses[0].x() == doctest::Approx(impulse).epsilon(1e-12));
      CHECK(blocks[0].omega.z() == doctest::Approx(impulse * depth / about_pivot).epsilon(1e-12));
      // The rod's momentum is that of both impulses.
      const double pivot = impulse * (0.5 * depth / about_pivot - 1);
      CHECK(report.joint_impulses[0] == doctest::Approx(pivot).epsilon(1e-12));
      if (depth == percussion) CHECK(std::fabs(report.joint_impulses[0]) < 1e-13);
      CHECK((blocks[0].v + blocks[0].omega.cross(Vec3(0, 0.5, 0))).norm() < 1e-14);
    }
  }
}

TEST_CASE("a blow on one rod of a double pendulum moves the other at once") {
  const StruckRods w(2);
  // Impulses of the angles: (I + c2 + l2) w1 + l c w2 = J l and l c w1 + (I + c2) w2 = J d.
  const double l = 1, c = 0.5, d = 0.8, m11 = rod_inertia + c * c + l * l, m12 = l * c,
               m22 = rod_inertia + c * c, det = m11 * m22 - m12 * m12;
  const double w1 = (m22 * l - m12 * d) / det, w2 = (m11 * d - m12 * l) / det;  // of J = 1
  const double impulse = (1 + w.restitution) * w.speed / (1 / w.ball_mass + l * w1 + d * w2);
  for (const ImpactLawEntry& law : all_impact_laws()) {
    INFO(law.name);
    std::vector<DofBlock> blocks;
    const ImpactReport report = w.strike(law.resolve, -1 - d, 1, blocks);
    REQUIRE(report.status == ImpactStatus::solved);
    CHECK(blocks[0].omega.z() == doctest::Approx(impulse * w1).epsilon(1e-12));
    CHECK(blocks[1].omega.z() == doctest::Approx(impulse * w2).epsilon(1e-12));
    CHECK(report.work == doctest::Approx(-0.5 * (1 - w.restitution * w.restitution) * w.speed *
                                         impulse / (1 + w.restitution)));
  }
}

TEST_CASE("bodies that are joined rigidly fall, bounce and slide like one body") {
  const auto floor = [](EventWorld& w) {
    BodyDef d = body(half_space(), Vec3::Zero(), 0.4, 0.5);
    d.type = BodyType::fixed;
    w.add(d);
  };
  const Pose at{{0, 0.9, 0}, Quat(0.9, 0.2, 0.1, 0.37).normalized()};
  const Vec3 turn(0.5, 2, -1), v(1, -0.5, 0.3);
  EventWorld one, two;
  floor(one);
  floor(two);
  BodyDef whole = body(box(0.2, 0.1, 0.15), Vec3::Zero(), 0.4, 0.5);
  whole.pose = at;
  whole.shapes.push_back(whole.shapes[0]);
  whole.shapes[0].pose.x.x() = -0.2;
  whole.shapes[1].pose.x.x() = 0.2;
  whole.velocity = v;
  whole.angular_velocity = turn;
  one.add(whole);
  for (const double x : {-0.2, 0.2}) {
    BodyDef half = body(box(0.2, 0.1, 0.15), Vec3::Zero(), 0.4, 0.5);
    half.pose = at * Pose{{x, 0, 0}, Quat::Identity()};
    half.velocity = v + turn.cross(half.pose.x - at.x);
    half.angular_velocity = turn;
    two.add(half);
  }
  two.join(JointKind::rigid, 1, 2, at);
  uint64_t impacts = 0;
  for (int i = 0; i < 45; ++i) {
    one.step();
    two.step();
    impacts += two.stepper.stats.impacts;
    const Vec3 middle = 0.5 * (two.bodies[1].pose.x + two.bodies[2].pose.x);
    CHECK((middle - one.bodies[1].pose.x).norm() < 1e-6);
    CHECK(two.joint_error() < 1e-12);
  }
  CHECK(impacts > 1);
  CHECK(two.deepest < 1e-5);
}

TEST_CASE("a door bounces off its stop as its hinge lets it") {
  EventWorld w;
  BodyDef door = body(box(0.5, 1, 0.03), {0.5, 1, 0}, 0, 0.6);
  door.angular_velocity = {0, -2, 0};
  door.velocity = door.angular_velocity.cross(door.pose.x);
  w.add(door);
  BodyDef post = body(sphere(0.1), {0.8, 1, 0.5}, 0, 0.6);
  post.type = BodyType::fixed;
  w.add(post);
  const Mat3 up(0, 1, 0, 0, 0, 1, 1, 0, 0);
  w.join(JointKind::revolute, no_body, 0, {Vec3::Zero(), Quat(up)});
  w.run(1);
  CHECK(w.bodies[0].omega.y() == doctest::Approx(1.2).epsilon(1e-9));
  CHECK(std::fabs(w.bodies[0].omega.x()) + std::fabs(w.bodies[0].omega.z()) < 1e-12);
  CHECK(w.joint_error() < 1e-12);
}

TEST_CASE("the string of a conical pendulum pulls with m g / cos") {
  const double length = 2, angle = 0.6;
  EventWorld w(240);
  BodyDef d = body(sphere(0.1), {length * std::sin(angle), -length * std::cos(angle), 0});
  d.velocity = {0, 0, -std::sqrt(g * length * std::sin(angle) * std::tan(angle))};
  const uint32_t b = w.add(d);
  Joint& j = w.join(JointKind::distance, no_body, b, {d.pose.x, Quat::Identity()});
  j.frame_a.x.setZero();
  j.length = length;
  for (int i = 0; i < 480; ++i) {
    w.step();
    CHECK(-w.joints[0].moving_force[0] ==
          doctest::Approx(w.bodies[b].mass * g / std::cos(angle)).epsilon(1e-8));
  }
  CHECK(w.bodies[b].pose.x.y() == doctest::Approx(-length * std::cos(angle)).epsilon(1e-8));
}

TEST_CASE("a chain falls on a floor and stays a chain") {
  EventWorld w(240);
  BodyDef floor = body(half_space(), Vec3::Zero(), 0.5);
  floor.type = BodyType::fixed;
  w.add(floor);
  for (uint32_t i = 0; i < 4; ++i) {
    BodyDef link = body(capsule(0.04, 0.12), {0.02 * i, 0.2 + 0.16 * i, 0.01 * i * i}, 0.5);
    link.pose.q = Quat(1, 0.1, 0, 0.05).normalized();
    w.add(link);
    if (i > 0)
      w.join(JointKind::spherical, i, i + 1,
             {0.5 * (w.bodies[i].pose.x + w.bodies[i + 1].pose.x), Quat::Identity()});
  }
  const double start = w.energy();
  double energy = start, gap = 0;
  for (int i = 0; i < 120; ++i) {
    w.step();
    CHECK(w.energy() < energy + 1e-4);
    energy = w.energy();
    gap = std::max(gap, w.joint_error());
  }
  CHECK(gap < 1e-12);
  CHECK(w.deepest < 1e-5);
  CHECK(energy < 0.6 * start);
}

namespace {

/// Rods of random masses and velocities around a polygon in a plane, on hinges across it; one side
/// may be the world.
struct HingedLoop : EventWorld {
  HingedLoop(double hz, Random& r, const std::vector<Vec3>& corners, bool world, double speed)
      : EventWorld(hz) {
    const auto count = uint32_t(corners.size()), rods = count - (world ? 1 : 0);
    for (uint32_t i = 0; i < rods; ++i) {
      const Vec3 a = corners[i], b = corners[(i + 1) % count];
      BodyDef d = body(box(0.5 * (b - a).norm(), 0.03, 0.03), 0.5 * (a + b));
      d.pose.q = rotation_between(Vec3::UnitX(), (b - a).normalized());
      d.mass = r.uniform(0.3, 3);
      add(d);
    }
    for (uint32_t i = 0; i < rods; ++i)
      hinge(i > 0 ? i - 1 : world ? no_body : rods - 1, i, corners[i]);
    if (world) hinge(no_body, rods - 1, corners.back());
    for (RigidBody& b : bodies)
      for (Vec3* u : {&b.v, &b.omega})
        for (const int k : {2, 1, 0}) (*u)[k] = r.uniform(-speed, speed);
    start();
  }
  void hinge(uint32_t a, uint32_t b, const Vec3& at) {
    join(JointKind::revolute, a, b, {at, Quat::Identity()});
  }
  /// Rods pass through each other, with velocities that the joints leave.
  void start() {
    for (RigidBody& b : bodies) b.shapes.clear();
    std::vector<uint32_t> slots(bodies.size()), which(joints.size());
    std::iota(slots.begin(), slots.end(), 0u);
    std::iota(which.begin(), which.end(), 0u);
    Articulation held({joints}, {which}, slots, bodies, bodies.size());
    std::vector<DofBlock> blocks = blocks_of(bodies, slots);
    held.update(bodies, blocks);
    std::vector<double> impulses(held.size());
    held.hold_velocities(blocks, impulses);
    for (size_t i = 0; i < blocks.size(); ++i)
      bodies[i].v = blocks[i].v, bodies[i].omega = blocks[i].omega;
  }
  /// Greatest error of the energy while it moves, as a share of the greatest kinetic energy.
  double energy_error(double seconds) {
    const double first = energy();
    double worst = 0, kinetic = 0;
    for (int k = 0; k < int(seconds / h + 0.5); ++k) {
      step();
      double now = 0;
      for (const RigidBody& b : bodies) now += b.kinetic_energy();
      kinetic = std::max(kinetic, now);
      worst = std::max(worst, std::fabs(energy() - first));
    }
    CHECK(joint_error() < 1e-12);
    return worst / kinetic;
  }
};

HingedLoop four_bars(double hz, int seed) {
  Random r{uint64_t(seed)};
  const double speed = r.uniform(0, 6);
  std::vector<Vec3> corners;
  for (int i = 0; i < 4; ++i) {
    const double y = r.uniform(-1, 1);
    corners.emplace_back(r.uniform(-1, 1), y, 0);
  }
  return {hz, r, corners, true, speed};
}

HingedLoop ring(double hz, int seed) {
  Random r{uint64_t(seed)};
  const double speed = r.uniform(0, 6);
  const int count = 5 + int(r.uniform(0, 4));
  std::vector<Vec3> corners;
  for (int i = 0; i < count; ++i) {
    const double a = 6.2832 * i / count;
    corners.push_back(Vec3(std::cos(a), std::sin(a), 0) * r.uniform(0.4, 1));
  }
  return {hz, r, corners, r.uniform() < 0.5, speed};
}

}  // namespace

TEST_CASE("closed loops keep their energy through dead points and where rows depend on others" *
          doctest::test_suite("long")) {
  // Whole energies were gained: by steps too long for rods that whirl through a dead point, and by
  // forces along rows that are none but for rounding.
  CHECK(four_bars(120, 2013).energy_error(4) < 5e-3);
  CHECK(four_bars(120, 2003).energy_error(4) < 2e-4);
  CHECK(ring(120, 6004).energy_error(3) < 1e-4);
  CHECK(ring(120, 6011).energy_error(3) < 1e-9);
}

TEST_CASE("the energy of closed loops converges with the fourth order at least") {
  for (const int seed : {2000, 2001}) {
    const double coarse = four_bars(240, seed).energy_error(1),
                 fine = four_bars(480, seed).energy_error(1);
    CAPTURE(coarse);
    CAPTURE(fine);
    CHECK(coarse > 12 * fine);
  }
}

namespace {

/// Rods of several thicknesses around a polygon that nothing holds, on hinges across it and ball
/// joints, without gravity or with it.
struct LooseRing : HingedLoop {
  LooseRing(double hz, Random& r, int count, bool falls) : HingedLoop(hz, r, {}, false, 0) {
    const double balls = r.uniform(), speed = r.uniform(2, 8);
    if (!falls) gravity.setZero();
    std::vector<Vec3> corners;
    for (int i = 0; i < count; ++i) {
      const double a = 6.2832 * i / count;
      corners.push_back(Vec3(std::cos(a), std::sin(a), 0) * r.uniform(0.4, 1.2));
    }
    for (int i = 0; i < count; ++i) {
      const Vec3 a = corners[size_t(i)], b = corners[size_t((i + 1) % count)];
      const double thick = r.uniform(0.02, 0.1), wide = r.uniform(0.02, 0.1);
      BodyDef d = body(box(0.5 * (b - a).norm(), thick, wide), 0.5 * (a + b));
      d.pose.q = rotation_between(Vec3::UnitX(), (b - a).normalized());
      d.mass = r.uniform(0.3, 3);
      add(d);
    }
    for (int i = 0; i < count; ++i)
      join(r.uniform() < balls ? JointKind::spherical : JointKind::revolute,
           uint32_t((i + count - 1) % count), uint32_t(i), {corners[size_t(i)], Quat::Identity()});
    for (RigidBody& b : bodies)
      for (Vec3* u : {&b.v, &b.omega})
        for (const int k : {2, 1, 0}) (*u)[k] = r.uniform(-speed, speed);
    start();
  }
};

}  // namespace

TEST_CASE("joints do no work: steps that change energy without any are shortened") {
  // Up to a sixth of it went in steps whose joints stayed together to 1e-6. Reference: conservation
  // of energy.
  for (int seed = 0; seed < test::scaled_count(40, 2); ++seed) {
    Random r{uint64_t(4000 + seed)};
    LooseRing ring(seed % 2 ? 120 : 240, r, 4 + seed % 4, seed % 3 == 0);
    CAPTURE(seed);
    CHECK(ring.energy_error(1) < 2e-5);
  }
}
