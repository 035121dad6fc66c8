// The time of contact in awkward cases, by every method. References: closed forms, the contract
// (finite, in the interval, within the tolerance), and the methods against each other.
#include "engine/collision/time_of_contact.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/math/rotation.hpp"
#include "tests/collision/time_of_contact_answers.hpp"
#include "tests/collision/time_of_contact_reference.hpp"
#include "tests/support/scale.hpp"

#include <cmath>
#include <limits>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

TEST_CASE(
    "at rest, for no time, touching, overlapping, coincident, leaving: every method says so") {
  Random r(306);
  const double tolerance = 1e-5;
  const std::vector<std::shared_ptr<const Shape>> shapes{sphere(0.5),
                                                         capsule(0.3, 0.4),
                                                         box({0.5, 0.5, 0.5}),
                                                         cylinder(0.5, 1),
                                                         ellipsoid({0.5, 0.5, 0.5}),
                                                         cone(0.5, 1),
                                                         tapered_capsule(0.3, 0.3, 0.4),
                                                         hull({{0.5, 0.5, 0.5},
                                                               {-0.5, 0.5, 0.5},
                                                               {0.5, -0.5, 0.5},
                                                               {-0.5, -0.5, 0.5},
                                                               {0.5, 0.5, -0.5},
                                                               {-0.5, 0.5, -0.5},
                                                               {0.5, -0.5, -0.5},
                                                               {-0.5, -0.5, -0.5}}),
                                                         mesh(make_mesh::box({0.5, 0.5, 0.5}))};
  const auto all_are = [&](const Shape& a, const Motion& ma, const Shape& b, const Motion& mb,
                           Toc status) {
    for (const Answer& x : answers(a, ma, b, mb, tolerance)) {
      CAPTURE(x.name);
      check_form(x.toc, ma, tolerance);
      CHECK(to_string(x.toc.status) == to_string(status));
      if (status == Toc::separated) CHECK(x.toc.time == ma.t1);
      if (status == Toc::initially_overlapping) CHECK(x.toc.time == ma.t0);
    }
  };
  for (const auto& a : shapes) {
    for (const auto& b : shapes) {
      // all reach 0.5 above and below
      const auto at = [](double y) { return Pose{{0, y, 0}, Quat::Identity()}; };
      for (const double t1 : {0.0, 1.0}) {
        const Motion below = Motion::at_rest({}, 0, t1);
        all_are(*a, below, *b, Motion::at_rest(at(1.5), 0, t1), Toc::separated);
        all_are(*a, below, *b, Motion::at_rest(at(1 + 2 * tolerance), 0, t1), Toc::separated);
        all_are(*a, below, *b, Motion::at_rest(at(1 + 0.5 * tolerance), 0, t1),
                Toc::initially_overlapping);
        all_are(*a, below, *b, Motion::at_rest(at(1), 0, t1), Toc::initially_overlapping);
        all_are(*a, below, *b, Motion::at_rest(at(0.9), 0, t1), Toc::initially_overlapping);
        all_are(*a, below, *b, Motion::at_rest(at(0), 0, t1), Toc::initially_overlapping);
      }
      const Motion below = Motion::at_rest({}, 0, 1);
      const Vec3 up(0, 1, 0);
      all_are(*a, below, *b, motion_for(at(1 + 2 * tolerance), up, Vec3::Zero(), 1),
              Toc::separated);
      all_are(*a, below, *b, motion_for(at(1 + 0.5 * tolerance), up, Vec3::Zero(), 1),
              Toc::initially_overlapping);
      for (const double t1 : {0.999, 1.001}) {
        all_are(*a, Motion::at_rest({}, 0, t1), *b, motion_for(at(2), -up, Vec3::Zero(), t1),
                t1 < 1 ? Toc::separated : Toc::contact);
      }
    }
  }
}

TEST_CASE(
    "what passes nearer than a quarter of the tolerance is reported, what stays farther is not") {
  const double tolerance = 1e-4;
  const std::vector<std::shared_ptr<const Shape>> shapes{sphere(0.5), capsule(0.5, 0.1),
                                                         cylinder(0.5, 1), box({0.5, 0.5, 0.5}),
                                                         mesh(make_mesh::box({0.5, 0.5, 0.5}))};
  for (const auto& a : shapes) {
    for (const auto& b : shapes) {
      for (const double side : {0.05, 0.2, 1.1, 3.0}) {
        const double x = a->bounds({}).max.x() + b->bounds({}).max.x() + side * tolerance;
        for (const double speed : {3.0, 300.0}) {
          if (only_to_run() && (speed > 3) == (side > 1)) continue;
          const Motion still = Motion::at_rest({}, 0, 4 / speed);
          const Motion past =
              motion_for({{x, 2, 0}, Quat::Identity()}, {0, -speed, 0}, Vec3::Zero(), 4 / speed);
          for (const Answer& found : answers(*a, still, *b, past, tolerance)) {
            CAPTURE(found.name);
            CAPTURE(side);
            if (found.toc.status == Toc::max_iterations) continue;
            CHECK(found.toc.hit() == (side < 1));
          }
        }
      }
    }
  }
}

TEST_CASE("bad input is refused by every method") {
  const auto ball = sphere(0.5);
  const Motion good = Motion::at_rest({{2, 0, 0}, Quat::Identity()}, 0, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Motion> bad(7, good);
  bad[0].velocity.x() = nan;
  bad[1].start.x.y() = std::numeric_limits<double>::infinity();
  bad[2].omega.z() = nan;
  bad[3].start.q.coeffs() *= 2;
  bad[4].t1 = 2;
  bad[5].t0 = -1;
  bad[6].offset.x.x() = nan;
  for (const Motion& m : bad) {
    for (const Answer& x : answers(*ball, good, *ball, m, 1e-5)) {
      CHECK(x.toc.status == Toc::invalid);
      CHECK(x.toc.time == 0);
    }
  }
  for (const double tolerance : {0.0, -1.0, nan}) {
    for (const Answer& x : answers(*ball, good, *ball, good, tolerance))
      CHECK(x.toc.status == Toc::invalid);
  }
  Motion backwards = good;
  backwards.t1 = -1;
  CHECK(time_of_contact(*ball, backwards, *ball, backwards, 1e-5).status == Toc::invalid);
}

TEST_CASE("a tolerance below the rounding of the poses is not certified, and ends") {
  const double far = 1e12;
  const Motion still = Motion::at_rest({{far, 0, 0}, Quat::Identity()}, 0, 1);
  const Motion falls = motion_for({{far, 3, 0}, Quat::Identity()}, {0, -4, 0}, {1, 2, 3}, 1);
  const auto b = box({0.5, 0.5, 0.5}), m = mesh(make_mesh::box({0.5, 0.5, 0.5}));
  for (const auto& a : {b, m}) {
    for (const Answer& x : answers(*a, still, *b, falls, 1e-6)) {
      CHECK(!x.toc.certified);
      CHECK(x.toc.status != Toc::separated);
    }
  }
}

TEST_CASE("a ball so large that its radius hides the tolerance is met within the tolerance") {
  // Distances relative to the core's, which for balls are the radius, were too coarse.
  const double radius = 1000, tolerance = 1e-7, exact = 2.5 / 4;
  const auto giant = sphere(radius);
  const Motion still = Motion::at_rest({}, 0, 1);
  for (const auto& small : {sphere(0.5), capsule(0.2, 0.6), cylinder(0.4, 1)}) {
    const Motion falls =
        motion_for({{0, radius + 3, 0}, Quat::Identity()}, {0, -4, 0}, Vec3::Zero(), 1);
    for (const Answer& x : answers(*giant, still, *small, falls, tolerance)) {
      CAPTURE(x.name);
      REQUIRE(x.toc.hit());
      CHECK(x.toc.time <= exact);
      CHECK((exact - x.toc.time) * 4 <= 1.3 * tolerance);
    }
  }
}

TEST_CASE("slivers, soups and doubled triangles: every method ends, agrees and stays finite") {
  Random r(307);
  int hits = 0, known = 0;
  const int n = cases(150);
  for (int i = 0; i < n; ++i) {
    TriangleMesh soup;
    for (int k = 0; k < 9; ++k) soup.vertices.push_back(random_vec(r, -1, 1));
    soup.vertices.push_back(soup.vertices[0]);
    soup.vertices.push_back(0.5 * (soup.vertices[1] + soup.vertices[2]));
    for (int k = 0; k < 8; ++k) soup.triangles.push_back({r.below(11), r.below(11), r.below(11)});
    soup.triangles.push_back({1, 10, 2});  // no area
    soup.triangles.push_back({0, 9, 3});
    soup.triangles.push_back(soup.triangles[0]);
    const auto a = mesh(soup);
    const std::vector<std::shared_ptr<const Shape>> others{sphere(0.2),
                                                           capsule(1e-3, 1),
                                                           box({1, 1e-4, 0.3}),
                                                           random_hull(r, 8, {1, 1e-3, 1e-3}),
                                                           mesh(make_mesh::box({0.4, 1e-4, 0.4})),
                                                           mesh(soup)};
    const auto& b = others[size_t(i) % others.size()];
    const double tick = 0.02, tolerance = 1e-5;
    const Vec3 way = random_direction(r) * 3.5;
    const Motion ma = motion_for({Vec3::Zero(), random_rotation(r)}, random_vec(r, -1, 1),
                                 random_vec(r, -40, 40), tick);
    Motion mb = motion_for({way, i % 2 ? random_rotation(r) : ma.start.q}, Vec3::Zero(),
                           random_vec(r, -40, 40), tick);
    mb.velocity = -way / tick * r.uniform(0.3, 2.5);
    const std::vector<Answer> found = answers(*a, ma, *b, mb, tolerance);
    bool sure = true;
    for (const Answer& x : found) {
      sure = sure && x.toc.status != Toc::max_iterations;
      CHECK((x.toc.on_a.allFinite() && x.toc.on_b.allFinite() && x.toc.normal.allFinite()));
      check_form(x.toc, ma, tolerance);
    }
    for (const Answer& x : found) {
      CAPTURE(x.name);
      if (sure) CHECK(to_string(x.toc.status) == to_string(found.front().toc.status));
    }
    hits += found.front().toc.hit(), known += sure;
  }
  if (n >= 100) CHECK((known > 0.9 * n && hits > 0.3 * n && hits < 0.98 * n));
}

TEST_CASE("a ball on a lever of 100 km: few steps, as only its own motion counts") {
  // The carrier's velocity and the turning cancel but for a few m/s, and the bounds about its
  // centre are a thousand. Steps by these alone took millions of distances.
  Random r(305);
  const double lever = 1e5, radius = 0.1, tolerance = 1e-5;
  const auto ball = sphere(radius), bar = capsule(0.05, 0.3);
  const auto floor = mesh(make_mesh::box({5, 1, 5}));
  const Motion below = Motion::at_rest({{0, -1, 0}, Quat::Identity()}, 0, 0.1);
  int hits = 0;
  const int n = cases(60);
  for (int i = 0; i < n; ++i) {
    const double spin = r.uniform(1e-4, 1e-2);
    Motion m = motion_for({{-lever, r.uniform(0.15, 0.4), 0}, Quat::Identity()},
                          {0, spin * lever + r.uniform(-6, 2), 0}, {0, 0, -spin}, 0.1);
    m.offset.x = {lever, 0, 0};
    // The bar lies along the axis of turning: it stays level.
    if (i % 2) m.offset.q = axis_angle(Vec3::UnitX(), std::numbers::pi / 2);
    const bool is_bar = i % 2;
    const double low = is_bar ? 0.05 : radius;
    const auto height = [&](long double t) {
      return long_pose(m, t).x.y() - static_cast<long double>(low);
    };
    const long double exact = first_zero(0, 0.1, 1000, height);
    if (fabsl(exact - 0.1L) < 1e-4L) continue;
    TimeOfContactOptions options;
    options.method = &method_named("conservative_advancement");
    const TimeOfContact toc =
        time_of_contact(is_bar ? *bar : *ball, m, *floor, below, tolerance, options);
    CHECK(toc.time <= exact);
    CHECK(toc.hit() == (exact <= 0.1L));
    CHECK(toc.iterations < 200);
    if (toc.hit()) CHECK(height(toc.time) <= 1.01 * tolerance);
    hits += toc.hit();
  }
  if (n >= 30) CHECK((hits > 0.2 * n && hits < 0.8 * n));
}
