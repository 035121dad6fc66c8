// Rows of joints. Reference: central differences of the errors C and of the rows' velocities along
// motion with constant velocities, in double; resolution about 1e-8 with a step of 1e-6.
#include "engine/core/random.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/rotation.hpp"
#include "tests/support/dense.hpp"

#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

Vec3 vector_in(Random& r, double size) {
  const double x = r.uniform(-size, size), y = r.uniform(-size, size);
  return {x, y, r.uniform(-size, size)};
}

Quat rotation_in(Random& r, double angle) {
  const Vec3 axis = vector_in(r, 1);
  return axis_angle(axis, r.uniform(-angle, angle));
}

/// Two bodies that move at constant velocities, with the frames of a joint on them. `apart` is how
/// far the joint is from being kept [m, rad].
struct MovingPair {
  RigidBody a, b;
  Pose frame_a, frame_b;

  static MovingPair random(Random& r, double apart) {
    MovingPair p;
    for (RigidBody* body : {&p.a, &p.b}) {
      body->pose = {vector_in(r, 2), rotation_in(r, 3)};
      body->v = vector_in(r, 3);
      body->omega = vector_in(r, 3);
    }
    const Pose joint{vector_in(r, 2), rotation_in(r, 3)};
    Pose off{vector_in(r, apart), rotation_in(r, apart)};
    // Differences of the direction between two points need them apart.
    if (apart > 0) off.x *= 1 + 0.4 / off.x.norm();
    p.frame_a = p.a.pose.inverse() * joint;
    p.frame_b = p.b.pose.inverse() * (joint * off);
    return p;
  }
  JointSides sides(double t) const {
    const auto moved = [t](RigidBody body) {
      body.pose.x += t * body.v;
      body.pose.q = integrate_rotation(body.pose.q, body.omega, t);
      return body;
    };
    const RigidBody at = moved(a), bt = moved(b);
    JointSides s{joint_side(frame_a, &at), joint_side(frame_b, &bt), 0.7};
    s.a.block = 0;
    s.b.block = 1;
    return s;
  }
  JointRows rows(JointKind kind, double t) const {
    JointRows out;
    joint_rows(kind, sides(t), out);
    return out;
  }
  std::vector<DofBlock> blocks() const {
    std::vector<DofBlock> out(2);
    out[0].v = a.v, out[0].omega = a.omega;
    out[1].v = b.v, out[1].omega = b.omega;
    return out;
  }
};

constexpr size_t expected_rows[] = {3, 4, 5, 4, 5, 6, 1, 3, 0};

}  // namespace

TEST_CASE("kinds of joints are listed in the order of their names, with the book's rows") {
  REQUIRE(all_joint_kinds().size() == std::size(expected_rows));
  Random r(1);
  const MovingPair pair = MovingPair::random(r, 0.1);
  for (size_t k = 0; k < all_joint_kinds().size(); ++k) {
    const JointKindEntry& e = all_joint_kinds()[k];
    CHECK(size_t(e.kind) == k);
    CHECK_MESSAGE(pair.rows(e.kind, 0).size() == expected_rows[k], e.name);
  }
}

TEST_CASE("every row's Jacobian is the derivative of its error") {
  Random r(2);
  const double h = 1e-6;
  for (const JointKindEntry& e : all_joint_kinds()) {
    for (int i = 0; i < 100; ++i) {
      const MovingPair pair = MovingPair::random(r, 0.7);
      const JointRows now = pair.rows(e.kind, 0);
      const JointRows later = pair.rows(e.kind, h), earlier = pair.rows(e.kind, -h);
      const std::vector<DofBlock> moving = pair.blocks();
      for (size_t k = 0; k < now.size(); ++k) {
        const double rate = (later[k].error - earlier[k].error) / (2 * h);
        CHECK_MESSAGE(std::fabs(row_velocity(now[k].row, moving) - rate) < 1e-7, e.name);
      }
    }
  }
}

TEST_CASE("every row's bias is the rate of its velocity at constant velocities") {
  Random r(3);
  const double h = 1e-6;
  for (const JointKindEntry& e : all_joint_kinds()) {
    for (int i = 0; i < 100; ++i) {
      const MovingPair pair = MovingPair::random(r, 0.7);
      const JointRows now = pair.rows(e.kind, 0);
      const JointRows later = pair.rows(e.kind, h), earlier = pair.rows(e.kind, -h);
      const std::vector<DofBlock> moving = pair.blocks();
      for (size_t k = 0; k < now.size(); ++k) {
        const double rate =
            (row_velocity(later[k].row, moving) - row_velocity(earlier[k].row, moving)) / (2 * h);
        CHECK_MESSAGE(std::fabs(now[k].bias - rate) < 1e-6, e.name);
      }
    }
  }
}

TEST_CASE("coordinates and rows together are at most the six freedoms of a body") {
  for (const JointKindEntry& e : all_joint_kinds()) {
    CHECK(e.coordinates.size() <= most_coordinates);
    CHECK(row_count(e.kind) + e.coordinates.size() <= JointRows::most);
    for (size_t k = 0; k < e.coordinates.size(); ++k)
      CHECK(coordinate_named(e.kind, e.coordinates[k].name) == k);
  }
}

TEST_CASE("every coordinate's Jacobian and bias are the derivatives of its value and its rate") {
  Random r(6);
  const double h = 1e-6;
  for (const JointKindEntry& e : all_joint_kinds())
    for (const JointCoordinate& c : e.coordinates)
      for (int i = 0; i < 100; ++i) {
        const MovingPair pair = MovingPair::random(r, 0.7);
        const JointSides sides = pair.sides(0), later = pair.sides(h), earlier = pair.sides(-h);
        const JointRow now = c.row(sides), next = c.row(later), last = c.row(earlier);
        const double change =
            c.turns ? nearest_turn(next.error - last.error, 0) : next.error - last.error;
        const double rate = row_rate(now, sides);
        CHECK_MESSAGE(std::fabs(rate - change / (2 * h)) < 1e-6, e.name << " " << c.name);
        const double bend = (row_rate(next, later) - row_rate(last, earlier)) / (2 * h);
        CHECK_MESSAGE(std::fabs(now.bias - bend) < 1e-5 * (1 + std::fabs(bend)),
                      e.name << " " << c.name);
      }
}

TEST_CASE("coordinates of joints that are kept are what their names say") {
  Random r(7);
  for (int i = 0; i < 100; ++i) {
    const double a = r.uniform(-3, 3), b = r.uniform(-3, 3);
    const Pose origin{};
    const auto sides = [&](const Pose& frame_b) {
      return JointSides{joint_side(origin, nullptr), joint_side(frame_b, nullptr), 0};
    };
    const auto value = [&](JointKind kind, size_t k, const Pose& frame_b) {
      return entry_of(kind).coordinates[k].row(sides(frame_b)).error;
    };
    const Quat about_z = axis_angle(Vec3::UnitZ(), a), about_x = axis_angle(Vec3::UnitX(), b);
    const Pose turned{Vec3(0.1, 0.2, 0.3), about_z};
    CHECK(nearest_turn(value(JointKind::revolute, 0, turned), a) == doctest::Approx(a));
    CHECK(value(JointKind::cylindrical, 0, turned) == doctest::Approx(0.3));
    CHECK(value(JointKind::planar, 0, turned) == doctest::Approx(0.1));
    CHECK(value(JointKind::planar, 1, turned) == doctest::Approx(0.2));
    CHECK(value(JointKind::free, 0, turned) == doctest::Approx(std::sqrt(0.14)));
    const Pose crossed{Vec3::Zero(), about_z * about_x};
    CHECK(value(JointKind::universal, 0, crossed) == doctest::Approx(a));
    CHECK(value(JointKind::universal, 1, crossed) == doctest::Approx(b));
    // A swing about an axis across z after a twist about z.
    const double c = r.uniform(0, 2 * std::numbers::pi);
    const Quat swing = axis_angle(Vec3(std::cos(c), std::sin(c), 0), std::fabs(b));
    const Pose swung{Vec3::Zero(), swing * about_z};
    CHECK(value(JointKind::spherical, 0, swung) == doctest::Approx(std::fabs(b)));
    CHECK(nearest_turn(value(JointKind::spherical, 1, swung), a) == doctest::Approx(a));
  }
}

TEST_CASE("joints that are kept have no errors and as many independent rows as they take away") {
  Random r(4);
  for (const JointKindEntry& e : all_joint_kinds()) {
    for (int i = 0; i < 20; ++i) {
      MovingPair pair = MovingPair::random(r, 0);
      if (e.kind == JointKind::distance)
        pair.frame_b = pair.frame_b * Pose{0.7 * vector_in(r, 1).normalized(), Quat::Identity()};
      const JointRows rows = pair.rows(e.kind, 0);
      Eigen::MatrixXd J(rows.size(), 12);
      for (size_t k = 0; k < rows.size(); ++k) {
        CHECK(std::fabs(rows[k].error) < 1e-14);
        const Row& row = rows[k].row;
        J.row(Eigen::Index(k)) << dense(row.a.linear).transpose(), dense(row.a.angular).transpose(),
            dense(row.b.linear).transpose(), dense(row.b.angular).transpose();
      }
      if (rows.size() == 0) continue;
      CHECK(singular_values(J).minCoeff() > 0.1);
    }
  }
}

TEST_CASE("impulses of joints that are kept neither push nor turn the pair as a whole") {
  Random r(5);
  for (const JointKindEntry& e : all_joint_kinds()) {
    const MovingPair pair = MovingPair::random(r, 0);
    const JointSides s = pair.sides(0);
    const JointRows rows = pair.rows(e.kind, 0);
    for (const JointRow& row : rows.all()) {
      const auto& [a, b] = row.row;
      CHECK((a.linear + b.linear).norm() < 1e-15);
      const Vec3 turning = s.a.x.cross(a.linear) + a.angular + s.b.x.cross(b.linear) + b.angular;
      CHECK(turning.norm() < 1e-14);
    }
  }
}

TEST_CASE("definitions that make no joint are refused with the reason") {
  JointDef def;
  def.b = {0, 1};
  CHECK(validate(def).ok());
  JointDef same = def;
  same.a = def.b;
  CHECK_FALSE(validate(same).ok());
  JointDef alone = def;
  alone.b = {};
  CHECK_FALSE(validate(alone).ok());
  JointDef rod = def;
  rod.kind = JointKind::distance;
  rod.length = 0;
  REQUIRE_FALSE(validate(rod).ok());
  CHECK(validate(rod).error().text().find("length must be > 0") != std::string::npos);
  JointDef bad = def;
  bad.frame_a.x.x() = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(validate(bad).ok());
}
