// Laws of simultaneous impact. References: closed forms of Newton's cradle and of the symmetric
// break under each law (Smith et al. 2012, section 2; worked out in the tests); conservation of
// momentum and energy; the single collision by Stronge's energetic law; of how points answer to
// each other the matrix of all their rows.
#include "engine/core/random.hpp"
#include "engine/dynamics/event/impulses/energetic_impact.hpp"
#include "engine/dynamics/event/impulses/impact_law.hpp"
#include "engine/dynamics/event/impulses/point_mobility.hpp"
#include "engine/dynamics/rows/delassus.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

ImpactLaw law(std::string_view name) {
  for (const ImpactLawEntry& e : all_impact_laws())
    if (e.name == name) return e.resolve;
  FAIL("no such law");
  return nullptr;
}

DofBlock ball(double mass, const Vec3& v, double radius = 0.5) {
  DofBlock b;
  b.inverse_mass = 1 / mass;
  b.inverse_inertia = Mat3::Identity() / (0.4 * mass * radius * radius);
  b.v = v;
  return b;
}

/// Balls of radius 0.5 in a row along x, touching.
std::vector<ImpactPoint> row_of_balls(uint32_t n, double restitution) {
  std::vector<ImpactPoint> out;
  for (uint32_t i = 0; i + 1 < n; ++i) {
    ImpactPoint p;
    p.a = i, p.b = i + 1;
    p.normal = Vec3::UnitX();
    p.arm_a = 0.5 * Vec3::UnitX(), p.arm_b = -0.5 * Vec3::UnitX();
    p.restitution = restitution;
    out.push_back(p);
  }
  return out;
}

double kinetic_energy(std::span<const DofBlock> blocks) {
  double e = 0;
  for (const DofBlock& b : blocks) {
    if (b.inverse_mass == 0) continue;
    e += 0.5 * b.v.squaredNorm() / b.inverse_mass;
    if (!b.inverse_inertia.isZero()) e += 0.5 * b.omega.dot(b.inverse_inertia.inverse() * b.omega);
  }
  return e;
}

/// A row between two walls, which touches both.
std::vector<ImpactPoint> wedged_row(uint32_t n, double restitution) {
  std::vector<ImpactPoint> out = row_of_balls(n, restitution);
  ImpactPoint left = out.front(), right = left;
  left.a = no_block, left.b = 0;
  right.a = n - 1, right.b = no_block;
  out.push_back(left);
  out.push_back(right);
  return out;
}

/// Balls of unequal sizes around one another and on a floor, all touching.
struct Cluster {
  std::vector<DofBlock> blocks;
  std::vector<Vec3> centres;
  std::vector<ImpactPoint> points;
};
Cluster random_cluster(Random& r, double friction, bool elastic) {
  Cluster c;
  std::vector<double> radii;
  const auto add = [&](const Vec3& x, double radius) {
    c.centres.push_back(x);
    radii.push_back(radius);
    const double mass = r.uniform(0.2, 3);
    DofBlock b = ball(mass, Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)), radius);
    b.omega = Vec3(r.uniform(-3, 3), r.uniform(-3, 3), r.uniform(-3, 3));
    c.blocks.push_back(b);
  };
  add(Vec3::Zero(), 0.5);
  for (int k = 0; k < 6; ++k) {  // each on the surface of an earlier one
    const size_t on = r.below(uint32_t(c.centres.size()));
    Vec3 d(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
    d.normalize();
    const double radius = r.uniform(0.2, 0.6);
    const Vec3 x = c.centres[on] + (radii[on] + radius) * d;
    add(x, radius);
    ImpactPoint p;
    p.a = uint32_t(on), p.b = uint32_t(c.centres.size() - 1);
    p.normal = d;
    p.arm_a = radii[on] * d, p.arm_b = -radius * d;
    p.friction = friction > 0 ? r.uniform(0, friction) : 0;
    p.restitution = elastic ? 1 : r.uniform();
    c.points.push_back(p);
  }
  return c;
}

}  // namespace

TEST_CASE("Newton's cradle: one ball in, one ball out, under reflections and in sequence (A4)") {
  for (const uint32_t n : {3u, 5u, 9u}) {
    for (const char* name : {"reflections", "sequential"}) {
      std::vector<DofBlock> balls(n, ball(2, Vec3::Zero()));
      balls[0].v = {1.5, 0, 0};
      const ImpactReport report = law(name)(balls, row_of_balls(n, 1), {});
      REQUIRE(report.status == ImpactStatus::solved);
      for (uint32_t i = 0; i < n; ++i) {
        CHECK(balls[i].v.x() == doctest::Approx(i + 1 == n ? 1.5 : 0).scale(1).epsilon(1e-12));
        CHECK(std::fabs(balls[i].v.y()) < 1e-15);
      }
      CHECK(std::fabs(report.work) < 1e-12);
    }
  }
}

TEST_CASE("a row between walls stops within few rounds, though its wave fades slowly") {
  // Reference: velocities that do not fall along the row, >= 0 at one wall and <= 0 at the other,
  // are zero. The wave halves in some n^2/4 rounds.
  for (const double restitution : {0.0, 0.1, 0.5}) {
    std::vector<DofBlock> balls(14, ball(2, Vec3::Zero()));
    balls[4].v = {3, 0, 0};
    const ImpactReport report = law("reflections")(balls, wedged_row(14, restitution), {});
    REQUIRE(report.status == ImpactStatus::solved);
    CAPTURE(restitution);
    CHECK(report.rounds <= (restitution == 0 ? 1 : 500));
    for (const DofBlock& b : balls) CHECK(b.v.norm() < 1e-9);
    CHECK(report.work == doctest::Approx(-9).epsilon(1e-9));
  }
}

TEST_CASE("without any restitution reflections are one plain inelastic collision") {
  Random r(12);
  for (int k = 0; k < 20; ++k) {
    Cluster c = random_cluster(r, 0.5, true);
    for (ImpactPoint& p : c.points) p.restitution = 0;
    std::vector<DofBlock> once = c.blocks, reflected = c.blocks;
    const ImpactReport report = law("reflections")(reflected, c.points, {});
    REQUIRE(law("simultaneous_newton")(once, c.points, {}).status == ImpactStatus::solved);
    REQUIRE(report.status == ImpactStatus::solved);
    CHECK(report.rounds <= 1);
    CHECK(report.work <= 1e-12);
    for (size_t i = 0; i < once.size(); ++i) CHECK((once[i].v - reflected[i].v).norm() < 1e-9);
  }
}

TEST_CASE("two balls in, two out, both ends at once change places") {
  for (const char* name : {"reflections", "sequential"}) {
    std::vector<DofBlock> balls(5, ball(1, Vec3::Zero()));
    balls[0].v = balls[1].v = {1, 0, 0};
    REQUIRE(law(name)(balls, row_of_balls(5, 1), {}).status == ImpactStatus::solved);
    for (int i = 0; i < 5; ++i)
      CHECK(balls[size_t(i)].v.x() == doctest::Approx(i > 2 ? 1 : 0).scale(1).epsilon(1e-12));
    std::fill(balls.begin(), balls.end(), ball(1, Vec3::Zero()));
    balls[0].v = {1, 0, 0}, balls[4].v = {-1, 0, 0};
    REQUIRE(law(name)(balls, row_of_balls(5, 1), {}).status == ImpactStatus::solved);
    const double want[5] = {-1, 0, 0, 0, 1};
    for (int i = 0; i < 5; ++i)
      CHECK(balls[size_t(i)].v.x() == doctest::Approx(want[i]).scale(1).epsilon(1e-12));
  }
}

TEST_CASE("the simultaneous laws move all balls of a touching cradle, by their closed form") {
  // Compression: all at v/n. Expansion: the same impulses again: ball i leaves at 2v/n but the
  // first, which has 2v/n - v.
  for (const char* name : {"simultaneous_newton", "simultaneous_poisson"}) {
    for (const uint32_t n : {2u, 3u, 5u}) {
      std::vector<DofBlock> balls(n, ball(1, Vec3::Zero()));
      balls[0].v = {1, 0, 0};
      const ImpactReport report = law(name)(balls, row_of_balls(n, 1), {});
      REQUIRE(report.status == ImpactStatus::solved);
      for (uint32_t i = 0; i < n; ++i)
        CHECK(balls[i].v.x() == doctest::Approx(2.0 / n - (i == 0)).scale(1).epsilon(1e-12));
      CHECK(std::fabs(report.work) < 1e-12);
    }
  }
}

TEST_CASE("a ball that breaks two: symmetric under all laws but the sequential one") {
  // The cue along x hits two touching balls at 30 degrees: -1/5 and 2 sqrt(3)/5 of its speed.
  const auto set = [](std::vector<DofBlock>& balls) {
    balls = {ball(1, {1, 0, 0}), ball(1, Vec3::Zero()), ball(1, Vec3::Zero())};
    std::vector<ImpactPoint> points(2);
    const double c = std::sqrt(0.75);
    for (uint32_t k = 0; k < 2; ++k) {
      points[k].a = 0, points[k].b = k + 1;
      points[k].normal = {c, k == 0 ? 0.5 : -0.5, 0};
      points[k].arm_a = 0.5 * points[k].normal, points[k].arm_b = -0.5 * points[k].normal;
      points[k].restitution = 1;
    }
    return points;
  };
  for (const ImpactLawEntry& entry : all_impact_laws()) {
    std::vector<DofBlock> balls;
    const auto points = set(balls);
    REQUIRE(entry.resolve(balls, points, {}).status == ImpactStatus::solved);
    CAPTURE(entry.name);
    if (entry.name == "sequential") {
      CHECK(std::fabs(balls[0].v.y()) > 0.1);
    } else {
      CHECK(balls[0].v.x() == doctest::Approx(-0.2).epsilon(1e-12));
      CHECK(std::fabs(balls[0].v.y()) < 1e-13);
      CHECK(balls[1].v.norm() == doctest::Approx(2 * std::sqrt(3.0) / 5).epsilon(1e-12));
      CHECK(balls[1].v.y() == doctest::Approx(-balls[2].v.y()).epsilon(1e-12));
    }
    CHECK(kinetic_energy(balls) == doctest::Approx(0.5).epsilon(1e-12));
  }
}

TEST_CASE("a box that falls flat on four corners rebounds straight, at its restitution") {
  for (const ImpactLawEntry& entry : all_impact_laws()) {
    for (const double e : {0.0, 0.4, 1.0}) {
      std::vector<DofBlock> box(1);
      box[0].inverse_mass = 0.5;
      box[0].inverse_inertia = Vec3(3, 2, 1).asDiagonal();
      box[0].v = {0, -2, 0};
      std::vector<ImpactPoint> points(4);
      for (int k = 0; k < 4; ++k) {
        points[size_t(k)].b = 0;
        points[size_t(k)].arm_b = {k & 1 ? 0.5 : -0.5, -0.5, k & 2 ? 0.5 : -0.5};
        points[size_t(k)].restitution = e;
        points[size_t(k)].friction = 0.5;
      }
      const ImpactReport report = entry.resolve(box, points, {});
      CAPTURE(entry.name);
      CAPTURE(e);
      REQUIRE(report.status == ImpactStatus::solved);
      if (entry.name == "sequential") continue;  // one corner after the other
      CHECK(box[0].v.y() == doctest::Approx(2 * e).scale(1).epsilon(1e-9));
      CHECK(box[0].omega.norm() < 1e-9);
      CHECK(Vec3(box[0].v.x(), 0, box[0].v.z()).norm() < 1e-9);
    }
  }
}

TEST_CASE("one collision of a ball: every law agrees with the energetic one") {
  Random r(11);
  for (int i = 0; i < 100; ++i) {
    const double e = r.uniform(), mu = r.uniform();
    std::vector<DofBlock> start{ball(1.3, Vec3(r.uniform(-2, 2), -1, r.uniform(-2, 2)))};
    start[0].omega = Vec3(r.uniform(-2, 2), r.uniform(-2, 2), r.uniform(-2, 2));
    ImpactPoint p;
    p.b = 0;
    p.arm_b = {0, -0.5, 0};
    p.friction = mu, p.restitution = e;
    std::vector<DofBlock> want = start;
    REQUIRE(law("sequential")(want, {&p, 1}, {}).status == ImpactStatus::solved);
    for (const ImpactLawEntry& entry : all_impact_laws()) {
      if (entry.name == "simultaneous_poisson") continue;  // its slip may end in either phase
      std::vector<DofBlock> got = start;
      REQUIRE(entry.resolve(got, {&p, 1}, {}).status == ImpactStatus::solved);
      CAPTURE(entry.name);
      CHECK((got[0].v - want[0].v).norm() < 1e-8);
      CHECK((got[0].omega - want[0].omega).norm() < 1e-8);
    }
  }
}

TEST_CASE("random clusters: momentum is kept, energy never grows, nothing approaches any more") {
  Random r(12);
  for (int i = 0; i < 150; ++i) {
    const bool elastic = i % 3 == 0, smooth = i % 2 == 0;
    const Cluster c = random_cluster(r, smooth ? 0 : 0.8, elastic);
    for (const ImpactLawEntry& entry : all_impact_laws()) {
      std::vector<DofBlock> blocks = c.blocks;
      const ImpactReport report = entry.resolve(blocks, c.points, {});
      CAPTURE(entry.name);
      CAPTURE(i);
      REQUIRE(report.status == ImpactStatus::solved);
      Vec3 p = Vec3::Zero(), L = Vec3::Zero();
      double scale = 0;
      for (size_t k = 0; k < blocks.size(); ++k) {
        const Vec3 dp = (blocks[k].v - c.blocks[k].v) / blocks[k].inverse_mass;
        p += dp;
        L += c.centres[k].cross(dp) +
             blocks[k].inverse_inertia.inverse() * (blocks[k].omega - c.blocks[k].omega);
        scale += dp.norm();
      }
      CHECK(p.norm() <= 1e-12 * (scale + 1));
      CHECK(L.norm() <= 1e-12 * (scale + 1));
      const double before = kinetic_energy(c.blocks), after = kinetic_energy(blocks);
      CHECK(after <= before * (1 + 1e-10));
      CHECK(after - before == doctest::Approx(report.work).scale(before).epsilon(1e-10));
      // What expansion makes approach is stopped without restitution.
      const bool keeps = entry.name != "simultaneous_poisson";
      if (elastic && smooth && keeps) CHECK(after == doctest::Approx(before).epsilon(1e-8));
      for (size_t k = 0; k < c.points.size(); ++k) {
        const Vec3& n = c.points[k].normal;
        CHECK(n.dot(report.velocity_after[k]) > -1e-8);
        const double pn = n.dot(report.impulses[k]);
        CHECK(pn >= -1e-9);
        CHECK((report.impulses[k] - pn * n).norm() <= c.points[k].friction * pn + 1e-8);
      }
    }
  }
}

TEST_CASE("restitution of velocities cannot create energy (Kane & Levinson's pendulum)") {
  // A rod strikes the ground obliquely with friction: Newton's law alone would gain energy.
  int scaled = 0;
  Random r(13);
  for (int k = 0; k < 500; ++k) {
    const double angle = r.uniform(0.1, 1.5);
    std::vector<DofBlock> rod(1);
    rod[0].inverse_mass = 1;
    rod[0].inverse_inertia = Mat3::Identity() * 12.0;
    rod[0].v = {r.uniform(-3, 3), -1, 0};
    ImpactPoint p;
    p.b = 0;
    p.arm_b = 0.5 * Vec3(std::cos(angle), -std::sin(angle), 0);
    p.friction = r.uniform(0.1, 1.2);
    p.restitution = 1;
    const double before = kinetic_energy(rod);
    const ImpactReport report = law("simultaneous_newton")(rod, {&p, 1}, {});
    REQUIRE(report.status == ImpactStatus::solved);
    CHECK(kinetic_energy(rod) <= before * (1 + 1e-10));
    scaled += report.restitution_scale < 1;
  }
  CHECK(scaled > 0);
}

TEST_CASE("a moving wall and a belt do their work, hostile input is refused") {
  // A kinematic wall at 1 m/s hits a ball at rest: the ball leaves at 2 m/s.
  std::vector<DofBlock> blocks{DofBlock{}, ball(1, Vec3::Zero())};
  blocks[0].v = {1, 0, 0};
  ImpactPoint p;
  p.a = 0, p.b = 1;
  p.normal = Vec3::UnitX();
  p.arm_b = {-0.5, 0, 0};
  p.restitution = 1;
  for (const ImpactLawEntry& entry : all_impact_laws()) {
    std::vector<DofBlock> got = blocks;
    const ImpactReport report = entry.resolve(got, {&p, 1}, {});
    CHECK(got[1].v.x() == doctest::Approx(2).epsilon(1e-12));
    CHECK(got[0].v.x() == 1);
    CHECK(report.restitution_scale == 1);
    got[1].v.y() = std::nan("");
    CHECK(entry.resolve(got, {&p, 1}, {}).status == ImpactStatus::invalid);
    CHECK(entry.resolve(got, {}, {}).status == ImpactStatus::solved);
  }
}

namespace {

/// A column of plates, a metre wide and 0.2 high, four points at each joint, that a blow on its top
/// drives askew into the floor.
struct StruckColumn {
  std::vector<DofBlock> blocks;
  std::vector<ImpactPoint> points;

  StruckColumn(Random& r, uint32_t n) {
    for (uint32_t i = 0; i < n; ++i) {
      DofBlock b;
      b.inverse_mass = 1 / r.uniform(0.5, 2);
      b.inverse_inertia = (b.inverse_mass * Vec3(11.5, 6, 11.5)).asDiagonal();
      blocks.push_back(b);
      for (const double x : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5}) {
          ImpactPoint p;
          p.a = i == 0 ? no_block : i - 1, p.b = i;
          if (i > 0) p.arm_a = {x, 0.1, z};
          p.arm_b = {x, -0.1, z};
          p.friction = r.uniform(0.2, 0.8);
          points.push_back(p);
        }
    }
    blocks.back().v = {r.uniform(-1, 1), -2, r.uniform(-1, 1)};
    blocks.back().omega = {r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)};
  }
};

}  // namespace

TEST_CASE("many points at once, solved body by body, keep every condition of a collision") {
  Random r(3);
  for (int k = 0; k < 20; ++k) {
    StruckColumn column(r, 9);
    CAPTURE(k);
    const double before = kinetic_energy(column.blocks);
    const ImpactReport report =
        law("simultaneous_newton")(column.blocks, column.points, Articulation{});
    REQUIRE(report.status == ImpactStatus::solved);
    CHECK(report.residual <= 1e-9);
    CHECK(kinetic_energy(column.blocks) - before == doctest::Approx(report.work).epsilon(1e-9));
    CHECK(report.work < 0);
    for (size_t i = 0; i < column.points.size(); ++i) {
      const ImpactPoint& p = column.points[i];
      const Vec3 push = report.impulses[i], u = report.velocity_after[i];
      const double normal = p.normal.dot(push), rate = p.normal.dot(u);
      const Vec3 slip = u - rate * p.normal, lateral = push - normal * p.normal;
      CHECK(rate > -1e-8);
      CHECK(normal >= -1e-8);
      CHECK(std::min(rate, normal) < 1e-8);
      CHECK(lateral.norm() <= p.friction * normal + 1e-8);
      if (slip.norm() > 1e-6)
        CHECK(lateral.dot(slip) <= -p.friction * normal * slip.norm() + 1e-7 * slip.norm());
    }
  }
}

TEST_CASE("points answer to those of the same bodies only, as the matrix of all their rows says") {
  for (const uint32_t n : {2u, 10u, 50u}) {
    const std::vector<DofBlock> balls(n, ball(1, Vec3::Zero()));
    std::vector<Row> rows;
    for (const ImpactPoint& p : wedged_row(n, 0)) {
      Vec3 s, t;
      tangent_frame(p.normal, s, t);
      for (const Vec3& axis : {p.normal, s, t})
        rows.push_back(point_row(p.a, p.arm_a, p.b, p.arm_b, axis));
    }
    const PointMobility mobility(rows, balls, {});
    REQUIRE(mobility.points() == int(n + 1));
    CHECK(mobility.size() == 3 * n + 1);  // itself and two others, but one at the ends
    std::vector<Eigen::Index> all(rows.size());
    std::iota(all.begin(), all.end(), 0);
    const Eigen::MatrixXd A = delassus(rows, balls);
    CHECK(mobility.dense(all) == A);
    const std::vector<Eigen::Index> some{1, 3, 4, Eigen::Index(rows.size()) - 1};
    CHECK(mobility.dense(some) == A(some, some));
    Eigen::VectorXd once = Eigen::VectorXd::Zero(A.rows()), both = once;
    mobility.add_product(1, {1, -2, 3}, once);
    mobility.add_product(Eigen::VectorXd::Unit(A.rows(), 4), both);
    CHECK(once == A.col(3) - 2 * A.col(4) + 3 * A.col(5));
    CHECK(both == A.col(4));
  }
}
