// Slip that no force can stop (Painlevé's rod). Reference: the closed form of the impulse after
// which a point neither slips nor approaches, and the bound of friction beyond which no force is in
// balance (Painlevé 1895; Génot & Brogliato 1999). Of scenes with many jams the balance of energy.
#include "engine/dynamics/event/impulses/jam.hpp"

#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"
#include "tests/support/scale.hpp"

#include <cmath>

#include <Eigen/LU>

using namespace tumble;
using namespace tumble::test;

namespace {

/// A rod of 1 kg and 2 m that leans to the right at 60 degrees; its lower end slides to the left.
struct Rod {
  double c = 0.5, s = std::sqrt(0.75), inertia = 1.0 / 3;

  DofBlock block() const {
    DofBlock b;
    b.inverse_mass = 1;
    b.inverse_inertia = Vec3(1e3, 1 / inertia, 1 / inertia).asDiagonal();
    b.v = {-1, 0, 0};
    return b;
  }
  ImpactPoint foot(double friction) const {
    ImpactPoint p;
    p.b = 0;
    p.arm_b = {-c, -s, 0};
    p.friction = friction;
    return p;
  }
  /// Friction beyond which normal forces press.
  double bound() const { return (1 + 3 * c * c) / (3 * s * c); }
};

Vec3 foot_velocity(const DofBlock& b, const Vec3& arm) {
  return b.v + b.omega.cross(arm);
}

}  // namespace

TEST_CASE("jams: Painlevé's rod is stopped beyond the bound of friction, not below it") {
  const Rod rod;
  for (const double share : {0.5, 0.999, 1.001, 1.5, 10.0}) {
    std::vector<DofBlock> blocks{rod.block()};
    const ImpactPoint foot = rod.foot(share * rod.bound());
    ImpactReport report;
    CAPTURE(share);
    const int jams = resolve_jams(blocks, std::vector{foot}, report);
    CHECK(jams == (share > 1 ? 1 : 0));
    if (share < 1) {
      CHECK((blocks[0].v - Vec3(-1, 0, 0)).norm() == 0);
      continue;
    }
    // K^-1 u for the 2x2 matrix of the plane, whose determinant is 4.
    const Vec3 want(0.25 * (1 + 3 * rod.c * rod.c), 0.25 * 3 * rod.s * rod.c, 0);
    CHECK((report.impulses[0] - want).norm() < 1e-7);
    CHECK(foot_velocity(blocks[0], foot.arm_b).norm() < 1e-8);
    CHECK(report.work == doctest::Approx(-0.5 * want.x()).epsilon(1e-7));
  }
}

TEST_CASE("jams: what sticks, rolls, or slides without friction is left alone") {
  const Rod rod;
  std::vector<DofBlock> blocks{rod.block()};
  blocks[0].v.setZero();
  ImpactReport report;
  CHECK(resolve_jams(blocks, std::vector{rod.foot(3)}, report) == 0);
  blocks[0].v = {1, 0, 0};  // the other way friction lifts
  CHECK(resolve_jams(blocks, std::vector{rod.foot(3)}, report) == 0);
  blocks[0].v = {-1, 0, 0};
  CHECK(resolve_jams(blocks, std::vector{rod.foot(0)}, report) == 0);
}

namespace {

/// A plate that slides along two walls in its plane: random arms, motion and friction, and walls
/// along the velocities of their points.
struct SlidingPlate {
  DofBlock block;
  std::vector<ImpactPoint> points;

  explicit SlidingPlate(Random& r) {
    block.inverse_mass = 1;
    block.inverse_inertia = Vec3(1e3, 1e3, r.uniform(1, 6)).asDiagonal();
    block.v = {r.uniform(-1, 1), r.uniform(-1, 1), 0};
    block.omega = {0, 0, r.uniform(-3, 3)};
    for (int i = 0; i < 2; ++i) {
      ImpactPoint p;
      p.b = 0;
      p.arm_b = {r.uniform(-1, 1), r.uniform(-1, 1), 0};
      const Vec3 along = foot_velocity(block, p.arm_b).normalized();
      p.normal = (r.uniform() < 0.5 ? 1 : -1) * Vec3(-along.y(), along.x(), 0);
      p.friction = r.uniform(0.1, 2);
      points.push_back(p);
    }
  }
  /// Of normal forces with friction against the slip on the normal accelerations.
  Eigen::Matrix2d response() const {
    Eigen::Matrix2d A;
    for (int j = 0; j < 2; ++j) {
      const ImpactPoint& p = points[size_t(j)];
      const Vec3 force = p.normal - p.friction * foot_velocity(block, p.arm_b).normalized();
      const Vec3 turn = block.inverse_inertia * p.arm_b.cross(force);
      for (int i = 0; i < 2; ++i) {
        const ImpactPoint& q = points[size_t(i)];
        A(i, j) = q.normal.dot(block.inverse_mass * force + turn.cross(q.arm_b));
      }
    }
    return A;
  }
};

/// Whether f >= 0 with w = A f + b >= 0 and f w = 0 exists, A_ii > 0: all four cases by hand.
bool balanced(const Eigen::Matrix2d& A, const Eigen::Vector2d& b) {
  const Eigen::Vector2d both = -A.inverse() * b;
  const auto one = [&](int i, int other) {
    return b[i] <= 0 && b[other] - A(other, i) * b[i] / A(i, i) >= 0;
  };
  return (both.x() >= 0 && both.y() >= 0) || (b.x() >= 0 && b.y() >= 0) || one(0, 1) || one(1, 0);
}

}  // namespace

TEST_CASE("jams: two points may jam together though neither does alone") {
  Random r(12);
  int jammed = 0, balances = 0, locked = 0;
  for (int k = 0; k < 2000; ++k) {
    const SlidingPlate plate(r);
    const Eigen::Matrix2d A = plate.response();
    if (A(0, 0) < 0.01 || A(1, 1) < 0.01 || std::fabs(A.determinant()) < 0.01) continue;
    CAPTURE(k);
    std::vector<DofBlock> blocks{plate.block};
    ImpactReport report;
    CHECK(resolve_jams(blocks, plate.points, report) == 0);
    report = {};
    blocks = {plate.block};
    // Half of them alike at both points, as an impulse finds them.
    Eigen::Vector2d b(-1, -1);
    if (k % 2 == 1) b = {r.uniform(-2, 0.5), r.uniform(-2, 0.5)};
    if (std::min(std::fabs(b.x()), std::fabs(b.y())) < 0.01) continue;
    const std::vector<Vec3> accelerations{b.x() * plate.points[0].normal,
                                          b.y() * plate.points[1].normal};
    const int jams = resolve_common_jam(blocks, plate.points, accelerations, report);
    if (jams == 0) CHECK((blocks[0].v - plate.block.v).norm() == 0);
    balances += balanced(A, b);
    if (balanced(A, b)) continue;
    // Walls may also lock what is between them so that no impulse parts it from both.
    if (report.status == ImpactStatus::unsolved) {
      ++locked;
      continue;
    }
    ++jammed;
    CHECK(jams > 0);
    Vec3 sum = Vec3::Zero();
    for (size_t i = 0; i < 2; ++i) {
      const ImpactPoint& p = plate.points[i];
      const Vec3 push = report.impulses[i], u = foot_velocity(blocks[0], p.arm_b);
      const double normal = p.normal.dot(push), slip = (u - p.normal.dot(u) * p.normal).norm();
      const Vec3 lateral = push - normal * p.normal;
      CHECK(p.normal.dot(u) > -1e-7);
      CHECK(normal >= -1e-7);
      CHECK(lateral.norm() <= p.friction * normal + 1e-7);
      if (slip > 1e-6) CHECK(lateral.dot(u) <= -p.friction * normal * slip + 1e-7);
      sum += push;
    }
    CHECK((blocks[0].v - plate.block.v - sum).norm() < 1e-9);
    CHECK(report.work <= 1e-9);
  }
  CHECK(balances > 100);
  CHECK(jammed > 20);
  CHECK(locked < jammed);
}

TEST_CASE("event: a rod that no force can hold is stopped by an impulse, and falls from there") {
  EventWorld w(10000);
  w.fixed(box(50, 1, 50), {0, -1, 0}, 2.0);
  BodyDef def = body(capsule(0.01, 2), {0, 0.01 + std::sqrt(0.75), 0}, 2.0);
  def.pose.q = axis_angle(Vec3::UnitZ(), -3.14159265358979323846 / 6);
  def.velocity = {-1, 0, 0};
  const uint32_t rod = w.add(def);
  const Vec3 arm(-0.5, -w.bodies[rod].pose.x.y(), 0);
  const RigidBody before = w.bodies[rod];
  w.step();
  CHECK(w.stepper.stats.jams == 1);
  // The closed form, in the plane: p = -K^-1 u.
  const double m = before.mass, I = before.inertia_world()(2, 2);
  Eigen::Matrix2d K;
  K << 1 / m + arm.y() * arm.y() / I, -arm.x() * arm.y() / I, -arm.x() * arm.y() / I,
      1 / m + arm.x() * arm.x() / I;
  const Eigen::Vector2d p = K.inverse() * Eigen::Vector2d(1, 0);
  const Vec3 v(-1 + p.x() / m, p.y() / m, 0);
  const double turn = (arm.x() * p.y() - arm.y() * p.x()) / I;
  CHECK((w.bodies[rod].v - v).norm() < 5e-3);
  CHECK(std::fabs(w.bodies[rod].omega.z() - turn) < 5e-3);
  CHECK(w.energy() < before.kinetic_energy() + m * 9.81 * before.pose.x.y());
  for (int i = 0; i < 3000; ++i) w.step();
  CHECK(w.deepest < 1e-8);
  CHECK(w.bodies[rod].v.allFinite());
}

namespace {

Quat leaning(double angle) {
  return axis_angle(Vec3::UnitZ(), angle);
}

/// Two rods that hang together at their upper ends and slide on their lower ones.
void add_compasses(EventWorld& w, Random& r) {
  const double friction = r.uniform(0.8, 2);
  w.floor(friction);
  const double length = r.uniform(0.5, 1.5), angle = r.uniform(0.2, 1.2), speed = r.uniform(-4, 4);
  const double top = 0.02 + length * std::cos(angle) + 1e-5;
  for (const int side : {-1, 1}) {
    BodyDef d = body(
        capsule(0.02, length),
        {side * 0.5 * length * std::sin(angle), top - 0.5 * length * std::cos(angle), 0}, friction);
    d.pose.q = leaning(side * angle);
    d.velocity = {speed, 0, 0};
    w.add(d);
  }
  w.join(JointKind::revolute, 1, 2, {{0, top, 0}, Quat::Identity()});
}

/// Steps, each of which must find its answer and take energy.
EventStats run_jammed(void (*add)(EventWorld&, Random&), int seed, int ticks) {
  if (test::only_to_run()) ticks = std::min(ticks, 8);
  EventWorld w;
  Random r{uint64_t(seed)};
  add(w, r);
  EventStats sum;
  double energy = w.energy();
  for (int k = 0; k < ticks; ++k) {
    CAPTURE(seed);
    CAPTURE(k);
    w.step();
    const double now = w.energy();
    CHECK(now < energy + 1e-6 * (1 + std::fabs(energy)));
    energy = now;
    sum.include(w.stepper.stats);
  }
  CHECK(w.deepest < 1e-7);
  CHECK(w.joint_error() < 1e-9);
  return sum;
}

}  // namespace

TEST_CASE("event: a pair of rods that close in on each other sticks or slides as one") {
  // The slip of one foot ends with that of the other, at the same place.
  for (const int seed : {8012, 8014, 8016, 8023, 8045, 8001}) run_jammed(add_compasses, seed, 75);
}
