// Boxes that turn and travel: closed-form times, and the exact static test of boxes at sampled
// times, refined by halving (independent of the march; resolution 1e-9 of the interval).
#include "engine/collision/continuous/moving_boxes.hpp"

#include "engine/geometry/primitive_tests/box_pairs.hpp"
#include "engine/math/rotation.hpp"
#include "tests/geometry/draws.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

OrientedBox box_at(const MovingBox& b, double t) {
  const Pose pose = b.motion.pose(t);
  OrientedBox out;
  out.centre = pose.x;
  out.half_axes = pose.q.toRotationMatrix() * b.half_extents.asDiagonal();
  return out;
}

bool overlap_at(const MovingBox& a, const MovingBox& b, double t) {
  return boxes_intersect(box_at(a, t), box_at(b, t));
}

MovingBox moving_box(Vec3 half, Vec3 from, Vec3 velocity, Vec3 omega = Vec3::Zero()) {
  MovingBox b;
  b.half_extents = half;
  b.motion.start.x = from;
  b.motion.velocity = velocity;
  b.motion.omega = omega;
  b.motion.t1 = 1;
  return b;
}

double first_time(const MovingBox& a, const MovingBox& b) {
  const auto c = moving_boxes_contact(a, b).value();
  return c ? c->t_lo : -1;
}

}  // namespace

TEST_CASE("moving boxes: closed forms") {
  const MovingBox unit = moving_box({1, 1, 1}, {0, 0, 0}, {0, 0, 0});
  const auto at = [](double t) { return doctest::Approx(t).epsilon(1e-9); };
  CHECK(first_time(unit, moving_box({1, 1, 1}, {6, 0, 0}, {-8, 0, 0})) == at(0.5));
  CHECK(first_time(unit, moving_box({1, 1, 1}, {6, 2.5, 0}, {-8, 0, 0})) == -1);
  CHECK(first_time(unit, moving_box({1, 1, 1}, {6, 6, 6}, {-8, -8, -8})) == at(0.5));
  CHECK(first_time(unit, moving_box({1, 1, 1}, {2, 0, 0}, {5, 0, 0})) == 0);  // leaves
  CHECK(first_time(unit, unit) == 0);
  CHECK(first_time(unit, moving_box({0, 0, 0}, {3, 0, 0}, {-4, 0, 0})) == at(0.5));  // a point
  CHECK(first_time(unit, moving_box({0, 9, 0}, {3, 0, 0}, {-4, 0, 0})) == at(0.5));  // a segment
  // A rod of half length 3 turns about the origin, at pi per second: its end reaches the height of
  // a thin plate at x = 3 sin(a) = 1.5, a = 30 degrees.
  const double pi = 3.141592653589793;
  const MovingBox rod = moving_box({0, 3, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, -pi});
  CHECK(first_time(rod, moving_box({0, 9, 9}, {1.5, 0, 0}, {0, 0, 0})) == at(1.0 / 6));
  CHECK(first_time(rod, moving_box({0, 9, 9}, {3.001, 0, 0}, {0, 0, 0})) == -1);
  // Spinning fast beside it: never, and not reported.
  const MovingBox top = moving_box({1, 1, 1}, {0, 0, 0}, {0, 0, 0}, {0, 200, 0});
  CHECK(first_time(top, moving_box({1, 1, 1}, {2.6, 0, 0}, {0, 0, 0})) == -1);
  // Far from the origin and at other scales.
  for (const double scale : {1e-9, 1e-3, 1e6}) {
    const Vec3 away = scale * 1e4 * Vec3(1, -2, 3);
    CHECK(first_time(moving_box(Vec3::Constant(scale), away, {0, 0, 0}),
                     moving_box(Vec3::Constant(scale), away + Vec3(6 * scale, 0, 0),
                                {-8 * scale, 0, 0})) == doctest::Approx(0.5).epsilon(1e-8));
  }
}

TEST_CASE("moving boxes: the static test at sampled times") {
  Random r(17);
  const int n = draws::count(600);
  int contacts = 0, certain = 0;
  for (int i = 0; i < n; ++i) {
    MovingBox a, b;
    const Vec3 apart = r.uniform(1.5, 5) * draws::direction(r);
    for (MovingBox* box : {&a, &b}) {
      const bool thin = r.below(4) == 0;
      for (int k = 0; k < 3; ++k) {
        box->half_extents[k] = thin && k == 0 ? 1e-4 : r.uniform(0.1, 1);
      }
      Motion& m = box->motion;
      m.start.q = draws::rotation(r);
      m.omega = r.uniform(0, 8) * draws::direction(r);
      m.t0 = 3;
      m.t1 = 4;
      if (r.below(2)) m.offset = {draws::in_box(r, 0.3), draws::rotation(r)};
    }
    b.motion.start.x = apart;
    b.motion.velocity = -r.uniform(0.2, 1.5) * apart + draws::in_box(r, 1);
    const auto c = moving_boxes_contact(a, b).value();
    const double until = c ? c->t_lo - 1e-11 : 4;
    constexpr int samples = 100;
    for (int k = 0; k <= samples && until >= 3; ++k) {
      REQUIRE_FALSE(overlap_at(a, b, 3 + (until - 3) * k / samples));
    }
    if (!c) continue;
    ++contacts;
    certain += c->certain;
    REQUIRE(c->t_lo <= c->t_hi);
    REQUIRE(std::fabs(c->normal.norm() - 1) < 1e-9);
    if (c->certain && c->t_hi > 3) {
      REQUIRE(c->t_hi - c->t_lo < 1e-6);
      REQUIRE(overlap_at(a, b, std::min(4.0, c->t_hi + 1e-11)));
    }
  }
  MESSAGE(n, " pairs, ", contacts, " meet, ", certain, " certain");
  if (n >= 500) {
    CHECK(contacts > n / 5);
    CHECK(contacts < n * 9 / 10);
    CHECK(certain > contacts * 0.95);
  }
}

TEST_CASE("moving boxes: what is refused") {
  const MovingBox good = moving_box({1, 1, 1}, {0, 0, 0}, {0, 0, 0});
  MovingBox bad = good;
  bad.half_extents.x() = -1;
  CHECK(!moving_boxes_contact(good, bad));
  bad = good;
  bad.motion.omega.y() = std::numeric_limits<double>::quiet_NaN();
  CHECK(!moving_boxes_contact(bad, good));
  bad = good;
  bad.motion.t1 = 2;
  CHECK(!moving_boxes_contact(good, bad));
  bad = good;
  bad.motion.start.q = Quat(2, 0, 0, 0);
  CHECK(!moving_boxes_contact(good, bad));
}
