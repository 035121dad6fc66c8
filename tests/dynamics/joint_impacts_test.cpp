// Impacts of mechanisms under the realtime solver: on limits of joints, and of bodies against
// links. References: Newton's law of impact with the mass matrices of one and of two rods, which
// are straight at that moment, in closed form. Without gravity energy is kept before and after.
#include "tests/dynamics/joint_world.hpp"

#include <cmath>
#include <memory>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double inertia = (1.0 + 0.01) / 12;  // of a rod about its centre
constexpr double c = 0.5, l = 1;               // from the hinge to the centre, and to the next one

/// Rods of 1 m, 1 kg and 0.1 m by 0.1 m in a row along x on hinges along z, the first of them at
/// the origin. Rates are those of the rods, not of the hinges.
struct RodRow : JointWorld {
  int count;

  RodRow(int rods, double hz, double rate, double restitution = 0) : JointWorld(hz), count(rods) {
    gravity.setZero();
    for (int i = 0; i < rods; ++i) {
      BodyDef d = body(box(0.5, 0.05, 0.05), {c + l * i, 0, 0}, 0, restitution);
      d.mass = 1;
      d.angular_velocity = {0, 0, rate};
      d.velocity = {0, (c + l * i) * rate, 0};
      const uint32_t slot = add(d);
      join(JointKind::revolute, i == 0 ? no_body : slot - 1, slot,
           {{l * i, 0, 0}, Quat::Identity()});
    }
  }
  double rate(int rod) const { return bodies[size_t(rod)].omega.z(); }
};

/// What an impulse of one unit at the distance `x` from the hinge of the last rod, across it, and a
/// unit of angular impulse on the first rod change the rates of one or two rods by.
struct Response {
  double first = 0, last = 0;
};
Response solve(int rods, double moment_first, double moment_last) {
  const double m22 = inertia + c * c;
  if (rods == 1) return {(moment_first + moment_last) / m22, (moment_first + moment_last) / m22};
  const double m11 = m22 + l * l, m12 = l * c, det = m11 * m22 - m12 * m12;
  return {(m22 * moment_first - m12 * moment_last) / det,
          (m11 * moment_last - m12 * moment_first) / det};
}
double kinetic(int rods, double first, double last) {
  const double m22 = inertia + c * c;
  if (rods == 1) return 0.5 * m22 * first * first;
  return 0.5 * ((m22 + l * l) * first * first + 2 * l * c * first * last + m22 * last * last);
}

}  // namespace

TEST_CASE(
    "a limit gives back its restitution to a chain at any tick, whatever hangs on the joint") {
  constexpr double w = 2;
  for (const int rods : {1, 2})
    for (const double hz : {60.0, 90.0, 200.0, 240.0, 480.0, 960.0})
      for (const double e : {0.5, 1.0}) {
        CAPTURE(rods);
        CAPTURE(hz);
        CAPTURE(e);
        RodRow row(rods, hz, w);
        JointDrives drives;
        drives[0].limits.upper = 0.17;
        drives[0].limits.restitution = e;
        row.joints[0].drives = std::make_shared<JointDrives>(drives);
        const double kept = kinetic(rods, w, w);
        CHECK(row.kinetic_energy() == doctest::Approx(kept).epsilon(1e-9));
        int ticks = 0;
        while (row.rate(0) > 0 && ++ticks < hz) row.step();
        const double unit = solve(rods, 1, 0).first, by = -(1 + e) * w / unit;
        const Response after = solve(rods, by, 0);
        // The rods bend at once: within the tick the rates change by the square of the rates.
        CHECK(std::fabs(row.rate(0) + e * w) < 0.01 + (rods == 1 ? 0 : 8) / hz);
        CHECK(row.kinetic_energy() ==
              doctest::Approx(kinetic(rods, w + after.first, w + after.last)).epsilon(5e-3));
      }
}

TEST_CASE("a ball that hits a link bounces off the whole mechanism") {
  for (const int rods : {1, 2})
    for (const double hz : {60.0, 240.0, 960.0})
      for (const double e : {0.5, 1.0}) {
        CAPTURE(rods);
        CAPTURE(hz);
        CAPTURE(e);
        constexpr double speed = 5;
        RodRow row(rods, hz, 0, e);
        BodyDef d = body(sphere(0.1), {l * (rods - 1) + c, 0.5, 0}, 0, e);
        d.mass = 1;
        d.velocity = {0, -speed, 0};
        const uint32_t ball = row.add(d);
        int ticks = 0;
        while (std::fabs(row.bodies[ball].v.y() + speed) < 1e-9 && ++ticks < hz) row.step();
        // The ball pushes the middle of the last rod, and with it the hinge of that.
        const double at_first = rods == 1 ? c : l, at_last = rods == 1 ? 0 : c;
        const Response unit = solve(rods, at_first, at_last);
        const double yields = 1 + at_first * unit.first + at_last * unit.last;
        const double impulse = (1 + e) * speed / yields;
        CHECK(row.bodies[ball].v.y() == doctest::Approx(impulse - speed).epsilon(0.01));
        CHECK(row.rate(0) == doctest::Approx(-impulse * unit.first).epsilon(0.02));
        const double lost = 0.5 * (1 - e * e) * speed * speed / yields;
        CHECK(row.kinetic_energy() == doctest::Approx(0.5 * speed * speed - lost).epsilon(5e-3));
      }
}

TEST_CASE("a chain of links in a room gains no energy where everything bounces" *
          doctest::test_suite("long")) {
  // Before a blow was bounded by what its contacts took, single ticks gained up to a quarter, and a
  // chain half of its energy in 5 s.
  for (const bool ordinary : {false, true})
    for (const double hz : {60.0, 240.0})
      for (const double e : {0.5, 1.0})
        for (const double rate : {3.0, 10.0, 25.0})
          for (const int seed : {1, 2, 3}) {
            CAPTURE(ordinary);
            CAPTURE(hz);
            CAPTURE(e);
            CAPTURE(rate);
            CAPTURE(seed);
            JointWorld w(hz);
            w.gravity.setZero();
            if (ordinary) w.settings.max_substeps = w.settings.substeps;  // as in large islands
            for (int side = 0; side < 6; ++side) {
              Vec3 half(3, 3, 3), at = Vec3::Zero();
              half[side / 2] = 0.5;
              at[side / 2] = side % 2 == 0 ? -2.7 : 2.7;
              BodyDef wall = body(box(half.x(), half.y(), half.z()), at, 0, e);
              wall.type = BodyType::fixed;
              w.add(wall);
            }
            const auto direction = [&](double a, double b, double c, int i) {
              return Vec3(std::sin(a * i + seed), std::cos(b * i + seed), std::sin(i + c * seed))
                  .normalized();
            };
            uint32_t last = no_body;
            for (int i = 0; i < 4; ++i) {
              BodyDef d = body(box(0.5, 0.2, 0.1), {i - 1.5, 0, 0}, 0, e);
              d.mass = 1;
              d.angular_velocity = rate * direction(3.1, 2.3, 1.7, i);
              d.velocity = 3 * direction(1.1, 0.3, 0.7, i);
              const uint32_t slot = w.add(d);
              if (i > 0)
                w.join(JointKind::spherical, last, slot, {Vec3(i - 2.0, 0, 0), Quat::Identity()});
              last = slot;
            }
            // The first ticks bring velocities onto the joints.
            for (int tick = 0; tick < 3; ++tick) w.step();
            const double start = w.kinetic_energy();
            double before = start, most = start, gain = 0;
            for (int tick = 0; tick < 5 * hz; ++tick) {
              w.step();
              const double now = w.kinetic_energy();
              gain = std::max(gain, now / before - 1);
              most = std::max(most, now);
              before = now;
            }
            // Sub-steps and sweeps of ordinary islands are fewer.
            CHECK(gain < (ordinary ? 0.1 : 0.03));
            CHECK(most < start * (ordinary ? 1.12 : 1.01));
          }
}

TEST_CASE("a ball bounces off a link whose hinge an armature burdens or a motor holds") {
  for (const double hz : {60.0, 240.0})
    for (const double e : {0.5, 1.0})
      for (const double armature : {0.0, 0.5, 5.0})
        for (const bool held : {false, true}) {
          CAPTURE(hz);
          CAPTURE(e);
          CAPTURE(armature);
          CAPTURE(held);
          constexpr double speed = 5;
          RodRow row(1, hz, 0, e);
          JointDrives drives;
          drives[0].armature = armature;
          if (held) drives[0].motor.kind = MotorKind::velocity;
          row.joints[0].drives = std::make_shared<JointDrives>(drives);
          BodyDef d = body(sphere(0.1), {c, 0.5, 0}, 0, e);
          d.mass = 1;
          d.velocity = {0, -speed, 0};
          const uint32_t ball = row.add(d);
          int ticks = 0;
          while (std::fabs(row.bodies[ball].v.y() + speed) < 1e-9 && ++ticks < hz) row.step();
          const double turns = held ? 0 : c / (inertia + c * c + armature);
          const double impulse = (1 + e) * speed / (1 + c * turns);
          CHECK(std::fabs(row.bodies[ball].v.y() - (impulse - speed)) < 0.01 * speed);
          CHECK(std::fabs(row.rate(0) + impulse * turns) < 0.01 * speed);
        }
}

TEST_CASE("the work of a limit is what its impact took from the arm, wherever the hinge is") {
  constexpr double rate = 3, arm = 1, about_centre = 0.1, about_hinge = about_centre + arm * arm;
  for (const bool ordinary : {false, true})
    for (const double hz : {60.0, 240.0})
      for (const double e : {0.0, 0.5, 1.0}) {
        CAPTURE(ordinary);
        CAPTURE(hz);
        CAPTURE(e);
        JointWorld w(hz);
        w.gravity.setZero();
        if (ordinary) w.settings.max_substeps = w.settings.substeps;  // as in large islands
        BodyDef d;
        d.mass = 1;
        d.inertia = Vec3::Constant(about_centre);
        d.pose.x = {0, -arm, 0};
        d.velocity = {rate * arm, 0, 0};
        d.angular_velocity = {0, 0, rate};
        const uint32_t slot = w.add(d);
        w.join(JointKind::revolute, no_body, slot, {Vec3::Zero(), Quat::Identity()});
        JointDrives drives;
        drives[0].limits.upper = std::numbers::pi / 6;
        drives[0].limits.restitution = e;
        w.joints[0].drives = std::make_shared<JointDrives>(drives);
        double work = 0;
        for (int tick = 0; tick < 0.25 * hz; ++tick) {
          w.step();
          work += w.solver.joint_pushes()[0].limits;
        }
        const double energy = 0.5 * about_hinge * rate * rate;
        CHECK(std::fabs(work + (1 - e * e) * energy) < 0.01 * energy);
        CHECK(std::fabs(w.kinetic_energy() - e * e * energy) < 0.01 * energy);
      }
}

TEST_CASE("an armature takes its share of a plastic hit, in whichever sub-step that is") {
  constexpr double speed = 3, ball_mass = 0.5;
  for (const bool ordinary : {false, true})
    for (const double hz : {60.0, 240.0})
      for (const double gap : {0.4, 0.41, 0.425})  // the first is 8 ticks of 1/60 s exactly
        for (const double armature : {0.0, 0.5, 3.0}) {
          CAPTURE(ordinary);
          CAPTURE(hz);
          CAPTURE(gap);
          CAPTURE(armature);
          JointWorld w(hz);
          w.gravity.setZero();
          if (ordinary) w.settings.max_substeps = w.settings.substeps;  // as in large islands
          BodyDef d = body(box(0.5, 0.05, 0.05), Vec3::Zero(), 0);
          d.mass = 1;
          const uint32_t slider = w.add(d);
          w.join(JointKind::prismatic, no_body, slider,
                 frame_along(Vec3::Zero(), {0, 1, 0}, {1, 0, 0}));
          JointDrives drives;
          drives[0].armature = armature;
          w.joints[0].drives = std::make_shared<JointDrives>(drives);
          d = body(sphere(0.05), {0, 0.1 + gap, 0}, 0);
          d.mass = ball_mass;
          d.velocity = {0, -speed, 0};
          const uint32_t ball = w.add(d);
          for (int tick = 0; tick < 0.25 * hz; ++tick) {
            w.step();
            const double of_ball = w.bodies[ball].v.y(), of_slider = w.bodies[slider].v.y();
            CHECK(ball_mass * of_ball + (1 + armature) * of_slider ==
                  doctest::Approx(-ball_mass * speed).epsilon(1e-5));
            CHECK(w.kinetic_energy() + 0.5 * armature * of_slider * of_slider <
                  0.5 * ball_mass * speed * speed * (1 + 1e-5));
          }
          const double after = -ball_mass * speed / (ball_mass + 1 + armature);
          CHECK(std::fabs(w.bodies[slider].v.y() - after) < 0.01 * speed);
          // In ordinary islands the next sub-step starts from the impulse of the hit, and does not
          // take all of it back.
          CHECK(std::fabs(w.bodies[ball].v.y() - after) < (ordinary ? 0.035 : 0.01) * speed);
        }
}

TEST_CASE("a ball bounces off a rod with the inertia of the wheel to which it is geared") {
  constexpr double speed = 3, ball_mass = 0.5, ratio = 2, x = 0.9;
  for (const double hz : {60.0, 240.0})
    for (const double e : {0.5, 1.0})
      for (const double wheel_inertia : {0.01, 0.2}) {
        CAPTURE(hz);
        CAPTURE(e);
        CAPTURE(wheel_inertia);
        RodRow row(1, hz, 0, e);
        BodyDef d;
        d.mass = 1;
        d.inertia = Vec3::Constant(wheel_inertia);
        d.pose.x = {0, 0, 5};
        const uint32_t wheel = row.add(d);
        row.join(JointKind::revolute, no_body, wheel, {d.pose.x, Quat::Identity()});
        row.couplings.push_back({1, 0, 0, 0, ratio, 0});
        row.links.push_back({wheel, 0});
        for (Joint& joint : row.joints) joint.coupled = 1;
        d = body(sphere(0.05), {x, 0.5, 0}, 0, e);
        d.mass = ball_mass;
        d.velocity = {0, -speed, 0};
        const uint32_t ball = row.add(d);
        for (int tick = 0; tick < 0.2 * hz; ++tick) row.step();
        const double turns = x / (inertia + c * c + ratio * ratio * wheel_inertia);
        const double impulse = (1 + e) * speed / (1 / ball_mass + x * turns);
        CHECK(std::fabs(row.bodies[ball].v.y() - (impulse / ball_mass - speed)) < 0.01 * speed);
        CHECK(row.rate(0) == doctest::Approx(-impulse * turns).epsilon(0.01));
        CHECK(row.bodies[wheel].omega.z() ==
              doctest::Approx(-ratio * impulse * turns).epsilon(0.01));
      }
}

TEST_CASE("a ball without restitution moves on with the link that it hits, whatever burdens that") {
  // The burden is a wheel that a gear ties to the rod, an armature, or a second rod.
  constexpr double speed = 3, ball_mass = 0.5, ratio = 2, x = 0.9;
  enum class Burden { wheel, armature, rod };
  for (const Burden burden : {Burden::wheel, Burden::armature, Burden::rod})
    for (const double hz : {60.0, 240.0})
      for (const double height : {0.5, 0.511, 0.527})
        for (const double inertia_behind : {0.0, 0.04, 0.8, 5.0}) {
          CAPTURE(int(burden));
          CAPTURE(hz);
          CAPTURE(height);
          CAPTURE(inertia_behind);
          const int rods = burden == Burden::rod ? 2 : 1;
          if (rods == 2 && inertia_behind > 0) continue;
          RodRow row(rods, hz, 0);
          if (burden == Burden::wheel && inertia_behind > 0) {
            BodyDef d;
            d.mass = 1;
            d.inertia = Vec3::Constant(inertia_behind / (ratio * ratio));
            d.pose.x = {0, 0, 5};
            const uint32_t wheel = row.add(d);
            row.join(JointKind::revolute, no_body, wheel, {d.pose.x, Quat::Identity()});
            row.couplings.push_back({1, 0, 0, 0, ratio, 0});
            row.links.push_back({wheel, 0});
            for (Joint& joint : row.joints) joint.coupled = 1;
          }
          if (burden == Burden::armature) {
            JointDrives drives;
            drives[0].armature = inertia_behind;
            row.joints[0].drives = std::make_shared<JointDrives>(drives);
          }
          BodyDef d = body(sphere(0.05), {l * (rods - 1) + x, height, 0}, 0);
          d.mass = ball_mass;
          d.velocity = {0, -speed, 0};
          const uint32_t ball = row.add(d);
          int ticks = 0;
          while (std::fabs(row.bodies[ball].v.y() + speed) < 1e-9 && ++ticks < hz) row.step();
          for (int tick = 0; tick < 0.02 * hz; ++tick) row.step();
          const double alone = x / (inertia + c * c + inertia_behind);
          const Response unit = rods == 1 ? Response{alone, alone} : solve(2, l, x);
          const double yields = rods == 1 ? x * alone : l * unit.first + x * unit.last;
          const double impulse = speed / (1 / ball_mass + yields);
          CHECK(std::fabs(row.bodies[ball].v.y() - (impulse / ball_mass - speed)) < 0.01 * speed);
          CHECK(std::fabs(row.rate(0) + impulse * unit.first) < 0.01 * speed);
        }
}

TEST_CASE(
    "a ball without restitution stops at a link that a limit, a strong motor or a brake holds") {
  // Closed form: nothing moves after the hit. Where a burden is added, it does not either.
  constexpr double speed = 3;
  enum class Held { limit, burdened_limit, motor, brake };
  for (const Held held : {Held::limit, Held::burdened_limit, Held::motor, Held::brake})
    for (const double hz : {60.0, 240.0})
      for (const double ball_mass : {0.5, 10.0}) {
        CAPTURE(int(held));
        CAPTURE(hz);
        CAPTURE(ball_mass);
        RodRow row(1, hz, 0);
        JointDrives drives;
        if (held == Held::motor) {
          drives[0].motor.kind = MotorKind::velocity;
          drives[0].motor.max_force = 1e6;
        } else if (held == Held::brake) {
          drives[0].friction = 1e6;
        } else {
          drives[0].limits.lower = 0;
        }
        if (held == Held::burdened_limit) drives[0].armature = 2;
        row.joints[0].drives = std::make_shared<JointDrives>(drives);
        BodyDef d = body(sphere(0.05), {0.9, 0.5, 0}, 0);
        d.mass = ball_mass;
        d.velocity = {0, -speed, 0};
        const uint32_t ball = row.add(d);
        for (int tick = 0; tick < 0.2 * hz; ++tick) row.step();
        CHECK(std::fabs(row.bodies[ball].v.y()) < 0.01 * speed);
        CHECK(std::fabs(row.rate(0)) < 0.01);
        CHECK(std::fabs(row.joints[0].value[0]) < 1e-3);
      }
}

TEST_CASE("a ball that hits a flap askew is turned by the impulse of all that hangs on the flap") {
  // A ball that slides throughout loses mu J / m of its speed along the hinge, with J the impulse
  // of the plastic hit, and takes up the spin of 5/2 of that over its radius.
  constexpr double speed = 3, along = 3, mu = 0.2, ball_mass = 0.5, radius = 0.05, x = 0.6;
  for (const double hz : {60.0, 240.0})
    for (const double armature : {0.0, 0.8, 5.0}) {
      CAPTURE(hz);
      CAPTURE(armature);
      JointWorld w(hz);
      w.gravity.setZero();
      BodyDef d = body(box(0.5, 0.05, 0.5), {c, 0, 0}, mu);
      d.mass = 1;
      const uint32_t flap = w.add(d);
      Joint& hinge = w.join(JointKind::revolute, no_body, flap, Pose{});
      JointDrives drives;
      drives[0].armature = armature;
      hinge.drives = std::make_shared<JointDrives>(drives);
      d = body(sphere(radius), {x, 0.4, -0.3}, mu);
      d.mass = ball_mass;
      d.velocity = {0, -speed, along};
      const uint32_t ball = w.add(d);
      for (int tick = 0; w.bodies[ball].omega.isZero(0) && tick < hz; ++tick) w.step();
      const double impulse = speed / (1 / ball_mass + x * x / (inertia + c * c + armature));
      const double slowed = along - w.bodies[ball].v.z();
      CHECK(w.bodies[ball].v.y() == doctest::Approx(impulse / ball_mass - speed).epsilon(0.02));
      CHECK(slowed == doctest::Approx(mu * impulse / ball_mass).epsilon(0.03));
      CHECK(w.bodies[ball].omega.x() == doctest::Approx(2.5 * slowed / radius).epsilon(0.03));
    }
}

TEST_CASE("a slider with an armature bounces off a wall with all of its speed") {
  for (const double armature : {0.5, 2.0, 5.0}) {
    CAPTURE(armature);
    JointWorld w;
    w.gravity.setZero();
    BodyDef wall = body(box(0.05, 1.5, 1.5), {1, 0, 0}, 0, 1);
    wall.type = BodyType::fixed;
    w.add(wall);
    BodyDef d = body(sphere(0.1), Vec3::Zero(), 0, 1);
    d.mass = 1;
    d.velocity = {3, 0, 0};
    const uint32_t slider = w.add(d);
    w.join(JointKind::prismatic, no_body, slider, frame_along(Vec3::Zero(), {1, 0, 0}, {0, 1, 0}));
    JointDrives drives;
    drives[0].armature = armature;
    w.joints[0].drives = std::make_shared<JointDrives>(drives);
    w.run(0.5);
    CHECK(w.bodies[slider].v.x() == doctest::Approx(-3).epsilon(0.01));
  }
}

TEST_CASE(
    "what two motors press between them is no hit: it neither slides down nor loses its force") {
  constexpr double radius = 0.05, push = 20;
  for (const double hz : {60.0, 240.0})
    for (const double room : {0.0, 1e-3}) {
      CAPTURE(hz);
      CAPTURE(room);
      JointWorld w(hz);
      BodyDef d = body(sphere(radius), {0, 0, 0}, 0.8);
      d.mass = 1;
      const uint32_t ball = w.add(d);
      for (const double side : {-1.0, 1.0}) {
        BodyDef finger = body(box(0.02, 0.1, 0.05), {side * (radius + 0.02 + room), 0, 0}, 0.8);
        finger.mass = 0.1;
        const Pose along = frame_along(finger.pose.x, {-side, 0, 0}, {0, 1, 0});
        Joint& slide = w.join(JointKind::prismatic, no_body, w.add(finger), along);
        JointDrives drives;
        drives[0].motor.kind = MotorKind::velocity;
        drives[0].motor.target = 1;
        drives[0].motor.max_force = push;
        slide.drives = std::make_shared<JointDrives>(drives);
      }
      // Free until the fingers are there, 0.14 mm of fall for 1 mm at 200 m/s2.
      for (int tick = 0; tick < 0.1 * hz; ++tick) w.step();
      const double held = w.bodies[ball].pose.x.y();
      for (int tick = 0; tick < 3 * hz; ++tick) w.step();
      CHECK(held > -1e-3);
      // Without friction in the moving pass it would slide by g h in every sub-step, 0.1 m in all.
      CHECK(std::fabs(w.bodies[ball].pose.x.y() - held) < 1e-3);
      REQUIRE(w.contacts.size() == 2);
      for (const Contact& contact : w.contacts.contacts()) {
        double force = 0;
        for (const ContactPoint& p : contact.used()) force += p.normal_force;
        CHECK(force == doctest::Approx(push).epsilon(0.01));
      }
    }
}

TEST_CASE(
    "a lever that presses a block holds it by friction, wherever the force acts on the lever") {
  // The lever lies flat on the block, so that a force at the tip, above the middle of the block, is
  // passed on as it is. It turns the lever faster than its share of the force at the centre tells.
  constexpr double mu = 0.8, tip = 0.45, side = 0.05;
  enum class Load { force, spring };
  for (const Load load : {Load::force, Load::spring})
    for (const double hz : {60.0, 240.0})
      for (const double force : {10.0, 100.0}) {
        CAPTURE(int(load));
        CAPTURE(hz);
        CAPTURE(force);
        JointWorld w(hz);
        w.gravity.setZero();
        BodyDef d = body(box(c, side, side), {c, 0, 0}, mu);
        d.mass = 1;
        const uint32_t lever = w.add(d);
        w.join(JointKind::revolute, no_body, lever, Pose{});
        d = body(box(side, side, side), {c + tip, -2 * side, 0}, mu);
        d.mass = 1;
        const uint32_t block = w.add(d);
        Joint& rail =
            w.join(JointKind::prismatic, no_body, block, Pose{d.pose.x, Quat::Identity()});
        JointDrives drives;
        drives[0].motor.kind = MotorKind::force;
        drives[0].motor.target = 0.7 * mu * force;
        rail.drives = std::make_shared<JointDrives>(drives);
        const Vec3 anchor(c + tip, -0.6, 0);
        constexpr double stretch = 0.15;
        w.before_step = [&] {
          RigidBody& b = w.bodies[lever];
          const Vec3 arm = b.pose.q * Vec3(tip, -side, 0), way = anchor - b.pose.x - arm;
          b.force = Vec3(0, -force, 0);
          if (load == Load::spring)
            b.force = force / stretch * (way.norm() - 0.55 + stretch) * way.normalized();
          b.torque = arm.cross(b.force);
        };
        w.run(1);
        CHECK(std::fabs(w.bodies[block].pose.x.z()) < 2e-4);
        REQUIRE(w.contacts.size() == 1);
        const Contact& contact = w.contacts.contacts()[0];
        double pressed = 0;
        for (const ContactPoint& p : contact.used()) {
          pressed += p.normal_force;
          CHECK(p.normal_force > 0.1 * force);
        }
        CHECK(pressed == doctest::Approx(force).epsilon(0.01));
      }
}

TEST_CASE(
    "a motor gives no more than its greatest force in a tick with a hit, and drives with it") {
  constexpr double speed = 3, ball_mass = 5;
  for (const double hz : {60.0, 240.0})
    for (const double target : {-50.0, 0.0, 50.0})
      for (const double most : {2.0, 20.0, 200.0}) {
        CAPTURE(hz);
        CAPTURE(target);
        CAPTURE(most);
        RodRow row(1, hz, 0);
        JointDrives drives;
        drives[0].motor.kind = MotorKind::velocity;
        drives[0].motor.target = target;
        drives[0].motor.max_force = most;
        row.joints[0].drives = std::make_shared<JointDrives>(drives);
        BodyDef d = body(sphere(0.05), {0.9, 0.13, 0}, 0);
        d.mass = ball_mass;
        d.velocity = {0, -speed, 0};
        const uint32_t ball = row.add(d);
        for (int tick = 0; tick < 0.1 * hz; ++tick) {
          const double before = row.bodies[ball].v.y();
          row.step();
          const double impulse = row.joints[0].motor_impulse[0];
          CHECK(std::fabs(impulse) <= most * row.h * (1 + 1e-9));
          // The ball takes the rod to no more than 3.3 rad/s.
          if (row.bodies[ball].v.y() != before && std::fabs(target) == 50)
            CHECK(impulse == doctest::Approx(std::copysign(most * row.h, target)).epsilon(1e-6));
        }
      }
}
