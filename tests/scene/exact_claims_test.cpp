// What the scenes of the event stepper claim, as numbers. References: closed forms of textbook
// mechanics, computed here.
#include "engine/world/world.hpp"
#include "tests/scene/shipped_scene.hpp"

#include <algorithm>
#include <map>

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

/// Moments of inertia about the centre of mass of a bar along x and a stem along y whose centre is
/// at height `up` above the bar's, both cylinders of radius r and density 1.
Vec3 t_moments(double r, double bar, double stem, double up) {
  const double m1 = M_PI * r * r * bar, m2 = M_PI * r * r * stem;
  const double along1 = 0.5 * m1 * r * r, across1 = m1 * (3 * r * r + bar * bar) / 12;
  const double along2 = 0.5 * m2 * r * r, across2 = m2 * (3 * r * r + stem * stem) / 12;
  const double apart = m1 * m2 / (m1 + m2) * up * up;
  return {along1 + across2 + apart, across1 + along2, across1 + across2 + apart};
}

/// sn, cn, dn of u with parameter m = k^2 by the arithmetic-geometric mean (Abramowitz & Stegun
/// 16.4, 17.6), and K.
struct Jacobi {
  double sn, cn, dn, K;
  Jacobi(double u, double m) {
    double a[30], c[30], b = std::sqrt(1 - m);
    a[0] = 1, c[0] = std::sqrt(m);
    int n = 0;
    for (; std::fabs(c[n]) > 1e-16 && n < 29; ++n) {
      a[n + 1] = 0.5 * (a[n] + b), c[n + 1] = 0.5 * (a[n] - b);
      b = std::sqrt(a[n] * b);
    }
    K = M_PI / (2 * a[n]);
    double phi = std::ldexp(a[n] * u, n);
    for (; n > 0; --n) phi = 0.5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
    sn = std::sin(phi), cn = std::cos(phi), dn = std::sqrt(1 - m * sn * sn);
  }
};

}  // namespace

TEST_CASE("slope_cone: nothing creeps below the cone, above it blocks slide as Coulomb says") {
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
    const auto& shown_mu = mu;
    CAPTURE(shown_mu);
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

TEST_CASE("t_handle: turns over as Euler's equations say, in Jacobi's functions") {
  const Vec3 I = t_moments(0.06, 0.9, 0.4, 0.26), w0(0.3, 8, 0);
  REQUIRE((I.x() < I.y() && I.y() < I.z()));
  // Landau & Lifshitz, Mechanics, 37.8 to 37.12, with 1 and 3 exchanged: L^2 < 2 E I2.
  const double E2 = w0.dot(I.cwiseProduct(w0)), L2 = I.cwiseProduct(w0).squaredNorm();
  const double a = L2 - E2 * I.x(), c = E2 * I.z() - L2;
  const double rate = std::sqrt((I.y() - I.x()) * c / (I.x() * I.y() * I.z()));
  const double m = (I.z() - I.y()) * a / ((I.y() - I.x()) * c), K = Jacobi(0, m).K;
  const Vec3 most(std::sqrt(c / (I.x() * (I.z() - I.x()))),
                  std::sqrt(a / (I.y() * (I.y() - I.x()))),
                  std::sqrt(a / (I.z() * (I.z() - I.x()))));
  const Vec3 momentum = I.cwiseProduct(w0);
  double before = 0;
  for (const double hz : {480, 960}) {
    BuiltScene s = shipped("t_handle", {fmt::format("settings.tick_hz={}", hz)});
    double worst = 0, turned = 0;
    int flips = 0;
    for (int k = 1; k <= 20 * hz; ++k) {
      const auto step = s.world->step();
      REQUIRE(step.ok());
      const RigidBody& handle = body(s, "handle");
      const Vec3 w = handle.body_frame().inverse_direction(handle.omega);
      const Jacobi j(rate * k / hz + K, m);  // the spin about y is greatest at the start
      worst = std::max(worst, (w - Vec3(most.x() * j.dn, most.y() * j.sn, most.z() * j.cn)).norm());
      const Vec3 L = handle.body_frame().direction(I.cwiseProduct(w));
      turned = std::max(turned, (L - momentum).norm() / momentum.norm());
      const int expected = int((rate * k / hz + K) / (2 * K));
      if (expected > flips) ++flips;
      CHECK((w.y() < 0) == (flips % 2 == 1));
    }
    MESSAGE("error ", worst, " rad/s, ", turned, " of the angular momentum, flips ", flips);
    CHECK(worst < 5e-6 * 8);
    CHECK(turned < 1e-12);
    CHECK(flips >= 10);
    if (before > 0) CHECK(worst < before / 16);
    before = worst;
  }
}

TEST_CASE("table_four_legs: the least forces that hold it, wherever the weight stands") {
  const double table =
      700 * (1.4 * 0.05 * 0.9 + 4 * M_PI * 0.035 * 0.035 * (0.63 + 4.0 / 3 * 0.035));
  for (const Vec3& at : {Vec3(0, 0, 0), Vec3(0.3, 0, 0.15), Vec3(-0.45, 0, 0.25)}) {
    CAPTURE(at.transpose());
    BuiltScene s = shipped("table_four_legs", {fmt::format("parameters.x={}", at.x()),
                                               fmt::format("parameters.z={}", at.z())});
    const Vec3 before = place(s, "table");
    run(s, 2);
    CHECK((place(s, "table") - before).norm() < 1e-9);
    // With f_i = p + q x_i + r z_i, the least of those in balance, for legs at +-0.6 and +-0.35.
    const auto certificates = s.world->contact_certificates();
    REQUIRE(certificates.ok());
    int legs = 0;
    for (const ContactCertificate& c : certificates->contacts) {
      if (c.key.body_a != s.bodies.at("ground").index) continue;
      ++legs;
      const double expected = gravity / 4 *
                              (table + 20 * (1 + at.x() * c.x_world.x() / (0.6 * 0.6) +
                                             at.z() * c.x_world.z() / (0.35 * 0.35)));
      CHECK((c.force - Vec3(0, expected, 0)).norm() < 1e-9 * gravity * (table + 20));
    }
    CHECK(legs == 4);
  }
}

TEST_CASE(
    "mass_ratio: nothing sinks under a thousand times its mass, and the floor carries it all") {
  BuiltScene s = shipped("mass_ratio");
  std::map<std::string, Vec3> before;
  double weight = 0;
  for_each_moving(s, [&](const RigidBody& b, const std::string& name) {
    before[name] = b.pose.x;
    weight += gravity * b.mass;
  });
  run(s, 10);
  for_each_moving(s, [&](const RigidBody& b, const std::string& name) {
    CHECK_MESSAGE((b.pose.x - before[name]).norm() < 1e-8, name);
    CHECK_MESSAGE(b.v.norm() < 1e-9, name);
  });
  Vec3 carried = Vec3::Zero();
  for (const ContactFrame& c : s.world->frame()->all_contacts()) {
    if (c.a == s.bodies.at("ground")) carried += 60 * c.impulse;
    if (c.b == s.bodies.at("ground")) carried -= 60 * c.impulse;
  }
  CHECK((carried - Vec3(0, weight, 0)).norm() < 1e-9 * weight);
}

TEST_CASE("cradle_nine: three balls hand their whole blow to the last three, and back") {
  BuiltScene s = shipped("cradle_nine");
  const double height = 2.1 * (1 - std::cos(M_PI / 6)), blow = std::sqrt(2 * gravity * height);
  // How fast the energy of a ball would be at the bottom.
  const auto speed = [&](int i) {
    const double up = place(s, copy("ball", i)).y() - 0.9;
    return std::sqrt(body(s, copy("ball", i)).v.squaredNorm() + 2 * gravity * std::max(0.0, up));
  };
  const auto check = [&](int first) {
    for (int i = 0; i < 9; ++i) {
      CAPTURE(i);
      const bool flies = i >= first && i < first + 3;
      if (flies)
        CHECK(speed(i) == doctest::Approx(blow).epsilon(0.01));
      else
        CHECK(body(s, copy("ball", i)).v.norm() < 0.01 * blow);
    }
  };
  run(s, 0.9);  // a quarter of a period of 30 degrees is 0.739 s
  check(6);
  run(s, 1.5);
  check(0);
}

TEST_CASE("euler_disk: goes round at the rate of steady rolling, for ever without drag") {
  const double a = 0.4, b = 0.025;
  // Weight against the change of the spin, about the middle at rest; with b = 0 this is Omega^2 =
  // 4 g / (a sin alpha) (Moffatt, Nature 404, 2000).
  const auto omega = [&](double tilt) {
    const double c = std::cos(tilt), d = std::sin(tilt), across = a * a / 4 + b * b / 3;
    return std::sqrt(gravity * (a * c - b * d) / (d * (across * c - 0.5 * a * b * d)));
  };
  const auto axis = [](const BuiltScene& s) {
    return body(s, "disc").pose.direction(Vec3::UnitY());
  };
  const auto azimuth = [&](const BuiltScene& s) { return std::atan2(-axis(s).z(), axis(s).x()); };
  const auto turned = [&](const BuiltScene& s, double before) {
    return std::remainder(azimuth(s) - before, 2 * M_PI);
  };
  for (const double tilt : {30.0, 12.0}) {
    CAPTURE(tilt);
    const double alpha = tilt * M_PI / 180;
    BuiltScene s =
        shipped("euler_disk", {"parameters.drag=0", fmt::format("parameters.tilt={}", tilt)});
    const Vec3 middle = place(s, "disc");
    const double energy = s.world->frame()->stats.energies.total();
    double angle = 0, before = azimuth(s);
    for (int k = 0; k < 5 * 240; ++k) {
      run(s, 1.0 / 240);
      angle += turned(s, before);
      before = azimuth(s);
      CHECK((place(s, "disc") - middle).norm() < 1e-6);
      CHECK(std::fabs(std::acos(axis(s).y()) - alpha) < 1e-6);
    }
    CHECK(std::fabs(angle) == doctest::Approx(5 * omega(alpha)).epsilon(1e-6));
    CHECK(s.world->frame()->stats.energies.total() == doctest::Approx(energy).epsilon(1e-6));
  }
  // With drag it sinks and goes round faster.
  BuiltScene s = shipped("euler_disk");
  run(s, 3);
  CHECK(std::acos(axis(s).y()) < 20 * M_PI / 180);
  const double before = azimuth(s);
  run(s, 1.0 / 240);
  CHECK(240 * std::fabs(turned(s, before)) > 1.1 * omega(30 * M_PI / 180));
}

TEST_CASE("tippe_top: turns over and rises, and keeps Jellett's invariant while it does") {
  BuiltScene s = shipped("tippe_top");
  const double radius = 0.2;
  // L.(from the contact to the centre of mass): constant for any force there (Gray & Nickel, Am. J.
  // Phys. 68, 2000).
  const auto jellett = [&] {
    const RigidBody& top = body(s, "top");
    const Vec3 contact = top.body_frame().x - Vec3(0, radius, 0);
    return (top.inertia_world() * top.omega).dot(top.pose.x - contact);
  };
  const auto on_ball = [&] {
    const Vec3 contact = body(s, "top").body_frame().x - Vec3(0, radius, 0);
    for (const ContactFrame& c : s.world->frame()->all_contacts())
      if ((c.x_world - contact).norm() > 1e-6) return false;
    return true;
  };
  const double start = jellett(), height = place(s, "top").y();
  double worst = 0, energy = s.world->frame()->stats.energies.total(), highest = height;
  bool before_stem = true;
  for (int k = 0; k < 5 * 480; ++k) {
    run(s, 1.0 / 480);
    before_stem = before_stem && on_ball();
    if (before_stem) {
      worst = std::max(worst, std::fabs(jellett() / start - 1));
      highest = std::max(highest, place(s, "top").y());
    }
    const double now = s.world->frame()->stats.energies.total();
    CHECK(now < energy + 1e-6);
    energy = now;
  }
  MESSAGE("Jellett's invariant changes by ", worst, ", rises by ", highest - height, " m");
  CHECK(worst < 1e-9);
  CHECK(highest > height + 0.02);
  CHECK(place(s, "top").y() >
        radius + 0.02);  // higher than the ball's middle would be: on the stem
  CHECK(body(s, "top").pose.direction(Vec3::UnitY()).y() < -0.9);
}

TEST_CASE(
    "pendulums_exact: rod and ball are where the closed forms say, the links keep their energy") {
  // theta = 2 asin(k sn(K + w t)), k = sin(theta0 / 2), w^2 = m g c / I about the hinge.
  const double c = 0.5, inertia = (0.09 * 0.09 + 1) / 12 + c * c,
               w = std::sqrt(gravity * c / inertia);
  const double m = 0.75, K = Jacobi(0, m).K;
  const double length = 2.2, angle = 26 * M_PI / 180, radius = length * std::sin(angle);
  const double turn = std::sqrt(gravity / (length * std::cos(angle)));
  double before = 0;
  for (const double hz : {480, 960}) {
    BuiltScene s = shipped("pendulums_exact", {fmt::format("settings.tick_hz={}", hz)});
    double rod = 0, ball = 0, open = 0;
    for (int k = 1; k <= 10 * hz; ++k) {
      const auto step = s.world->step();
      REQUIRE(step.ok());
      const double t = k / hz, half = std::sqrt(m) * Jacobi(K + w * t, m).sn;
      const double sine = 2 * half * std::sqrt(1 - half * half), cosine = 1 - 2 * half * half;
      rod =
          std::max(rod, (place(s, "rod") - Vec3(-1.75 + c * sine, 4.55 - c * cosine, -0.2)).norm());
      const Vec3 at(1.7 + radius * std::cos(turn * t), 4.55 - length * std::cos(angle),
                    -radius * std::sin(turn * t));
      ball = std::max(ball, (place(s, "bob") - at).norm());
      for (const JointFrame& j : *s.world->frame()->joints)
        if (j.kind != JointKind::distance)
          open = std::max(open, (j.frame_b.x - j.frame_a.x).norm());
    }
    const double drift = s.world->frame()->ledger->drift();
    MESSAGE("rod ", rod, " m, ball ", ball, " m, joints open ", open, " m, drift ", drift);
    CHECK(rod < 1e-6);
    CHECK(ball < 1e-6);
    CHECK(open < 1e-12);
    CHECK(drift < 1e-6);
    if (before > 0) CHECK(rod < before / 12);
    before = rod;
  }
}
