// What is said of the motion of one shape of a body: bounds that the broad phase, the contacts and
// the continuous stage rely on. Reference: points of the shape, followed densely.
#include "engine/collision/motion.hpp"
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/contact/cached_pair.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/piles.hpp"
#include "tests/dynamics/rigid_world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double h = 1.0 / 60;

Vec3 vector_in(Random& r, double size) {
  const double x = r.uniform(-size, size), y = r.uniform(-size, size);
  return {x, y, r.uniform(-size, size)};
}

Vec3 direction_in(Random& r) {
  Vec3 d = vector_in(r, 1);
  while (d.norm() < 0.1) d = vector_in(r, 1);
  return d.normalized();
}

/// A body of one to four boxes around its centre of mass, turning by up to `angle` in a tick.
RigidBody spinning(Random& r, double angle) {
  BodyDef def;
  const int shapes = 1 + int(r.uniform(0, 4));
  for (int i = 0; i < shapes; ++i) {
    BodyDef one =
        body(box(r.uniform(0.05, 0.3), r.uniform(0.05, 0.3), r.uniform(0.05, 0.3)), Vec3::Zero());
    one.shapes[0].pose = {vector_in(r, 0.8), axis_angle(direction_in(r), r.uniform(0, 3))};
    def.shapes.push_back(one.shapes[0]);
  }
  RigidBody out = *make_body(def);
  out.pose = {vector_in(r, 3), axis_angle(direction_in(r), r.uniform(0, 3))};
  out.v = vector_in(r, 4);
  out.omega = direction_in(r) * (angle * r.uniform(0.2, 1) / h);
  return out;
}

Pose after(const RigidBody& body, double t) {
  const double speed = body.omega.norm();
  return {body.pose.x + t * body.v, axis_angle(body.omega / speed, speed * t) * body.pose.q};
}

std::vector<Vec3> corners_of(const BodyShape& s) {
  const Vec3 half = s.shape->def().half_extents;
  std::vector<Vec3> out;
  for (unsigned k = 0; k < 8; ++k)
    out.push_back(s.pose.point({k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(),
                                k & 4 ? half.z() : -half.z()}));
  return out;
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = d.squaredNorm() > 0 ? std::clamp(d.dot(p - a) / d.squaredNorm(), 0.0, 1.0) : 0;
  return (p - (a + t * d)).norm();
}

}  // namespace

TEST_CASE("no point leaves what turning is said to do to its shape, and bounds hold all of it") {
  Random r(31);
  double tightest = 0, tightest_off_centre = 0;
  for (int k = 0; k < scaled(400, 40); ++k) {
    const RigidBody body = spinning(r, std::pow(10, r.uniform(-3, 1)));
    ProxySet proxies;
    update_proxies(std::span(&body, 1), Vec3::Zero(), h, 0, proxies);
    REQUIRE(proxies.proxies.size() == 1);
    const Aabb bounds = proxies.proxies[0].bounds.inflated(1e-12);
    for (size_t s = 0; s < body.shapes.size(); ++s) {
      const ShapeTurning turning = shape_turning(body, body.shapes[s], h);
      double farthest = 0, travel = 0;
      for (const Vec3& x : corners_of(body.shapes[s])) {
        for (int i = 0; i <= 40; ++i) {
          const double t = h * i / 40;
          const Vec3 now = after(body, t).point(x);
          const Vec3 carried = body.pose.point(x) + t * (body.v + turning.velocity);
          farthest = std::max(farthest, (now - carried).norm());
          travel = std::max(travel, (now - body.pose.point(x) - t * body.v).norm());
          CHECK(bounds.contains(now));
        }
      }
      CHECK(farthest <= turning.reach * (1 + 1e-12));
      tightest = std::max(tightest, farthest / turning.reach);
      if (body.shapes[s].pose.x.norm() > 0.6)
        tightest_off_centre = std::max(tightest_off_centre, travel / turning.reach);
    }
  }
  CHECK(tightest > 0.8);
  CHECK(tightest_off_centre > 2);  // what is carried along needs no reach
}

TEST_CASE("a point that turns and moves on leaves its chord by less than the height of the arc") {
  Random r(32);
  double tightest = 0;
  for (int k = 0; k < scaled(400, 40); ++k) {
    const double angle = r.uniform(0.01, 2 * std::numbers::pi);
    const RigidBody body = spinning(r, angle);
    const Vec3 x = vector_in(r, 1);
    const double height = arc_height(body.omega.norm() * h, x.norm());
    const Vec3 begin = body.pose.point(x), end = after(body, h).point(x);
    double farthest = 0;
    for (int i = 0; i <= 60; ++i)
      farthest =
          std::max(farthest, distance_to_segment(after(body, h * i / 60).point(x), begin, end));
    CHECK(farthest <= height * (1 + 1e-12));
    tightest = std::max(tightest, farthest / height);
  }
  CHECK(tightest > 0.8);
}

TEST_CASE("a shape moves against another by no more than is said, wherever it is on its body") {
  Random r(33);
  double tightest = 0, of_body = 0;
  for (int k = 0; k < scaled(400, 40); ++k) {
    std::array<RigidBody, 2> bodies{spinning(r, 0.02), spinning(r, 0.02)};
    const auto side = [&](uint32_t i) {
      const auto last = uint32_t(bodies[i].shapes.size()) - 1;
      return shape_side(bodies, {i, last}, {Vec3::Zero(), h, 0.02});
    };
    const PairSide a = side(0), b = side(1);
    const CachedPair seen = look_at({}, a, b, 1);
    const bool a_smaller = a.shape_radius < b.shape_radius;
    const auto &small = bodies[a_smaller ? 0 : 1], &large = bodies[a_smaller ? 1 : 0];
    const auto seen_from_large = [&](const Vec3& x) {
      return large.pose.inverse_point(small.pose.point(x));
    };
    const std::vector<Vec3> corners = corners_of(small.shapes.back());
    std::vector<Vec3> before;
    for (const Vec3& x : corners) before.push_back(seen_from_large(x));
    for (RigidBody& body : bodies) body.pose = after(body, h);
    double travel = 0;
    for (size_t i = 0; i < corners.size(); ++i)
      travel = std::max(travel, (seen_from_large(corners[i]) - before[i]).norm());
    const double said = moved_since(seen, side(0), side(1));
    CHECK(travel <= said * (1 + 1e-9));
    tightest = std::max(tightest, travel / said);
    of_body = std::max(of_body, small.bounding_radius / std::min(a.shape_radius, b.shape_radius));
  }
  CHECK(tightest > 0.9);
  CHECK(of_body > 3);  // shapes that are small beside their bodies were among them
}

namespace {

/// Of 21 boxes side by side along x.
BodyDef rod_of_boxes(const Vec3& half) {
  BodyDef rod;
  for (int i = -10; i <= 10; ++i) {
    BodyDef piece = body(box(half.x(), half.y(), half.z()), Vec3::Zero());
    piece.shapes[0].pose.x.x() = 2 * half.x() * i;
    rod.shapes.push_back(piece.shapes[0]);
  }
  return rod;
}

/// Two small boxes on opposite sides of their common centre, 1.8 m from it.
BodyDef dumbbell(double angle) {
  BodyDef out = body(box(0.05, 0.02, 0.05), Vec3::Zero());
  out.shapes.push_back(out.shapes[0]);
  out.shapes[0].pose.x.x() = 1.8;
  out.shapes[1].pose.x.x() = -1.8;
  out.pose.q = axis_angle(Vec3::UnitZ(), angle);
  return out;
}

double angle_of(const RigidBody& body) {
  return 2 * std::atan2(body.pose.q.z(), body.pose.q.w());
}

}  // namespace

TEST_CASE("the end of a spinning body of many shapes does not cut through a plate") {
  for (const double speed : {25.0, 40.0}) {
    RigidWorld w;
    w.gravity.setZero();
    BodyDef rod = rod_of_boxes({0.1, 0.02, 0.02});
    rod.angular_velocity = {0, 0, speed};
    const uint32_t i = w.add(rod);
    w.fixed(box(0.3, 0.0005, 0.3), {1.6, 0.9, 0});
    double turned = 0, least = speed;
    while (turned < 0.5 * std::numbers::pi) {  // the plate stands in the way after 29 degrees
      least = std::min(least, w.bodies[i].omega.z());
      if (least < 0.8 * speed) break;
      w.step();
      turned += speed * h;
    }
    CHECK(least < 0.8 * speed);
  }
}

TEST_CASE("what is met on the arc and not between its ends stops a body") {
  for (const BroadPhaseEntry& phase : all_broad_phases()) {
    CAPTURE(phase.name);
    // The second winds: from end to end it is nearer the other way round.
    for (const double half_way : {1.0, 1.45}) {
      RigidWorld w(60, 1, phase.name);
      w.gravity.setZero();
      BodyDef def = dumbbell(-half_way);
      def.angular_velocity = {0, 0, 2 * half_way / h};
      const uint32_t i = w.add(def);
      w.fixed(box(0.1, 0.0005, 0.3), {1.8, 0, 0});
      w.step();
      CHECK(angle_of(w.bodies[i]) < 0.05);
      CHECK(angle_of(w.bodies[i]) > -0.1);
    }
  }
}

TEST_CASE("a rod of boxes does not pass over small balls in its way") {
  for (int k = 0; k <= 12; ++k) {
    CAPTURE(k);
    RigidWorld w;
    w.gravity.setZero();
    BodyDef rod = rod_of_boxes({0.1, 0.005, 0.005});
    rod.angular_velocity = {0, 0, 6};
    const uint32_t i = w.add(rod);
    std::vector<uint32_t> balls;
    for (int n = 0; n < 5; ++n)
      balls.push_back(w.add(body(sphere(0.01), {0.28 + 0.3 * n, 0.0155 + 0.0025 * k, 0})));
    for (int t = 0; t < 10; ++t) {
      w.step();
      for (const uint32_t ball : balls)
        CHECK(w.bodies[i].pose.inverse_point(w.bodies[ball].pose.x).y() > 0.01);
    }
  }
}

TEST_CASE("a floor that rises catches a ball that falls fast") {
  for (const BroadPhaseEntry& phase : all_broad_phases()) {
    CAPTURE(phase.name);
    for (const double height : {0.3, 0.55, 0.8}) {
      RigidWorld w(60, 1, phase.name);
      BodyDef floor = body(half_space(), Vec3::Zero());
      floor.type = BodyType::kinematic;
      floor.velocity = {0, 1, 0};
      const uint32_t f = w.add(floor);
      BodyDef ball = body(sphere(0.05), {0, height, 0});
      ball.velocity = {0, -60, 0};
      const uint32_t b = w.add(ball);
      for (int t = 0; t < 10; ++t) {
        w.step();
        CHECK(w.bodies[b].pose.x.y() > w.bodies[f].pose.x.y());
      }
    }
  }
}
