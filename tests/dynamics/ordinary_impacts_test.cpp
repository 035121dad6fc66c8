// Impacts of mechanisms that are solved in bundles, as ordinary islands. References: Newton's law
// of impact with the mass matrix of the mechanism, in closed form; the same bits beside any others,
// for every instruction set and number of threads.
#include "tests/dynamics/joint_world.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Dense>
#include <hwy/targets.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Without gravity, all of it solved by bundles. Things go along x and are hit along y.
struct BundledWorld : JointWorld {
  double half;  ///< thickness of the rods: what is slender is solved by the rows of the rest

  explicit BundledWorld(double hz = 60, double half_thickness = 0.2, int threads = 1)
      : JointWorld(hz, threads), half(half_thickness) {
    gravity.setZero();
    settings.max_substeps = settings.substeps;  // as in large islands
  }

  /// Rods of 1 m and 1 kg in a row on hinges along z, the first of them at `at`.
  /// The slot of the first.
  uint32_t rods(int count, const Vec3& at, double restitution) {
    const auto first = uint32_t(bodies.size());
    for (int i = 0; i < count; ++i) {
      BodyDef d = body(box(0.5, half, half), at + Vec3(0.5 + i, 0, 0), 0, restitution);
      d.mass = 1;
      const uint32_t slot = add(d);
      join(JointKind::revolute, i == 0 ? no_body : slot - 1, slot,
           {at + Vec3(i, 0, 0), Quat::Identity()});
    }
    return first;
  }
  uint32_t ball(const Vec3& at, const Vec3& velocity, double restitution) {
    BodyDef d = body(sphere(0.1), at, 0, restitution);
    d.mass = 1;
    d.velocity = velocity;
    return add(d);
  }
  /// The bodies from `first` on turn as one about the hinge of that one.
  void turn(uint32_t first, double rate) {
    const double hinge = bodies[first].pose.x.x() - 0.5;
    for (uint32_t k = first; k < bodies.size(); ++k) {
      bodies[k].omega = {0, 0, rate};
      bodies[k].v = {0, rate * (bodies[k].pose.x.x() - hinge), 0};
    }
  }
  /// Hard limits of a hinge.
  void limit(size_t joint, double lower, double upper, double restitution) {
    JointDrives drives;
    drives[0].limits.lower = lower;
    drives[0].limits.upper = upper;
    drives[0].limits.restitution = restitution;
    joints[joint].drives = std::make_shared<JointDrives>(drives);
  }
  /// Until the velocity of a body has changed.
  void run_until_hit(uint32_t slot) {
    const Vec3 v = bodies[slot].v;
    for (int ticks = 0; (bodies[slot].v - v).norm() < 1e-4 && ticks < 1 / h; ++ticks) step();
    CHECK((bodies[slot].v - v).norm() > 1e-4);
  }
};

/// Moment of inertia of a rod [kg m2].
constexpr double about_hinge_of(double half) {
  return (1 + 4 * half * half) / 12 + 0.25;
}
constexpr double about_hinge = about_hinge_of(0.2);

/// What a unit of impulse across the last of `count` rods in line, at `x` from its hinge, changes
/// the rates of the first and of the last of at most two rods by.
std::array<double, 2> rates_by(int count, double x, double about_hinge) {
  if (count == 1) return {x / about_hinge, x / about_hinge};
  const double m11 = about_hinge + 1, m12 = 0.5, det = m11 * about_hinge - m12 * m12;
  return {(about_hinge - m12 * x) / det, (m11 * x - m12) / det};
}
/// How much faster the point that is hit gets by it.
double yield_of(int count, double x, double about_hinge) {
  const auto [first, last] = rates_by(count, x, about_hinge);
  return count == 1 ? x * last : first + x * last;
}

/// Of rods in line, for their rates.
Eigen::MatrixXd mass_matrix(int count) {
  Eigen::MatrixXd m(count, count);
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < count; ++k)
      m(i, k) = i == k ? about_hinge + (count - 1 - i) : 0.5 + (count - 1 - std::max(i, k));
  return m;
}
/// Rates after those of a straight row of rods, all `rate`, met a limit of the first hinge: an
/// impulsive moment on the first rod (Newton's law of impact).
Eigen::VectorXd after_limit(int count, double rate, double e) {
  const Eigen::VectorXd by_moment = mass_matrix(count).inverse().col(0);
  return Eigen::VectorXd::Constant(count, rate) - (1 + e) * rate / by_moment[0] * by_moment;
}

/// Bits of places and velocities of some bodies after each tick.
void note(const JointWorld& w, uint32_t begin, uint32_t end, std::vector<uint64_t>& bits) {
  for (uint32_t k = begin; k < end; ++k)
    for (const Vec3& v : {w.bodies[k].pose.x, w.bodies[k].v, w.bodies[k].omega})
      for (int i = 0; i < 3; ++i) bits.push_back(std::bit_cast<uint64_t>(v[i]));
}

/// Doors and rows of two rods, each hit by a ball in a tick and at a place of its own.
struct ManyHits : BundledWorld {
  explicit ManyHits(int threads = 1) : BundledWorld(60, 0.2, threads) {
    for (int i = 0; i < 80; ++i) {
      const double x = 0.2 + 0.01 * (i % 70), e = 0.3 + 0.008 * i;
      const Vec3 at(4.0 * (i % 9), 0, 2.0 * (i / 9));
      const int count = 1 + i % 2;
      rods(count, at, e);
      ball(at + Vec3(count - 1 + x, 0.35 + 0.02 * (i % 5), 0), {0, -4 - 0.05 * i, 0}, e);
    }
  }
};

std::vector<uint64_t> bits_of_many_hits(int threads) {
  ManyHits w(threads);
  std::vector<uint64_t> bits;
  for (int tick = 0; tick < 10; ++tick) {
    w.step();
    note(w, 0, uint32_t(w.bodies.size()), bits);
  }
  return bits;
}

}  // namespace

TEST_CASE("in an ordinary island a ball bounces off the whole mechanism, wherever it hits a rod") {
  constexpr double speed = 5;
  for (const double half : {0.2, 0.05})
    for (const int count : {1, 2})
      for (const double place : {0.3, 0.5, 0.0, 0.9})
        for (const double hz : {60.0, 240.0, 960.0})
          for (const double e : {0.5, 1.0}) {
            const double moment = about_hinge_of(half);
            // Also in the centre of percussion, a hit on which the hinge does not feel.
            const double x = place > 0 ? place : 2 * moment;
            CAPTURE(half);
            CAPTURE(count);
            CAPTURE(x);
            CAPTURE(hz);
            CAPTURE(e);
            BundledWorld w(hz, half);
            const uint32_t first = w.rods(count, Vec3::Zero(), e);
            const uint32_t ball = w.ball({count - 1 + x, 0.5, 0}, {0, -speed, 0}, e);
            w.run_until_hit(ball);
            const double yields = 1 + yield_of(count, x, moment);
            const double impulse = (1 + e) * speed / yields;
            const auto [of_first, of_last] = rates_by(count, x, moment);
            const auto rate = [&](int rod) { return w.bodies[first + uint32_t(rod)].omega.z(); };
            const double rates = 0.02 * impulse * (std::fabs(of_first) + std::fabs(of_last));
            CHECK(w.bodies[ball].v.y() == doctest::Approx(impulse - speed).epsilon(0.01));
            CHECK(std::fabs(rate(0) + impulse * of_first) < rates);
            CHECK(std::fabs(rate(count - 1) + impulse * of_last) < rates);
            const double kept = 0.5 * speed * speed * (1 - (1 - e * e) / yields);
            CHECK(w.kinetic_energy() == doctest::Approx(kept).epsilon(5e-3));
            // What the hinge gives is what the rod's momentum lacks.
            if (count == 1)
              CHECK(std::fabs(w.joints[0].impulse.force.y() - impulse * (1 - 0.5 * x / moment)) <
                    0.02 * impulse);
          }
}

TEST_CASE(
    "in an ordinary island of two balls that hit a door at once none takes the other's share") {
  // Beside the hinge a blow lifts the far end of a free rod: there the ball would be pushed too
  // hard at first, which the hinge then shows.
  constexpr double speed = 5, near = 0.1, far = 0.9;
  for (const double e : {0.5, 1.0}) {
    CAPTURE(e);
    BundledWorld w(240);
    const uint32_t door = w.rods(1, Vec3::Zero(), e);
    const uint32_t first = w.ball({near, 0.5, 0}, {0, -speed, 0}, e);
    const uint32_t second = w.ball({far, 0.5, 0}, {0, -speed, 0}, e);
    w.run_until_hit(first);
    const double k11 = 1 + near * near / about_hinge, k12 = near * far / about_hinge;
    const double k22 = 1 + far * far / about_hinge, det = k11 * k22 - k12 * k12;
    const double at_near = (1 + e) * speed * (k22 - k12) / det;
    const double at_far = (1 + e) * speed * (k11 - k12) / det;
    CHECK(w.bodies[first].v.y() == doctest::Approx(at_near - speed).epsilon(0.01));
    CHECK(std::fabs(w.bodies[second].v.y() - (at_far - speed)) < 0.01 * speed);
    CHECK(w.bodies[door].omega.z() ==
          doctest::Approx(-(at_near * near + at_far * far) / about_hinge).epsilon(0.01));
  }
}

TEST_CASE("in an ordinary island a blow along a row of jointed balls meets their whole mass") {
  constexpr double speed = 3;
  for (const int count : {2, 4, 8})
    for (const double e : {0.5, 1.0}) {
      CAPTURE(count);
      CAPTURE(e);
      BundledWorld w(240);
      for (int i = 0; i < count; ++i) {
        const uint32_t slot = w.ball({0.2 * i, 0, 0}, Vec3::Zero(), e);
        if (i > 0)
          w.join(JointKind::spherical, slot - 1, slot,
                 {Vec3(0.2 * i - 0.1, 0, 0), Quat::Identity()});
      }
      const uint32_t ball = w.ball({-0.4, 0, 0}, {speed, 0, 0}, e);
      w.run_until_hit(ball);
      // Newton's law for 1 kg that meets `count` kg at rest.
      CHECK(w.bodies[ball].v.x() ==
            doctest::Approx(speed * (1 - e * count) / (1 + count)).epsilon(0.02));
      for (int i = 0; i < count; ++i)
        CHECK(std::fabs(w.bodies[size_t(i)].v.x() - (1 + e) * speed / (1 + count)) < 0.025 * speed);
      CHECK((w.momentum() - Vec3(speed, 0, 0)).norm() < 1e-5 * speed);
      // It is over with the tick: what joints gave is not given again.
      w.step();
      for (int i = 0; i < count; ++i)
        CHECK(std::fabs(w.bodies[size_t(i)].v.x() - (1 + e) * speed / (1 + count)) < 0.025 * speed);
    }
}

TEST_CASE("a blow goes its way in one mechanism however long it takes in another") {
  const auto bits = [](bool beside) {
    BundledWorld w;
    const uint32_t first = w.rods(2, Vec3::Zero(), 0.7);
    w.ball({1.4, 0.5, 0}, {0, -5, 0}, 0.7);
    const auto end = uint32_t(w.bodies.size());
    if (beside) {
      w.rods(12, {0, 0, 5}, 1);
      w.ball({11.3, 0.5, 5}, {0, -5, 0}, 1);
      w.rods(1, {0, 0, 10}, 1);
      w.ball({2 * about_hinge, 0.5, 10}, {0, -5, 0}, 1);
    }
    std::vector<uint64_t> out;
    for (int tick = 0; tick < 20; ++tick) {
      w.step();
      note(w, first, end, out);
    }
    return out;
  };
  CHECK(bits(false) == bits(true));
}

TEST_CASE("in an ordinary island a limit gives back its restitution, whatever hangs on the joint") {
  constexpr double w0 = 2;
  for (const int count : {1, 2, 8})
    for (const double hz : {60.0, 240.0, 960.0})
      for (const double e : {0.5, 1.0}) {
        CAPTURE(count);
        CAPTURE(hz);
        CAPTURE(e);
        BundledWorld w(hz);
        w.rods(count, Vec3::Zero(), 0);
        w.turn(0, w0);
        w.limit(0, -no_bound, 0.17, e);
        const auto rate = [&](int rod) { return w.bodies[size_t(rod)].omega.z(); };
        for (int ticks = 0; rate(0) > 0 && ticks < hz; ++ticks) w.step();
        const Eigen::VectorXd after = after_limit(count, w0, e);
        // The rods bend at once: within the tick the rates change by the square of the rates.
        const double within = 0.01 + (count == 1 ? 0 : count == 2 ? 8 : 20) / hz;
        CHECK(std::fabs(rate(0) - after[0]) < within);
        CHECK(std::fabs(rate(count - 1) - after[count - 1]) < within);
        const double energy = w.kinetic_energy();
        CHECK(energy == doctest::Approx(0.5 * after.dot(mass_matrix(count) * after)).epsilon(5e-3));
        // It is over with the blow: nothing of it is given again.
        for (int ticks = 0; ticks < 0.05 * hz; ++ticks) {
          w.step();
          CHECK(w.kinetic_energy() == doctest::Approx(energy).epsilon(5e-3));
        }
      }
}

TEST_CASE("in an ordinary island a limit is met as if the crowd about it were not there") {
  // Chains of balls at rest hang on points of the rod on its axis, which do not move.
  constexpr double w0 = 2;
  for (const int chains : {0, 2})
    for (const double e : {0.5, 1.0}) {
      CAPTURE(chains);
      CAPTURE(e);
      BundledWorld w(240);
      w.rods(1, Vec3::Zero(), 0);
      w.turn(0, w0);
      w.limit(0, -0.17, 0.17, e);
      for (int chain = 0; chain < chains; ++chain) {
        Vec3 joint(0, 0, chain == 0 ? 0.35 : -0.35);
        const Vec3 along(-1, 0, 0);
        for (int i = 0; i < 12; ++i, joint += 0.25 * along) {
          const uint32_t slot = w.ball(joint + 0.125 * along, Vec3::Zero(), 0);
          w.join(JointKind::spherical, i == 0 ? 0 : slot - 1, slot, {joint, Quat::Identity()});
        }
      }
      const auto energy = [&] { return w.kinetic_energy() / (0.5 * about_hinge * w0 * w0); };
      double before = w0;
      int bounces = 0;
      for (int ticks = 0; ticks < 240; ++ticks) {
        w.step();
        const double rate = w.bodies[0].omega.z();
        if (rate * before < 0) {
          ++bounces;
          CHECK(rate / before == doctest::Approx(-e).epsilon(0.015));
        }
        before = rate;
        CHECK(energy() < 1.01);
      }
      CHECK(bounces == (e == 1 ? 6 : 2));
      CHECK(energy() > 0.95 * std::pow(e, 2 * bounces));
    }
}

TEST_CASE("a limit gives back its blow in one mechanism however long that takes in another") {
  const auto bits = [](bool beside) {
    BundledWorld w;
    const auto swing = [&](int count, const Vec3& at, double upper) {
      const auto joint = w.joints.size();
      w.turn(w.rods(count, at, 0), 2);
      for (size_t k = joint; k < w.joints.size(); ++k)
        w.limit(k, -no_bound, k == joint ? upper : 3, 0.8);
    };
    swing(2, Vec3::Zero(), 0.17);
    const auto end = uint32_t(w.bodies.size());
    if (beside) swing(6, {0, 0, 5}, 0.05);  // met earlier
    std::vector<uint64_t> out;
    for (int tick = 0; tick < 20; ++tick) {
      w.step();
      note(w, 0, end, out);
    }
    return out;
  };
  CHECK(bits(false) == bits(true));
}

TEST_CASE("blows have the same bits for every instruction set and on 1, 2 and 4 threads") {
  const std::vector<uint64_t> best = bits_of_many_hits(1);
  for (const int threads : {2, 4}) CHECK(bits_of_many_hits(threads) == best);
  for (int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    const int64_t target = left & -left;
    CAPTURE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    CHECK(bits_of_many_hits(1) == best);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
}
