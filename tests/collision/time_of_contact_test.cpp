// References: closed forms (two balls, a ball and a plane, a box and a plane without turning), fine
// sampling of the lowest corner of a spinning box, and the narrow phase for "never past contact".
#include "engine/collision/time_of_contact.hpp"

#include "engine/collision/narrow_phase.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/time_of_contact_reference.hpp"

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double tolerance = 1e-5;

}  // namespace

TEST_CASE("a motion between two poses ends at the second") {
  Random r(20);
  for (int i = 0; i < cases(500); ++i) {
    const Pose from{random_vec(r, -5, 5), random_rotation(r)},
        to{random_vec(r, -5, 5), random_rotation(r)};
    const Motion m = Motion::between(from, to, 0.25, 0.5);
    CHECK((m.pose(0.5).x - to.x).norm() < 1e-12);
    CHECK(m.pose(0.5).q.angularDistance(to.q) < 1e-7);
    CHECK(m.omega.norm() * 0.25 <= det::pi * (1 + 1e-12));
  }
}

TEST_CASE("two balls meet when the quadratic says so") {
  Random r(21);
  int hits = 0;
  const int n = cases(2000);
  for (int i = 0; i < n; ++i) {
    const double ra = r.uniform(0.1, 0.5), rb = r.uniform(0.1, 0.5);
    const Pose pa{random_vec(r, -3, 3), random_rotation(r)},
        pb{random_vec(r, -3, 3), random_rotation(r)};
    const Vec3 va = random_vec(r, -2, 2);
    const Vec3 vb = va + (pa.x - pb.x) * r.uniform(0.2, 2) + random_vec(r, -0.8, 0.8);
    const Vec3 x = pb.x - pa.x, v = vb - va;
    if (x.norm() < ra + rb + 1e-3) continue;
    const double A = v.squaredNorm(), B = x.dot(v), C = x.squaredNorm() - (ra + rb) * (ra + rb);
    const double disc = B * B - A * C;
    const double exact = disc > 0 && B < 0 ? (-B - std::sqrt(disc)) / A : 1e9;
    const double closest = B < 0 ? (x - v * (B / A)).norm() - ra - rb : 1;
    const auto toc =
        time_of_contact(*sphere(ra), motion_for(pa, va, random_vec(r, -5, 5), 1), *sphere(rb),
                        motion_for(pb, vb, random_vec(r, -5, 5), 1), tolerance);
    if (std::abs(closest) < 1e-3 || std::abs(exact - 1) < 1e-3) continue;  // grazing or late
    REQUIRE(toc.hit() == (exact < 1));
    if (!toc.hit()) continue;
    ++hits;
    CHECK(toc.time <= exact);
    CHECK(toc.distance_low > 0);
    CHECK(toc.distance_low <= tolerance);
    CHECK((x + v * toc.time).norm() - ra - rb <= tolerance * 1.01);
    CHECK(toc.low <= exact);
    if (toc.distance_high <= 0) CHECK(toc.high >= exact);
  }
  if (n >= 100) CHECK((hits > 0.3 * n && hits < 0.9 * n));
}

TEST_CASE("a spinning box meets a plane where fine sampling of its corners does") {
  Random r(22);
  for (int i = 0; i < cases(100); ++i) {
    const Vec3 h = random_vec(r, 0.1, 0.6), omega = random_vec(r, -10, 10);
    const auto b = box(h), ground = half_space();
    const Motion m =
        motion_for({{0, r.uniform(1.2, 2), 0}, random_rotation(r)}, {0, -2, 0}, omega, 1);
    const auto lowest = [&](double t) {
      const Mat3 R = m.pose(t).q.toRotationMatrix();
      return m.pose(t).x.y() - R.row(1).cwiseAbs().dot(h);
    };
    double exact = -1;
    const int steps = 20000;
    for (int k = 0; k < steps && exact < 0; ++k)
      if (lowest(double(k) / steps) <= 0) exact = double(k) / steps;
    const auto toc = time_of_contact(*ground, Motion::at_rest({}, 0, 1), *b, m, tolerance);
    REQUIRE(toc.hit() == (exact >= 0));
    if (!toc.hit()) continue;
    CHECK(toc.time <= exact);
    CHECK(lowest(toc.time) > 0);
    CHECK(lowest(toc.time) <= tolerance);
    // the same with the plane given second, and with a large slab in its place
    const auto swapped = time_of_contact(*b, m, *ground, Motion::at_rest({}, 0, 1), tolerance);
    CHECK(swapped.time == toc.time);
    CHECK((swapped.normal + toc.normal).norm() < 1e-12);
    const auto slab = box({10, 1, 10});
    const auto on_slab = time_of_contact(
        *slab, Motion::at_rest({{0, -1, 0}, Quat::Identity()}, 0, 1), *b, m, tolerance);
    REQUIRE(on_slab.hit());
    CHECK(std::abs(on_slab.time - toc.time) < 2e-5);
  }
}

TEST_CASE("convex pairs with rotation: apart at the answer, within the tolerance") {
  Random r(23);
  const std::vector<std::shared_ptr<const Shape>> shapes{capsule(0.1, 1.2),
                                                         box({0.02, 0.8, 0.1}),
                                                         cylinder(0.4, 0.1),
                                                         random_hull(r, 16, {0.5, 0.3, 0.2}),
                                                         ellipsoid({0.6, 0.1, 0.3}),
                                                         cone(0.4, 0.5),
                                                         tapered_capsule(0.3, 0.05, 0.6)};
  int hits = 0;
  const int n = cases(400);
  for (int i = 0; i < n; ++i) {
    const auto& a = shapes[r.below(uint32_t(shapes.size()))];
    const auto& b = shapes[r.below(uint32_t(shapes.size()))];
    const Motion ma = motion_for({random_vec(r, -0.3, 0.3), random_rotation(r)},
                                 random_vec(r, -1, 1), random_vec(r, -20, 20), 0.5);
    const Motion mb = motion_for({random_direction(r) * 3, random_rotation(r)}, Vec3::Zero(),
                                 random_vec(r, -20, 20), 0.5);
    Motion mc = mb;
    mc.velocity = -mb.start.x * 4 + random_vec(r, -1, 1);
    const auto toc = time_of_contact(*a, ma, *b, mc, tolerance);
    REQUIRE(toc.status != TimeOfContactStatus::max_iterations);
    const double end = toc.time;
    // never in contact before
    for (int k = 0; k <= 50; ++k) {
      std::vector<Manifold> out;
      const double t = end * k / 50;
      collide(*a, ma.pose(t), *b, mc.pose(t), 0, out);
      CHECK(out.empty());
    }
    if (!toc.hit()) continue;
    ++hits;
    CHECK((toc.on_a - toc.on_b).norm() <= 1.1 * tolerance);
    std::vector<Manifold> out;
    collide(*a, ma.pose(end), *b, mc.pose(end), 2 * tolerance, out);
    CHECK(!out.empty());
  }
  if (n >= 100) CHECK((hits > 0.3 * n && hits < 0.98 * n));
}

TEST_CASE("a bullet does not cross a thin wall of any kind") {
  const auto ball = sphere(0.01);
  const auto thin_box = box({1, 1, 5e-5});
  const auto thin_mesh = mesh(make_mesh::box({1, 1, 5e-5}));
  const auto sheet = mesh(make_mesh::terrain(2, 16, [](double, double) { return 0.0; }));
  const Pose upright{Vec3::Zero(), axis_angle(Vec3::UnitX(), det::pi / 2)};
  const Motion bullet =
      motion_for({{0.1, 0.2, -5}, Quat::Identity()}, {0, 0, 1000}, {0, 0, 30}, 1.0 / 60);
  for (const auto& [wall, pose] :
       {std::pair{thin_box, Pose{}}, {thin_mesh, Pose{}}, {sheet, upright}}) {
    const Motion still = Motion::at_rest(pose, 0, 1.0 / 60);
    const auto toc = time_of_contact(*wall, still, *ball, bullet, tolerance);
    REQUIRE(toc.hit());
    const double half = wall == sheet ? 0 : 5e-5;
    CHECK(toc.time == doctest::Approx((5 - 0.01 - half) / 1000).epsilon(1e-5));
    CHECK((toc.normal + Vec3::UnitZ()).norm() < 1e-6);
    // the wall moves, the ball waits
    const Motion wall_moves =
        motion_for({pose.x + Vec3(0, 0, 5), pose.q}, {0, 0, -1000}, Vec3::Zero(), 1.0 / 60);
    const Motion waits = Motion::at_rest({{0.1, 0.2, 0}, Quat::Identity()}, 0, 1.0 / 60);
    const auto other = time_of_contact(*ball, waits, *wall, wall_moves, tolerance);
    REQUIRE(other.hit());
    CHECK(other.time == doctest::Approx(toc.time).epsilon(1e-5));
  }
}

TEST_CASE("a spinning rod is stopped by a mesh wall, and a mesh by a mesh") {
  Random r(24);
  const auto rod = capsule(0.01, 1), torus = mesh(make_mesh::torus(0.4, 0.1, 24, 12));
  const auto wall = mesh(make_mesh::box({3, 3, 5e-4}));
  for (int i = 0; i < cases(40); ++i) {
    for (const auto& thing : {rod, torus}) {
      const Motion m = motion_for({{0, 0, -4}, random_rotation(r)}, {0, 0, 500},
                                  random_vec(r, -100, 100), 1.0 / 60);
      const auto toc = time_of_contact(*wall, Motion::at_rest({}, 0, 1.0 / 60), *thing, m, 1e-4);
      REQUIRE(toc.hit());
      CHECK(m.pose(toc.time).x.z() < 0);
      CHECK(toc.on_b.z() < 0);
      CHECK(toc.on_b.z() == doctest::Approx(-5e-4).epsilon(0.5));
    }
  }
}

TEST_CASE("what starts in contact says so, and is still stopped elsewhere on the same mesh") {
  TriangleMesh room = make_mesh::box({5, 0.5, 5});
  TriangleMesh wall = make_mesh::box({0.001, 2, 2});
  for (Vec3& v : wall.vertices) v += Vec3(2, 2, 0);
  append(room, wall);
  const auto floor = mesh(room);
  const auto b = box({0.1, 0.1, 0.1});
  const Motion still = Motion::at_rest({}, 0, 1.0 / 60);
  const Pose on_floor{{0, 0.6 + 1e-6, 0}, Quat::Identity()};
  auto toc = time_of_contact(*floor, still, *b,
                             motion_for(on_floor, {1, 0, 0}, Vec3::Zero(), 1.0 / 60), 1e-4);
  CHECK(toc.status == TimeOfContactStatus::initially_overlapping);
  toc = time_of_contact(*floor, still, *b,
                        motion_for(on_floor, {400, 0, 0}, Vec3::Zero(), 1.0 / 60), 1e-4);
  REQUIRE(toc.hit());
  CHECK(toc.time == doctest::Approx(1.899 / 400).epsilon(1e-3));
}
