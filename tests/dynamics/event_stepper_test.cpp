// The event stepper. References: closed forms (parabolas between bounces, Coulomb's law, rolling,
// statics), conservation laws.
#include "tests/dynamics/event_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("event: an elastic ball keeps its height over a hundred bounces (A2)") {
  EventWorld w;
  w.floor(0, 1);
  w.add(body(sphere(0.1), {0, 5, 0}, 0, 1));
  const double e0 = w.energy();
  double worst = 0;
  for (int i = 0; i < 20 * 60; ++i) {
    w.step();
    worst = std::max(worst, std::fabs(w.energy() / e0 - 1));
  }
  MESSAGE("energy ", worst, " deepest ", w.deepest);
  CHECK(worst < 1e-9);
  // The closed form: fall time sqrt(2 d / g), then equal arcs.
  const double d = 4.9, g = 9.81, fall = std::sqrt(2 * d / g);
  double t = std::fmod(20 - fall, 2 * fall);
  const double y = 0.1 + std::sqrt(2 * g * d) * t - 0.5 * g * t * t;
  CHECK(w.bodies[1].pose.x.y() == doctest::Approx(y).epsilon(1e-6));
  CHECK(w.deepest < 1e-8);
}

TEST_CASE(
    "event: a block below the cone stays, above it slides as Coulomb says, in any direction (A7)") {
  for (const double angle_deg : {0.0, 30.0, 45.0, 77.0}) {
    for (const double slope : {0.45, 0.8}) {
      EventWorld w;
      w.fixed(box(50, 1, 50), {0, -1, 0});
      w.add(body(box(0.5, 0.5, 0.5), {0, 0.5, 0}));
      const double a = angle_deg * 3.14159265358979323846 / 180, theta = std::atan(slope);
      const Vec3 down(std::cos(a), 0, std::sin(a));
      w.gravity = 9.81 * std::sin(theta) * down + Vec3(0, -9.81 * std::cos(theta), 0);
      w.run(2);
      const double along = down.dot(w.bodies[1].v);
      CAPTURE(angle_deg);
      if (slope < 0.5) {
        CHECK(w.bodies[1].pose.x.x() == doctest::Approx(0).scale(1).epsilon(1e-9));
        CHECK(w.bodies[1].v.norm() < 1e-9);
      } else {
        const double want = 2 * 9.81 * (std::sin(theta) - 0.5 * std::cos(theta));
        CHECK(along == doctest::Approx(want).epsilon(1e-6));
        CHECK((w.bodies[1].v - along * down).norm() < 1e-6);
      }
      CHECK(w.deepest < 1e-8);
    }
  }
}

TEST_CASE("event: a ball with backspin slides, turns and rolls as the closed form says") {
  EventWorld w;
  w.floor(0.3);
  BodyDef d = body(sphere(0.2), {0, 0.2, 0}, 0.3);
  d.velocity = {1, 0, 0};
  d.angular_velocity = {0, 0, 10};
  w.add(d);
  // slip 1 + 0.2 * 10 = 3 m/s; it ends at t = (2/7) 3 / (mu g); then v = 1 - mu g t rolls.
  const double t = 2.0 / 7 * 3 / (0.3 * 9.81), v = 1 - 0.3 * 9.81 * t;
  w.run(2);
  CHECK(w.bodies[1].v.x() == doctest::Approx(v).epsilon(1e-9));
  CHECK(w.bodies[1].omega.z() == doctest::Approx(-v / 0.2).epsilon(1e-9));
  CHECK(w.bodies[1].pose.x.x() ==
        doctest::Approx(t - 0.5 * 0.3 * 9.81 * t * t + v * (2 - t)).epsilon(1e-8));
}

TEST_CASE("event: a column of twelve boxes stands, and its contact forces add up to the weight") {
  EventWorld w;
  w.floor();
  for (int i = 0; i < 12; ++i)
    w.add(body(box(0.5, 0.5, 0.5), {0.01 * (i % 3), 0.5 + i, 0.02 * (i % 2)}));
  const std::vector<RigidBody> start = w.bodies;
  w.run(1);
  double moved = 0;
  for (size_t i = 0; i < start.size(); ++i)
    moved = std::max(moved, (w.bodies[i].pose.x - start[i].pose.x).norm());
  CHECK(moved < 1e-9);
  Vec3 floor_force = Vec3::Zero();
  for (const EventContact& c : w.stepper.contacts)
    if (c.key.body_a == 0) floor_force += c.force;
  CHECK((floor_force - Vec3(0, 12 * 1000 * 9.81, 0)).norm() < 1e-9 * 12 * 1000 * 9.81);
}

TEST_CASE("event: a mass of 1000 kg on one of 1 kg does not sink (A8)") {
  EventWorld w;
  w.floor();
  BodyDef light = body(box(0.5, 0.5, 0.5), {0, 0.5, 0}),
          heavy = body(box(0.5, 0.5, 0.5), {0, 1.5, 0});
  light.mass = 1, heavy.mass = 1000;
  w.add(light);
  w.add(heavy);
  w.run(10);
  CHECK(std::fabs(w.bodies[2].pose.x.y() - 1.5) < 1e-8);
  CHECK(w.bodies[2].v.norm() < 1e-9);
}

TEST_CASE("event: Newton's cradle, touching and with a gap (A4)") {
  for (const double gap : {0.0, 0.01}) {
    EventWorld w;
    w.gravity.setZero();
    for (int i = 0; i < 5; ++i) {
      BodyDef d = body(sphere(0.5), {i ? i * (1 + gap) : -1.0, 0, 0}, 0, 1);
      d.mass = 1;
      if (i == 0) d.velocity = {1, 0, 0};
      w.add(d);
    }
    w.run(3);
    for (int i = 0; i < 5; ++i) CHECK((w.bodies[size_t(i)].v - Vec3(i == 4, 0, 0)).norm() < 1e-9);
  }
}

TEST_CASE("event: bounces with restitution come to rest at Zeno's time") {
  EventWorld w;
  w.floor(0, 0.5);
  w.add(body(sphere(0.1), {0, 1.1, 0}, 0, 0.5));
  // t = sqrt(2 d / g) (1 + 2 e / (1 - e))
  const double end = std::sqrt(2 / 9.81) * 3;
  while (w.ticks * w.h < end + w.h) w.step();
  CHECK(std::fabs(w.bodies[1].pose.x.y() - 0.1) < 1e-8);
  CHECK(w.bodies[1].v.norm() < 1e-8);
}

namespace {

/// The generator of the published workloads.
struct PeerDraw {
  uint64_t s;
  double u(double a, double b) {
    s = s * 6364136223846793005ULL + 1442695040888963407ULL;
    return a + (b - a) * (double(s >> 33) / 2147483648.0);
  }
};

/// The block of 216 balls of 10 kg, its lowest layer at height y.
std::vector<BodyDef> block_of_balls(double y, double restitution) {
  PeerDraw g{42};
  std::vector<BodyDef> out;
  for (int k = 0; k < 6; ++k)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double jx = g.u(-0.001, 0.001), jz = g.u(-0.001, 0.001);
        const Vec3 x((i - 2.5) * 0.21 + jx, y + k * 0.21, (j - 2.5) * 0.21 + jz);
        out.push_back(body(sphere(0.1), x, 0, restitution));
        out.back().mass = 10;
      }
  return out;
}

/// Of balls of radius 0.1 with each other, from their centres alone.
double deepest_overlap(const EventWorld& w) {
  double deepest = 0;
  for (size_t i = 0; i < w.bodies.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (w.bodies[i].dynamic() && w.bodies[j].dynamic())
        deepest = std::max(deepest, 0.2 - (w.bodies[i].pose.x - w.bodies[j].pose.x).norm());
  return deepest;
}

}  // namespace

TEST_CASE("event: a slab on rolling balls moves as the closed form says, in any direction (A1)") {
  for (const Vec3& d : {Vec3(1, 0, 0), Vec3(0.5, 0, std::sqrt(0.75))}) {
    EventWorld w;
    w.fixed(box(50, 1, 50), {0, -1, 0}, 0.2);
    BodyDef slab = body(box(10, 0.5, 10), {0, 0.5, 0}, 0.8);
    slab.mass = 10;
    w.add(slab);
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j) {
        BodyDef b = body(sphere(0.5), {i * 2 - 4.0, 1.5, j * 2 - 4.0}, 0.8);
        b.mass = 1;
        w.add(b);
      }
    w.extra_force = [&](uint32_t slot, RigidBody& b) {
      if (slot == 1) b.force += 150 * d;
    };
    w.run(1);
    const double a = (150 - 0.4 * 35 * 9.81) / (10 + 25 * 2.0 / 7);
    CHECK((w.bodies[1].v - a * d).norm() < 1e-9 * a);
    CHECK((w.bodies[14].v - 2.0 / 7 * a * d).norm() < 1e-9 * a);
  }
}

TEST_CASE("event: 216 elastic balls without gravity keep energy and momentum (A3z)") {
  EventWorld w;
  w.gravity.setZero();
  std::vector<BodyDef> balls = block_of_balls(1.101, 1);
  for (size_t i = 0; i < balls.size(); ++i) {
    const bool low = i < balls.size() / 2;
    balls[i].pose.x.y() += low ? 0 : 0.3;
    balls[i].velocity = {0, low ? 1.0 : -0.5, 0};
    w.add(balls[i]);
  }
  const double e0 = w.energy();
  const Vec3 p0 = w.momentum();
  w.run(3);
  CHECK(std::fabs(w.energy() / e0 - 1) < 1e-9);
  CHECK((w.momentum() - p0).norm() < 1e-12 * 1080);
  CHECK(w.deepest < 1e-5);
  CHECK(deepest_overlap(w) < 1e-5);
  MESSAGE("energy ", w.energy() / e0 - 1, " momentum ", (w.momentum() - p0).norm() / 1080);
}

TEST_CASE("event: 216 inelastic balls that fall on each other do not overlap (A10)") {
  EventWorld w;
  w.floor(0, 0);
  for (const BodyDef& ball : block_of_balls(0.101, 0)) w.add(ball);
  for (int i = 0; i < 7; ++i) w.step();  // until all lie on the floor or on each other
  CHECK(w.deepest < 1e-5);
  CHECK(deepest_overlap(w) < 1e-5);
  for (const RigidBody& b : w.bodies)
    if (b.dynamic()) CHECK(b.pose.x.y() > 0.1 - 1e-5);
}

TEST_CASE("event: a card house stands (A9)") {
  EventWorld w;
  w.fixed(box(50, 1, 50), {0, -1, 0}, 0.7);
  const double pi = 3.14159265358979323846, a = 25 * pi / 180, hl = .2, ht = .005;
  const double ca = std::cos(a), sa = std::sin(a), X = hl * sa + ht * ca, D = .36,
               hy = hl * ca + ht * sa;
  double y = 0;
  const int levels = 3;
  for (int L = 0; L < levels; ++L) {
    const int n = levels - L;
    const double x0 = -(n - 1) * D / 2;
    for (int i = 0; i < n; ++i)
      for (int k = -1; k <= 1; k += 2) {
        BodyDef b = body(box(ht, hl, .15), {x0 + i * D + k * X, y + hy, 0}, .7);
        b.shapes[0].material.density = 500;
        b.pose.q = Quat(Eigen::AngleAxisd(k * a, Vec3::UnitZ()));
        w.add(b);
      }
    y += 2 * hy;
    for (int i = 0; i + 1 < n; ++i) {
      BodyDef b = body(box(D / 2 - .002, ht, .15), {x0 + (i + .5) * D, y + ht, 0}, .7);
      b.shapes[0].material.density = 500;
      w.add(b);
    }
    y += 2 * ht;
  }
  const std::vector<RigidBody> start = w.bodies;
  w.run(1);
  double moved = 0;
  for (size_t i = 0; i < start.size(); ++i)
    moved = std::max(moved, (w.bodies[i].pose.x - start[i].pose.x).norm());
  MESSAGE("moved ", moved);
  CHECK(moved < 1e-3);
}

TEST_CASE("event: a box that tumbles onto the floor loses energy only, and comes to rest") {
  EventWorld w;
  w.floor(0.4, 0.3);
  BodyDef d = body(box(0.3, 0.2, 0.4), {0, 1.5, 0}, 0.4, 0.3);
  d.angular_velocity = {2, 3, 1};
  d.velocity = {1, 0, 0.5};
  w.add(d);
  double energy = w.energy();
  for (int i = 0; i < 5 * 60; ++i) {
    w.step();
    CHECK(w.energy() <= energy + 1e-7 * std::fabs(energy));
    energy = w.energy();
  }
  CHECK(w.deepest < 1e-5);
  CHECK(w.bodies[1].v.norm() < 1e-6);
  MESSAGE("speed ", w.bodies[1].v.norm(), " height ", w.bodies[1].pose.x.y(), " deepest ",
          w.deepest);
}

TEST_CASE("event: a light ball that a heavy one shoots across the room meets what is there") {
  // Nothing foresees at the start of the tick that the light ball will be anywhere near the wall:
  // it is at rest. The heavy one comes at 20 m/s, so it leaves at nearly 40 m/s.
  EventWorld w(10);
  w.gravity.setZero();
  w.fixed(box(0.1, 5, 5), {3.1, 0, 0}, 0);
  BodyDef light = body(sphere(0.1), {0, 0, 0}, 0, 1), heavy = body(sphere(0.1), {-0.3, 0, 0}, 0, 1);
  light.mass = 1, heavy.mass = 1000;
  heavy.velocity = {20, 0, 0};
  w.add(light);
  w.add(heavy);
  w.step();
  // They touch at t = 0.1 / 20; then v' = 20 (1000 - 1) / 1001 and v' + 20; the wall is 2.9 m away.
  const double v_heavy = 20 * 999.0 / 1001, v_light = v_heavy + 20;
  const double back = 2.9 / v_light, t = 0.1 - 0.005;
  REQUIRE(back < t);
  // Of the two, coming towards each other from the wall, the second impact is not in this tick.
  const double x_light = 2.9 - v_light * (t - back), x_heavy = -0.2 + v_heavy * t;
  REQUIRE(x_light - x_heavy > 0.2);
  CHECK(w.bodies[1].pose.x.x() == doctest::Approx(x_light).epsilon(1e-9));
  CHECK(w.bodies[1].v.x() == doctest::Approx(-v_light).epsilon(1e-9));
  CHECK(w.bodies[2].pose.x.x() == doctest::Approx(x_heavy).epsilon(1e-9));
}

TEST_CASE("event: what whirls alone keeps its energy, however many turns it makes in a tick") {
  EventWorld w;
  w.gravity.setZero();
  BodyDef d = body(box(0.1, 0.02, 0.05), {0, 0, 0});
  d.angular_velocity = {900, 400, -700};
  w.add(d);
  const double start = w.energy();
  double worst = 0;
  for (int i = 0; i < 60; ++i) {
    w.step();
    worst = std::max(worst, std::fabs(w.energy() / start - 1));
  }
  MESSAGE("energy ", worst);
  CHECK(worst < 0.005);
}

TEST_CASE("event: overlap from before never grows, and is worked off at the speed of recovery") {
  EventWorld w;
  w.floor();
  w.add(body(box(0.5, 0.5, 0.5), {0, 0.49, 0}));
  w.add(body(box(0.3, 0.3, 0.3), {0.1, 1.287, 0.05}));
  double lower = 0.01, upper = 0.003;
  for (int i = 1; i <= 40; ++i) {
    w.step();
    const double now = 0.5 - w.bodies[1].pose.x.y();
    const double above = w.bodies[1].pose.x.y() + 0.8 - w.bodies[2].pose.x.y();
    CHECK(now <= lower + 1e-8);
    CHECK(above <= upper + 1e-8);
    CHECK(now == doctest::Approx(std::max(0.0, 0.01 - i * 0.05 / 60)).scale(1).epsilon(1e-7));
    lower = now, upper = above;
    for (size_t k = 1; k <= 2; ++k) CHECK(w.bodies[k].v.norm() < 1e-7);
  }
  CHECK(std::fabs(lower) < 1e-7);
  CHECK(std::fabs(upper) < 1e-7);
}

TEST_CASE("event: the contacts saved and loaded go on with the same bits") {
  EventWorld w;
  w.floor(0.4, 0.2);
  w.add(body(box(0.3, 0.2, 0.4), {0, 0.3, 0}, 0.4, 0.2));
  w.add(body(box(0.3, 0.2, 0.4), {0.1, 0.69, 0.03}, 0.4, 0.2));
  for (int i = 0; i < 40; ++i) {
    ByteWriter out;
    out.begin_section("event", 1);
    w.stepper.save(out);
    out.end_section();
    EventWorld copy;
    copy.bodies = w.bodies;
    ByteReader in(out.bytes());
    in.begin_section("event");
    REQUIRE(copy.stepper.load(in, 3));
    w.step();
    copy.step();
    for (size_t k = 0; k < w.bodies.size(); ++k) {
      CHECK(copy.bodies[k].pose.x == w.bodies[k].pose.x);
      CHECK(copy.bodies[k].pose.q.coeffs() == w.bodies[k].pose.q.coeffs());
      CHECK(copy.bodies[k].v == w.bodies[k].v);
    }
  }
  ByteWriter out;
  out.begin_section("event", 1);
  w.stepper.save(out);
  out.end_section();
  ByteReader in(out.bytes());
  in.begin_section("event");
  CHECK_FALSE(w.stepper.load(in, 2));
}

TEST_CASE(
    "event: every integrator runs through bounces, and those of higher order keep the height") {
  for (const ode::IntegratorEntry& e : ode::all_integrators()) {
    CAPTURE(e.name);
    EventWorld w;
    w.settings.integrator = e.name;
    w.floor(0, 1);
    w.add(body(sphere(0.1), {0, 1.1, 0}, 0, 1));
    const double e0 = w.energy();
    w.run(2);
    CHECK(w.deepest < 1e-5);
    CHECK(w.bodies[1].pose.x.y() > 0.1 - 1e-5);
    CHECK(std::fabs(w.energy() / e0 - 1) < (e.order >= 2 ? 1e-9 : 0.5));
  }
}
