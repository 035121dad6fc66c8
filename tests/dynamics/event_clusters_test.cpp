// Clusters of the event stepper: groups whose bodies are not tied together go through a tick in
// windows. Reference: the same group as a whole (tested in event_stepper_test.cpp), whose steps are
// others, so that motions agree to the integrator's error; and displacements of points one by one.
#include "engine/core/random.hpp"
#include "engine/dynamics/event/body_clusters.hpp"
#include "engine/dynamics/event/reach.hpp"
#include "engine/dynamics/event/turning.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr size_t nobody = 0, everybody = 1000;

Vec3 random_vector(Random& random, double most) {
  return {random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most)};
}

double farthest_apart(const EventWorld& a, const EventWorld& b) {
  double apart = 0;
  for (size_t i = 0; i < a.bodies.size(); ++i) {
    const Pose &p = a.bodies[i].pose, &q = b.bodies[i].pose;
    for (const Vec3& r : {Vec3(0, 0, 0), Vec3(0, 0.1, 0)})
      apart = std::max(apart, (p.point(r) - q.point(r)).norm());
  }
  return apart;
}

/// Runs a world as clusters, and as a whole at a quarter of the tick. Gives how far centres, and
/// points beside them on the y axes of bodies, are apart at the end [m].
template <class Fill>
double clusters_against_whole(double hz, double seconds, const Fill& fill) {
  EventWorld parts(hz), whole(4 * hz);
  parts.max_untied_bodies = nobody;
  whole.max_untied_bodies = everybody;
  for (EventWorld* w : {&parts, &whole}) {
    fill(*w);
    w->run(seconds);
  }
  CHECK(parts.windows > 0);
  CHECK(whole.windows == 0);
  CHECK(parts.deepest < 1e-5);
  return farthest_apart(parts, whole);
}

/// Balls that fly about above everything else.
void add_flock(EventWorld& w, int count, double y) {
  for (int i = 0; i < count; ++i) {
    BodyDef d = body(sphere(0.05), {0.3 * i - 0.6, y, 0.1 * i}, 0.3, 0.5);
    d.velocity = {3, 1 + 0.5 * i, -2};
    d.angular_velocity = {5, 0, 3.0 * i};
    w.add(d);
  }
}

}  // namespace

TEST_CASE("clusters: bodies that nothing ties to the rest of their cluster are counted") {
  BodyClusters c;
  c.reset(8);
  c.tie(5, 1);
  c.tie(5, 3);
  c.tie(6, 7);
  CHECK(c.strangers_of(1) == 0);
  c.meet(7, 0);
  CHECK(c.strangers_of(0) == 1);
  c.meet(1, 3);
  CHECK(c.strangers_of(1) == 0);
  c.meet(3, 0);  // 1, 3, 5 with 0 and 6, 7
  CHECK(c.strangers_of(0) == 3);
  CHECK(c.crowded(0, 2));
  CHECK(!c.crowded(0, 3));
  CHECK(c.first(7) == 0);
  CHECK(c.first(5) == 0);
  CHECK(c.first(4) == 4);
  CHECK(c.first(2) == 2);
}

TEST_CASE("clusters: a few beside many that are tied together are no crowd") {
  BodyClusters c;
  c.reset(20);
  for (uint32_t i = 1; i < 12; ++i) c.tie(0, i);
  for (uint32_t i = 12; i < 18; ++i) c.meet(0, i);
  CHECK(!c.crowded(0, 4));  // 6 beside 12
  c.meet(0, 18);
  CHECK(c.crowded(0, 4));
}

TEST_CASE("clusters: no point of a body goes farther than its reach says, and needles may spin") {
  Random random(5);
  for (int n = 0; n < 300; ++n) {
    const Vec3 half(random.uniform(0.01, 0.5), random.uniform(0.01, 0.5),
                    random.uniform(0.01, 0.5));
    RigidBody b = *make_body(body(box(half.x(), half.y(), half.z()), random_vector(random, 2)));
    b.pose.q = integrate_rotation(b.pose.q, random_vector(random, 2), 1);
    b.v = random_vector(random, 3);
    b.omega = random_vector(random, 20);
    const double h = 0.01;
    const BodyReach reach = guess_reach(b, box_about(b), 0, h, h);
    const Pose start = b.pose;
    b.pose.x += h * b.v;
    b.pose.q = integrate_rotation(b.pose.q, b.omega, h);
    double most = 0;
    for (int k = 0; k < 8; ++k) {
      const Vec3 r = half.cwiseProduct(Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
      most = std::max(most, (b.pose.point(r) - start.point(r)).norm());
    }
    CHECK(most <= displacement_bound(b, reach) * (1 + 1e-12));
    CHECK(displacement_bound(b, reach) <= reach.distance);
  }
  RigidBody needle = *make_body(body(capsule(0.002, 0.3), {0, 0, 0}));
  needle.omega = {0, 5000, 0};
  CHECK(guess_reach(needle, box_about(needle), 0, 1e-4, 1).distance < 0.0015);
}

TEST_CASE("clusters: two rows of balls pass on their impulses as one group does") {
  const auto rows = [](EventWorld& w) {
    w.gravity.setZero();
    for (int row = 0; row < 2; ++row) {
      for (int i = 0; i < 4; ++i) w.add(body(sphere(0.1), {0.2 * i, 0, 0.4 * row}, 0, 1));
      BodyDef d = body(sphere(0.1), {-0.6 - 0.1 * row, 0, 0.4 * row}, 0, 1);
      d.velocity = {6, 0, 0};
      w.add(d);
    }
  };
  CHECK(clusters_against_whole(10, 0.3, rows) < 1e-9);
}

TEST_CASE("clusters: what is shot farther than foreseen meets what is there, as in one group") {
  const auto shot = [](EventWorld& w) {
    w.gravity.setZero();
    w.fixed(box(0.1, 5, 5), {3.1, 0, 0}, 0, 1);
    BodyDef heavy = body(sphere(0.1), {-0.3, 0, 0}, 0, 1);
    heavy.mass = 100;
    heavy.velocity = {20, 0, 0};
    w.add(heavy);
    for (const double x : {0.0, 0.9, 2.2}) {
      BodyDef light = body(sphere(0.1), {x, 0, 0}, 0, 1);
      light.mass = 1 + x;
      w.add(light);
    }
    add_flock(w, 5, 1.1);
  };
  CHECK(clusters_against_whole(10, 0.2, shot) < 1e-7);
}

TEST_CASE("clusters: a gap that was looked at long ago has shrunk since") {
  // The light ball is hit in the second half of the tick, when the other has come a metre nearer.
  const auto meeting = [](EventWorld& w) {
    w.gravity.setZero();
    const auto ball = [&](double x, double mass, double speed) {
      BodyDef d = body(sphere(0.1), {x, 0, 0}, 0, 1);
      d.mass = mass;
      d.velocity = {speed, 0, 0};
      w.add(d);
    };
    ball(-0.61, 100, 8);
    ball(0, 1, 0);
    ball(2.4, 1, -20);
    add_flock(w, 5, 1.1);
  };
  CHECK(clusters_against_whole(10, 0.1, meeting) < 1e-7);
}

TEST_CASE("clusters: a ball hits a standing column while others fly, as in one group") {
  const auto column = [](EventWorld& w) {
    w.floor(0.5);
    for (int i = 0; i < 3; ++i) w.add(body(box(0.2, 0.1, 0.2), {0, 0.1 + 0.2 * i, 0}, 0));
    BodyDef d = body(sphere(0.1), {-0.75, 0.5, 0}, 0);
    d.velocity = {5, 0, 0};
    d.mass = 1;
    w.add(d);
    add_flock(w, 5, 1.1);
  };
  CHECK(clusters_against_whole(20, 0.2, column) < 1e-6);
}

TEST_CASE("clusters: a needle meets a pane, and what flies beside it does not disturb it") {
  const auto pane = [](EventWorld& w) {
    TriangleMesh sheet;
    sheet.vertices = {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    w.fixed(mesh(std::move(sheet)), Vec3::Zero(), 0.2, 0.1);
    BodyDef d = body(capsule(0.0025, 0.3), {0.5, 0, 0}, 0.3, 0.1);
    d.velocity = {28, 12, 4};
    d.angular_velocity = {80, 150, -90};
    w.add(d);
    add_flock(w, 5, -0.4);
  };
  CHECK(clusters_against_whole(240, 0.025, pane) < 1e-5);
}

TEST_CASE("clusters: joints hold in a crowd that is cut again and again, as in one group") {
  const auto crowd = [](EventWorld& w) {
    w.gravity.setZero();
    // A spinning dumbbell in a swarm that goes its way: they may meet within the tick, and do not.
    for (const double x : {-0.5, 0.5}) {
      BodyDef d = body(box(0.1, 0.05, 0.05), {x, 0, 0}, 0, 1);
      d.velocity = {10, 0, 40 * x};
      d.angular_velocity = {0, -40, 0};
      w.add(d);
    }
    w.join(JointKind::spherical, 0, 1, {Vec3::Zero(), Quat::Identity()});
    for (int i = 0; i < 30; ++i) {
      BodyDef d = body(sphere(0.05), {0.4 * (i % 6 - 2.5), 0.8 + 0.4 * double(i / 6), 0}, 0, 1);
      d.velocity = {10, 0, 0};
      w.add(d);
    }
  };
  CHECK(clusters_against_whole(20, 0.1, crowd) < 1e-6);
}

TEST_CASE("clusters: the same bits for 1 and 4 threads") {
  std::vector<std::vector<RigidBody>> ends;
  for (const int threads : {1, 4}) {
    EventWorld w(60, threads);
    w.floor(0.4, 0.3);
    Random random(3);
    for (int i = 0; i < 14; ++i) {
      const Vec3 x{random.uniform(-0.5, 0.5), 0.3 + 0.25 * i, random.uniform(-0.5, 0.5)};
      BodyDef d = body(i % 2 ? sphere(0.12) : box(0.15, 0.1, 0.12), x, 0.4, 0.3);
      d.angular_velocity = random_vector(random, 5);
      d.velocity = random_vector(random, 2);
      w.add(d);
    }
    w.run(0.5);
    CHECK(w.windows > 0);
    ends.push_back(w.bodies);
  }
  for (size_t i = 0; i < ends[0].size(); ++i) {
    CHECK(ends[0][i].pose.x == ends[1][i].pose.x);
    CHECK(ends[0][i].pose.q.coeffs() == ends[1][i].pose.q.coeffs());
    CHECK(ends[0][i].v == ends[1][i].v);
    CHECK(ends[0][i].omega == ends[1][i].omega);
  }
}

TEST_CASE("how fast a body's points go along a normal, against the corners of its box") {
  Random random(9);
  for (int trial = 0; trial < 200; ++trial) {
    RigidBody b;
    const Vec3 half(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1));
    b.bounding_radius = half.norm();
    b.pose.q = Quat(1, random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    b.pose.q.normalize();
    b.omega = random_vector(random, 10);
    const Vec3 n = random_vector(random, 1).normalized();
    double fastest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 r(corner & 1 ? half.x() : -half.x(), corner & 2 ? half.y() : -half.y(),
                   corner & 4 ? half.z() : -half.z());
      fastest = std::max(fastest, n.dot(b.omega.cross(b.pose.direction(r))));
    }
    CHECK(turning_speed_along(b, half, n) == doctest::Approx(fastest).epsilon(1e-12));
    b.omega = b.omega.norm() * n;
    CHECK(turning_speed_along(b, half, n) < 1e-12 * b.omega.norm());
  }
}

TEST_CASE("a thin plate that spins on a floor without friction takes the steps of its turning") {
  // 40 rad/s turn it by two thirds of a radian a tick: three steps of at most a quarter.
  constexpr double spin = 40;
  std::vector<uint64_t> steps;
  for (const double friction : {0.0, 0.5}) {
    EventWorld w;
    w.floor(friction);
    BodyDef d = body(box(0.4, 0.02, 0.3), {0, 0.02, 0}, friction);
    d.angular_velocity = {0, spin, 0};
    const uint32_t plate = w.add(d);
    w.step();
    steps.push_back(w.stepper.stats.steps);
    if (friction > 0) continue;
    for (int i = 1; i < 60; ++i) {
      w.step();
      CHECK(w.stepper.stats.steps == 3);
    }
    CHECK((w.bodies[plate].omega - Vec3(0, spin, 0)).norm() < 1e-9 * spin);
    const Vec3 along = w.bodies[plate].pose.direction(Vec3::UnitX());
    CHECK((along - Vec3(std::cos(spin), 0, -std::sin(spin))).norm() < 1e-3);
  }
  CHECK(steps[1] > 3 * steps[0]);  // friction goes with how they pass
}
