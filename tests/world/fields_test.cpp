// Fields acting on bodies and particles of a World. References: Kepler's laws, the harmonic
// oscillator, the closed form of drag towards a wind, and the order of the leapfrog by halving
// the tick.
#include "tests/support/test_world.hpp"

#include <array>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings fields_settings(int hz, const Vec3& gravity = Vec3::Zero()) {
  WorldSettings s;
  s.tick.num = hz;
  s.gravity = gravity;
  s.realtime.sleeping = false;
  return s;
}

ParticleSystemDef one_particle(const Vec3& x, const Vec3& v) {
  ParticleSystemDef def;
  def.collide = false;
  def.particles.resize(1);
  def.particles[0].x = x;
  def.particles[0].v = v;
  def.particles[0].mass = 2;
  return def;
}

/// An orbit of eccentricity 0.5 and semi-major axis 1 about mu = 4 pi^2: period 1 s.
struct Orbit {
  TestWorld w;
  ParticleSystemId id;
  explicit Orbit(int hz) : w(fields_settings(hz)) {
    PointGravityDef sun;
    sun.mu = 4 * M_PI * M_PI;
    w.force(sun);
    id = w->create_particles(one_particle({0.5, 0, 0}, {0, 0, -2 * M_PI * std::sqrt(3.0)})).value();
    w.apply();
  }
  Vec3 x() { return w->particles(id)->x[0]; }
  Vec3 v() { return w->particles(id)->v[0]; }
  double energy() { return w->frame()->stats.energies.total(); }
};

}  // namespace

TEST_CASE("Kepler: the orbit closes after its period, to the second order of the leapfrog") {
  std::array<double, 3> error{};
  for (size_t i = 0; i < 3; ++i) {
    const int hz = 400 << i;
    Orbit o(hz);
    const Vec3 start = o.x();
    o.w.run(1);
    error[i] = (o.x() - start).norm();
  }
  CHECK(error[0] < 0.02);
  CHECK(std::log2(error[0] / error[1]) == doctest::Approx(2).epsilon(0.05));
  CHECK(std::log2(error[1] / error[2]) == doctest::Approx(2).epsilon(0.02));
}

TEST_CASE("Kepler: angular momentum is kept to rounding, energy without drift over 50 orbits") {
  Orbit o(1000);
  const double m = 2, L = m * 0.5 * 2 * M_PI * std::sqrt(3.0);
  const double E = -m * 4 * M_PI * M_PI / 2;  // -m mu / 2a
  CHECK(o.energy() == doctest::Approx(E).epsilon(1e-12));
  std::array<double, 2> swing{};  // of the first and the last orbit
  for (int orbit = 0; orbit < 50; ++orbit) {
    for (int i = 0; i < 1000; ++i) {
      o.w.step();
      const double e = std::fabs(o.energy() / E - 1);
      if (orbit == 0 || orbit == 49)
        swing[orbit == 0 ? 0 : 1] = std::max(swing[orbit == 0 ? 0 : 1], e);
    }
  }
  CHECK(swing[0] < 1e-4);
  CHECK(swing[1] < 1.01 * swing[0]);
  CHECK(o.w->frame()->stats.angular_momentum.y() == doctest::Approx(L).epsilon(1e-11));
}

TEST_CASE("attractor: bodies and particles of any mass swing with sqrt(k), in phase") {
  TestWorld w(fields_settings(240));
  const BodyId ball = w.sphere({1, 0, 0}, 0.1);
  const auto dust = w->create_particles(one_particle({1, 3, 0}, Vec3::Zero())).value();
  AttractorDef pull;
  pull.strength = 4 * M_PI * M_PI;
  pull.centre = Vec3(0, 0, 0);
  w.force(pull);
  w.run(10);
  CHECK(w.body(ball).pose.x.x() == doctest::Approx(1).epsilon(1e-3));
  CHECK((w->particles(dust)->x[0] - Vec3(1, 3, 0)).norm() < 0.1);
  // The leapfrog turns by 2 asin(w h / 2) a tick.
  const double phase = 2400 * 2 * std::asin(M_PI / 240);
  CHECK(w.body(ball).pose.x.x() == doctest::Approx(std::cos(phase)).epsilon(1e-6));
  const double stored = 0.5 * pull.strength *
                        (w.body(ball).mass * w.body(ball).pose.x.squaredNorm() +
                         2 * w->particles(dust)->x[0].squaredNorm());
  CHECK(w->frame()->stats.energies.fields == doctest::Approx(stored).epsilon(1e-12));
}

TEST_CASE("terminal velocity in wind: the wind's, and g / c downwards") {
  for (const int hz : {60, 240}) {
    TestWorld w(fields_settings(hz, {0, -9.81, 0}));
    const BodyId ball = w.sphere({0, 0, 0}, 0.2);
    WindDef wind;
    wind.velocity = Vec3(7, 0, -2);
    wind.grip.rate = 3;
    w.force(wind);
    w.run(10);
    const Vec3 v = w.body(ball).v;
    CHECK(v.x() == doctest::Approx(7).epsilon(1e-9));
    CHECK(v.z() == doctest::Approx(-2).epsilon(1e-9));
    const double ch = 3.0 / hz;
    CHECK(v.y() == doctest::Approx(-9.81 / 3).epsilon(ch * ch / 10));
  }
}

TEST_CASE("quadratic wind: a falling ball ends at sqrt(2 m g / (rho Cd A))") {
  TestWorld w(fields_settings(240, {0, -9.81, 0}));
  const BodyId ball = w.sphere({0, 0, 0}, 0.05);
  WindDef air;
  air.velocity = Vec3::Zero();
  air.grip = {0, 1.2, 0.47};
  w.force(air);
  w.run(120);
  const double m = w.body(ball).mass, area = M_PI * 0.05 * 0.05;
  CHECK(-w.body(ball).v.y() ==
        doctest::Approx(std::sqrt(2 * m * 9.81 / (1.2 * 0.47 * area))).epsilon(1e-5));
}

TEST_CASE("a ball in the core of a vortex turns with the fluid and moves with it") {
  TestWorld w(fields_settings(240));
  const BodyId ball = w.sphere({0, 0, 0}, 0.01);
  VortexDef vortex;
  vortex.circulation = 4;
  vortex.core_radius = 0.8;
  vortex.grip.rate = 50;
  w.force(vortex);
  w.run(2);
  // Solid rotation at Gamma / (2 pi a^2) in the middle.
  CHECK(w.body(ball).omega.y() == doctest::Approx(4 / (2 * M_PI * 0.64)).epsilon(1e-3));
  CHECK(w.body(ball).v.norm() < 1e-12);
}

TEST_CASE("a field acts on what it names, and on nothing else") {
  TestWorld w(fields_settings(60));
  const BodyId a = w.sphere({1, 0, 0}), b = w.sphere({3, 0, 0});
  const auto dust = w->create_particles(one_particle({0, 2, 0}, Vec3::Zero())).value();
  w.apply();
  PointGravityDef pull;
  pull.targets.bodies = {a};
  w.force(pull);
  w.step();
  CHECK(w.body(a).v.x() < 0);
  CHECK(w.body(b).v.isZero(0));
  CHECK(w->particles(dust)->v[0].isZero(0));
  pull.targets = {{}, {dust}};
  w.force(pull);
  w.step();
  CHECK(w.body(b).v.isZero(0));
  CHECK(w->particles(dust)->v[0].y() < 0);
  REQUIRE(w->destroy_body(a).ok());
  w.step();  // what is gone is passed over
  CHECK_FALSE(w->create_force([&] {
                 PointGravityDef stale;
                 stale.targets.bodies = {a};
                 return ForceDef(stale);
               }())
                  .ok());
}

TEST_CASE("definitions that make no sense are refused, with the key") {
  TestWorld w(fields_settings(60));
  const auto refused = [&](ForceDef def, const std::string& word) {
    const auto made = w->create_force(std::move(def));
    REQUIRE_FALSE(made.ok());
    CHECK_MESSAGE(made.error().text().find(word) != std::string::npos, made.error().text());
  };
  PointGravityDef gravity;
  gravity.mu = -1;
  refused(gravity, "mu");
  RepulsorDef repulsor;
  repulsor.radius = 0;
  refused(repulsor, "radius");
  VortexDef vortex;
  vortex.axis = Vec3::Zero();
  refused(vortex, "axis");
  TurbulenceDef turbulence;
  turbulence.octaves = 0;
  refused(turbulence, "octaves");
  turbulence.octaves = 2;
  turbulence.size = std::nan("");
  refused(turbulence, "size");
  WindDef wind;
  wind.velocity.of[0] = std::nan("");
  refused(wind, "velocity");
}

TEST_CASE("a gust moves a body that rested before it came") {
  WorldSettings s;
  s.tick.num = 60;
  TestWorld w(s);
  w.ground();
  const BodyId box = w.box({0, 0.5, 0});
  WindDef wind;
  wind.velocity = Vec3(1, 0, 0);
  wind.gusts = 1;
  wind.gust_period = 20;
  wind.grip.rate = 4.5;
  w.force(wind);
  double fastest = 0;
  for (int i = 0; i < 60 * 20; ++i) {
    w.step();
    fastest = std::max(fastest, w.body(box).v.x());
    CHECK_FALSE(w.body(box).asleep);
  }
  CHECK(fastest > 0.05);
}

TEST_CASE("fields are in the snapshot: a loaded world goes on with the same bits") {
  TestWorld w(fields_settings(60, {0, -1, 0}));
  const BodyId a = w.sphere({1, 0.5, 0}, 0.2);
  for (int i = 0; i < 5; ++i) w.sphere({0.8 * i, 2, -0.3 * i}, 0.2);
  const auto dust = w->create_particles(one_particle({0.5, 1, 0}, Vec3::Zero())).value();
  w.apply();
  PointGravityDef sun;
  sun.softening = 0.3;
  sun.targets = {{a}, {dust}};
  w.force(sun);
  w.force(AttractorDef{});
  w.force(RepulsorDef{});
  w.force(VortexDef{});
  WindDef wind;
  wind.gusts = 0.7;
  w.force(wind);
  w.force(TurbulenceDef{});
  w.run(0.5);
  const Bytes saved = w->save();
  TestWorld other(fields_settings(60));
  REQUIRE(other->load(saved).ok());
  w.run(1);
  other.run(1);
  CHECK(w->state_hash() == other->state_hash());
}
