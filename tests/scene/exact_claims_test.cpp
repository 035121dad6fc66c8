// What the scenes of the event stepper claim, as numbers. References: closed forms of textbook
// mechanics, computed here.
#include "tests/scene/shipped_scene.hpp"

#include <algorithm>

#include <fmt/format.h>

using namespace tumble;

namespace {

constexpr double gravity = 9.81;
constexpr double tick_60 = 1.0 / 60;

/// Height above the plate of a ball dropped from `h` after `t` seconds: parabolas between impacts.
double bounced_height(double h, double e, double t) {
  const double fall = std::sqrt(2 * h / gravity);
  if (t <= fall) return h - 0.5 * gravity * t * t;
  double start = fall, speed = e * gravity * fall;
  for (int n = 0; n < 100000; ++n) {
    const double flight = 2 * speed / gravity;
    if (t - start <= flight) return (t - start) * (speed - 0.5 * gravity * (t - start));
    start += flight;
    speed *= e;
  }
  return 0;
}

}  // namespace

TEST_CASE("slope_cone: nothing creeps below the cone; above it blocks slide as Coulomb says") {
  BuiltScene s = shipped("slope_cone");
  const std::pair<const char*, double> pairs[] = {{"a", 0.3}, {"b", 0.5}, {"c", 0.7}};
  std::vector<Vec3> held, slid;
  for (const auto& [name, mu] : pairs) {
    held.push_back(place(s, fmt::format("below_{}", name)));
    slid.push_back(place(s, fmt::format("above_{}", name)));
  }
  const double seconds = 5;
  run(s, seconds);
  for (size_t i = 0; i < 3; ++i) {
    const auto& [name, mu] = pairs[i];
    CAPTURE(mu);
    CHECK((place(s, fmt::format("below_{}", name)) - held[i]).norm() < 1e-9);
    const double slope = std::atan(mu) + 0.1 * M_PI / 180;
    const double acceleration = gravity * (std::sin(slope) - mu * std::cos(slope));
    const Vec3 down(std::cos(slope), -std::sin(slope), 0);
    const Vec3 way = place(s, fmt::format("above_{}", name)) - slid[i];
    CHECK((way - 0.5 * acceleration * seconds * seconds * down).norm() < 1e-6 * way.norm());
    const Vec3 v = body(s, fmt::format("above_{}", name)).v;
    CHECK((v - acceleration * seconds * down).norm() < 1e-6 * v.norm());
  }
}

TEST_CASE("bouncing_balls: every bounce as high as e^(2n) h, and the last one when the sum says") {
  BuiltScene s = shipped("bouncing_balls");
  const double h = 2, fall = std::sqrt(2 * h / gravity), floor = 0.28;
  double end[8];  // of infinitely many bounces
  for (int i = 0; i < 8; ++i) end[i] = fall * (1 + 0.2 + 0.1 * i) / (1 - (0.2 + 0.1 * i));
  for (int k = 1; k <= 780; ++k) {
    run(s, tick_60);
    const double t = k * tick_60;
    for (int i = 0; i < 9; ++i) {
      const double e = 0.2 + 0.1 * i;
      CAPTURE(t);
      CAPTURE(e);
      const double error =
          std::fabs(place(s, copy("ball", i)).y() - floor - bounced_height(h, e, t));
      // The tick in which the bounces come to their end stops at those lower than g (tick / 8)^2
      // / 2.
      const bool ending = i < 8 && t > end[i] - 2 * tick_60;
      CHECK(error < (ending ? 0.5 * gravity * std::pow(tick_60 / 8, 2) : 1e-9));
      if (i < 8 && t > end[i] + tick_60) CHECK(body(s, copy("ball", i)).v.norm() < 1e-9);
    }
  }
}

TEST_CASE("billiard_break: mirror symmetric, no momentum lost to the break, energy never up") {
  BuiltScene s = shipped("billiard_break");
  // Row r has balls r (r + 1) / 2 + c, c = 0 ... r from left to right.
  const auto mirror_error = [&] {
    double worst = std::fabs(place(s, "cue").z()) + std::fabs(body(s, "cue").v.z());
    for (int r = 0; r < 5; ++r)
      for (int c = 0; c <= r; ++c) {
        const auto ball = [&](int i) -> const RigidBody& {
          return body(s, copy("ball", r * (r + 1) / 2 + i));
        };
        const RigidBody &left = ball(c), &right = ball(r - c);
        const auto mirrored = [](const Vec3& x) { return Vec3(x.x(), x.y(), -x.z()); };
        worst = std::max(worst, (left.pose.x - mirrored(right.pose.x)).norm());
        worst = std::max(worst, (left.v - mirrored(right.v)).norm());
      }
    return worst;
  };
  const auto momentum = [&] {
    Vec3 p = Vec3::Zero();
    for_each_moving(s, [&](const RigidBody& b, const std::string&) { p += b.mass * b.v; });
    return p;
  };
  const Vec3 before = momentum();
  double energy = s.world->frame()->stats.energies.kinetic;
  const double first = energy;
  for (int k = 0; k < 150; ++k) {
    run(s, tick_60);
    CHECK(mirror_error() < 1e-9);
    const double now = s.world->frame()->stats.energies.kinetic;
    CHECK(now < energy + 1e-12 * first);
    energy = now;
    if (k == 32) CHECK((momentum() - before).norm() < 1e-12 * before.norm());
    if (k == 32) CHECK(energy < 0.95 * first);
  }
  BuiltScene elastic = shipped("billiard_break", {"materials.ivory.restitution=1"});
  run(elastic, 2.5);
  CHECK(elastic.world->frame()->stats.energies.kinetic == doctest::Approx(first).epsilon(1e-9));
}
