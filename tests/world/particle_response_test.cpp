// Particles that collide: with bodies and each other in the same equations. References:
// closed forms (cradle, sliding, weights of a chain, the impulse on a plank, oscillators) and
// conserved quantities.
#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using test::scaled;
using test::TestWorld;

namespace {

constexpr double g = 9.81;

WorldSettings exact_settings(int hz = 60, const Vec3& gravity = {0, -g, 0}) {
  WorldSettings s;
  s.tick.num = hz;
  s.gravity = gravity;
  s.stepper = "event";
  s.event.budget = 1000000;  // what is claimed of events is not left to time-stepping
  return s;
}

Vec3 in_ball(Random& random, double radius) {
  for (;;) {
    Vec3 x;
    for (int k = 0; k < 3; ++k) x[k] = random.uniform(-1, 1);
    if (x.norm() <= 1) return radius * x;
  }
}

/// The realtime stepper without gravity.
WorldSettings weightless() {
  WorldSettings s;
  s.gravity = Vec3::Zero();
  return s;
}

ParticleDef particle_at(const Vec3& x, double radius, const Vec3& v = Vec3::Zero(),
                        double mass = 1) {
  ParticleDef p;
  p.x = x;
  p.v = v;
  p.mass = mass;
  p.radius = radius;
  return p;
}

ParticleSystemDef system_of(std::vector<ParticleDef> particles, double friction,
                            double restitution) {
  ParticleSystemDef def;
  def.name = "grains";
  def.particles = std::move(particles);
  def.friction = friction;
  def.restitution = restitution;
  return def;
}

ParticleSystemId add_system(TestWorld& w, ParticleSystemDef def) {
  const auto id = w->create_particles(std::move(def));
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  w.apply();
  return *id;
}

/// A plane with a normal in the x-y plane, tilted from the vertical about z.
BodyId slope_under(TestWorld& w, double tilt, double friction, const Vec3& at = Vec3::Zero()) {
  BodyDef def;
  def.type = BodyType::fixed;
  ShapeDef s;
  s.type = ShapeType::half_space;
  Material m;
  m.friction = friction;
  def.shapes.push_back({s, {}, m});
  def.pose.x = at;
  def.pose.q = axis_angle(Vec3::UnitZ(), tilt);
  return w.add(def);
}

/// Six planes about the cube |x| < half, that face inwards.
void walls_about(TestWorld& w, double half) {
  for (int k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0}) {
      BodyDef def;
      def.type = BodyType::fixed;
      ShapeDef s;
      s.type = ShapeType::half_space;
      Material m;
      m.friction = 0;
      m.restitution = 1;
      def.shapes.push_back({s, {}, m});
      def.pose.x = side * half * Vec3::Unit(k);
      def.pose.q = rotation_between(Vec3::UnitY(), -side * Vec3::Unit(k));
      w.add(def);
    }
}

TriangleMesh box_mesh(const Vec3& half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

}  // namespace

TEST_CASE("particles are found by id, whichever are gone") {
  // Reference: a search from the first to the last.
  Random random(5);
  for (int round = 0; round < scaled(40); ++round) {
    ParticleSystem p = make_particle_system({});
    p.next_id = 1 + random.below(5);
    const uint64_t most = random.below(30);
    const double stays = round % 3 == 0 ? 1 : 0.6;
    for (uint64_t i = 0; i < most; ++i) {
      p.add({});
      if (random.uniform(0, 1) < stays) continue;
      p.x.pop_back();
      p.id.pop_back();
    }
    for (uint64_t id = 0; id < most + 10; ++id)
      CHECK(p.find(id) == size_t(std::ranges::find(p.id, id) - p.id.begin()));
    CHECK(p.find(~uint64_t{0}) == p.size());
  }
}

TEST_CASE("particles: Newton's cradle answers to each law by its closed form") {
  for (const char* law :
       {"sequential", "reflections", "simultaneous_newton", "simultaneous_poisson"})
    for (const int n : {2, 3, 5, 9}) {
      CAPTURE(law);
      CAPTURE(n);
      WorldSettings settings = exact_settings(60, Vec3::Zero());
      settings.event.impulses = law;
      TestWorld w(settings);
      std::vector<ParticleDef> row;
      for (int i = 0; i < n; ++i) row.push_back(particle_at({double(i), 0, 0}, 0.5));
      row[0].x.x() = -0.125;
      row[0].v.x() = 3;
      const ParticleSystemId id = add_system(w, system_of(row, 0, 1));
      w.run(0.2);
      const ParticleSystem& p = *w->particles(id);
      const bool passed_on = law[0] == 's' && law[1] == 'e' ? true : law[0] == 'r';
      for (int i = 0; i < n; ++i) {
        const double first = passed_on ? 0 : 3 * (2.0 - n) / n, other = passed_on ? 0 : 6.0 / n;
        const double want = i == 0 ? first : i + 1 < n ? other : passed_on ? 3 : 6.0 / n;
        CHECK((p.v[size_t(i)] - Vec3(want, 0, 0)).norm() < 1e-9);
      }
    }
}

TEST_CASE("particles: collisions with each other and with bodies keep momentum to 1e-12" *
          doctest::test_suite("long")) {
  Random random(41);
  uint64_t impacts = 0;
  const uint64_t wanted = uint64_t(scaled(1000));
  for (int round = 0; impacts < wanted && round < 500; ++round) {
    CAPTURE(round);
    TestWorld w(exact_settings(60, Vec3::Zero()), 1, "law of impulses");
    std::vector<ParticleDef> cloud;
    for (int i = 0; i < 10; ++i) {
      const Vec3 x(0.8 * (i % 3), 0.8 * (i / 3), random.uniform(-0.2, 0.2));
      cloud.push_back(particle_at(x, random.uniform(0.1, 0.3), in_ball(random, 2) - x,
                                  random.uniform(0.1, 20)));
    }
    add_system(w, system_of(cloud, 0.4, 0.9));
    const BodyId a = w.box({-1.5, 0, 0}, {0.3, 0.4, 0.5}), b = w.sphere({3.5, 0.3, 0.1}, 0.5);
    ShapeDef capsule;
    capsule.type = ShapeType::capsule;
    capsule.radius = 0.2;
    capsule.height = 0.8;
    const BodyId c = w.add(TestWorld::shape_def(capsule, {0.5, -1.5, 0}));
    REQUIRE(w->set_velocity(a, {3, 0.5, 0}, in_ball(random, 3)).ok());
    REQUIRE(w->set_velocity(b, {-3, 0.5, 0}, in_ball(random, 3)).ok());
    REQUIRE(w->set_velocity(c, {0, 3, 0}, in_ball(random, 3)).ok());
    const StepStats first = w.step().stats;
    double scale = 0;
    for (const BodyId id : {a, b, c}) scale += w.body(id).mass * w.body(id).v.norm();
    impacts += first.impacts;
    for (int tick = 0; tick < 60; ++tick) {
      const StepStats s = w.step().stats;
      impacts += s.impacts;
      CHECK((s.momentum - first.momentum).norm() < 1e-12 * scale);
      // Up to the integrator's error of rotation.
      CHECK(s.energies.kinetic <= first.energies.kinetic * (1 + 1e-6));
    }
  }
  CHECK(impacts >= wanted);
}

TEST_CASE("particles: a chain at rest in a tube carries the weight above at every link") {
  // Zigzag between two walls; two more keep it in the plane.
  const int n = 6;
  const double r = 0.25, across = 0.3, m = 2;
  const double up = std::sqrt(4 * r * r - across * across);
  for (const char* solver : {"automatic", "dantzig"}) {
    CAPTURE(solver);
    WorldSettings settings = exact_settings();
    settings.event.contact_solver = solver;
    TestWorld w(settings);
    slope_under(w, 0, 0);
    for (const double side : {-1.0, 1.0}) {
      BodyDef wall = TestWorld::box_def({side * (0.5 * across + r + 0.5), 2, 0}, {0.5, 2.5, 1});
      wall.type = BodyType::fixed;
      wall.shapes[0].material.friction = 0;
      w.add(wall);
      wall.pose.x = {0, 2, side * (r + 0.5)};
      wall.shapes[0].shape.half_extents = {1, 2.5, 0.5};
      w.add(wall);
    }
    std::vector<ParticleDef> chain;
    for (int i = 0; i < n; ++i)
      chain.push_back(
          particle_at({(i % 2 ? 0.5 : -0.5) * across, r + i * up, 0}, r, Vec3::Zero(), m));
    const ParticleSystemId id = add_system(w, system_of(chain, 0, 0));
    w.run(1);
    const ParticleSystem& p = *w->particles(id);
    for (size_t i = 0; i < p.size(); ++i) CHECK((p.x[i] - chain[i].x).norm() < 1e-8);
    const auto certificates = w->contact_certificates();
    REQUIRE(certificates.ok());
    int links = 0;
    for (const ContactCertificate& c : certificates->contacts) {
      if ((c.key.body_b & particle_bit) == 0 || (c.key.body_a & particle_bit) == 0) continue;
      const uint64_t lower = certificates->particles[c.key.body_a & ~particle_bit].particle;
      const double above = double(n) - double(lower);  // ids begin at 1
      CHECK(c.force.norm() == doctest::Approx(above * m * g * 2 * r / up).epsilon(1e-9));
      ++links;
    }
    CHECK(links == n - 1);
    for (const BodyBalance& b : certificates->bodies) CHECK(b.residual < 1e-9);
  }
}

TEST_CASE("particles: on a slope they rest inside the cone, and slide with g (sin - mu cos)") {
  const double tilt = 0.4, r = 0.05;
  const Vec3 down(-std::cos(tilt), -std::sin(tilt), 0);
  const Vec3 start = r * Vec3(-std::sin(tilt), std::cos(tilt), 0);
  for (const double mu : {0.0, 0.3, 0.43}) {
    CAPTURE(mu);
    TestWorld w(exact_settings());
    slope_under(w, tilt, mu);
    const ParticleSystemId id = add_system(w, system_of({particle_at(start, r)}, mu, 0));
    w.run(2);
    const ParticleSystem& p = *w->particles(id);
    const double a = std::max(0.0, g * (std::sin(tilt) - mu * std::cos(tilt)));
    CHECK((p.v[0] - 2 * a * down).norm() < 1e-6 * std::max(a, 1e-3));
    CHECK((p.x[0] - start - 2 * a * down).norm() < 1e-6 * std::max(a, 1e-3));
  }
}

TEST_CASE("particles: friction carries one around on a turntable, as a point on it") {
  TestWorld w(exact_settings(120));
  BodyDef table = TestWorld::box_def({0, -0.1, 0}, {2, 0.1, 2});
  table.type = BodyType::kinematic;
  table.angular_velocity = {0, 1.5, 0};
  table.shapes[0].material.friction = 0.5;
  w.add(table);
  const double r = 0.02;
  const ParticleSystemId id =
      add_system(w, system_of({particle_at({1, r, 0}, r, {0, 0, -1.5})}, 0.5, 0));
  w.run(2);
  const ParticleSystem& p = *w->particles(id);
  CHECK((p.x[0] - Vec3(std::cos(3.0), r, -std::sin(3.0))).norm() < 1e-6);
  CHECK((p.v[0] - 1.5 * Vec3(-std::sin(3.0), 0, -std::cos(3.0))).norm() < 1e-6);
}

TEST_CASE("particles: one dropped on a free plank turns it by the impulse of the closed form") {
  for (const double e : {0.25, 0.6, 1.0}) {
    CAPTURE(e);
    TestWorld w(exact_settings(60, Vec3::Zero()));
    BodyDef plank = TestWorld::box_def(Vec3::Zero(), {1, 0.05, 0.2});
    plank.shapes[0].material.friction = 0;
    const BodyId body = w.add(plank);
    const double m = 5, d = 0.7, v = 4, r = 0.1;
    const ParticleSystemId id =
        add_system(w, system_of({particle_at({d, 0.2, 0}, r, {0, -v, 0}, m)}, 0, e));
    w.run(0.05);
    const RigidBody& b = w.body(body);
    const double J = (1 + e) * v / (1 / m + b.inverse_mass + d * d * b.inverse_inertia_body(2, 2));
    CHECK((w->particles(id)->v[0] - Vec3(0, J / m - v, 0)).norm() < 1e-9);
    CHECK((b.v + J * b.inverse_mass * Vec3::UnitY()).norm() < 1e-9);
    CHECK((b.omega + J * d * b.inverse_inertia_body(2, 2) * Vec3::UnitZ()).norm() < 1e-9);
  }
}

TEST_CASE("particles: with friction, too, particle and body keep their angular momentum") {
  TestWorld w(exact_settings(60, Vec3::Zero()));
  const BodyId body = w.box({0, 0, 0}, {1, 0.1, 0.6});
  REQUIRE(w->set_velocity(body, Vec3::Zero(), {0.4, 2, 1}).ok());
  add_system(w, system_of({particle_at({0.7, 0.5, 0.2}, 0.1, {1, -4, 0.5}, 300)}, 0.9, 0.3));
  const StepStats first = w.step().stats;
  uint64_t impacts = 0;
  for (int i = 0; i < 30; ++i) {
    const StepStats s = w.step().stats;
    impacts += s.impacts;
    CHECK((s.momentum - first.momentum).norm() < 1e-12 * first.momentum.norm());
    CHECK((s.angular_momentum - first.angular_momentum).norm() <
          1e-9 * first.angular_momentum.norm());
  }
  CHECK(impacts > 0);
  CHECK(w->frame()->ledger->drift() < 1e-9);
}

TEST_CASE("particles: an elastic gas keeps its energy to 1e-9") {
  TestWorld w(exact_settings(60, Vec3::Zero()));
  walls_about(w, 1);
  Random random(5);
  std::vector<ParticleDef> gas;
  for (int i = 0; i < 27; ++i)
    gas.push_back(particle_at(0.6 * Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1), 0.1,
                              in_ball(random, 2), 0.01));
  add_system(w, system_of(gas, 0, 1));
  const double before = w.step().stats.energies.kinetic;
  w.run(0.1 * scaled(30));
  CHECK(std::fabs(w.step().stats.energies.kinetic - before) < 1e-9 * before);
}

TEST_CASE("particles: a fast one does not pass a mesh that stands or comes towards it") {
  for (const double speed : {0.0, 30.0}) {
    CAPTURE(speed);
    TestWorld w(exact_settings(60, Vec3::Zero()));
    ShapeDef shape;
    shape.type = ShapeType::triangle_mesh;
    shape.mesh = std::make_shared<const TriangleMesh>(box_mesh({0.02, 1, 1}));
    BodyDef wall = TestWorld::shape_def(shape, {1.5, 0, 0}, BodyType::kinematic);
    wall.velocity = {-speed, 0, 0};
    wall.shapes[0].material.friction = 0;
    w.add(wall);
    const ParticleSystemId id =
        add_system(w, system_of({particle_at({0, 0.113, 0.207}, 0.005, {150, 0, 0})}, 0, 1));
    w.run(0.05);
    const ParticleSystem& p = *w->particles(id);
    CHECK(p.x[0].x() < 1.5);
    CHECK((p.v[0] - Vec3(-150 - 2 * speed, 0, 0)).norm() < 1e-6 * 150);
  }
}

TEST_CASE("particles: springs, drag and fields move them as closed forms say") {
  TestWorld w(exact_settings(240, Vec3::Zero()));
  ParticleSystemDef def = system_of({particle_at({0, 0, 0}, 0.01, Vec3::Zero(), 2),
                                     particle_at({1.2, 0, 0}, 0.01, Vec3::Zero(), 2)},
                                    0, 0);
  const ParticleSystemId pair = add_system(w, def);
  SpringDef spring;
  spring.a = {Anchor::Kind::particle, {}, pair, 1, Vec3::Zero()};
  spring.b = {Anchor::Kind::particle, {}, pair, 2, Vec3::Zero()};
  spring.stiffness = 50;
  spring.damping = 0;
  spring.rest_length = 1;
  w.force(spring);
  const ParticleSystemId thrown =
      add_system(w, system_of({particle_at({0, 5, 0}, 0.01, {3, 0, 0})}, 0, 0));
  VortexDef vortex;  // its flow is still on the axis: linear drag there
  vortex.grip.rate = 0.7;
  vortex.circulation = 0;
  vortex.targets.particles = {thrown};
  w.force(vortex);
  w.run(1);
  const double half = 0.1 * std::cos(std::sqrt(2 * 50 / 2.0));
  CHECK(std::fabs(w->particles(pair)->x[1].x() - (1.1 + half)) < 1e-8);
  CHECK(std::fabs(w->particles(pair)->x[0].x() + half - 0.1) < 1e-8);
  CHECK(std::fabs(w->particles(thrown)->v[0].x() - 3 * std::exp(-0.7)) < 1e-8);
}

TEST_CASE("particles: the books close over bounces and slides, and say what took the energy") {
  TestWorld w(exact_settings());
  slope_under(w, 0, 0.5);
  add_system(w, system_of({particle_at({0, 2.1, 0}, 0.1)}, 0, 0.8));
  add_system(w, system_of({particle_at({5, 0.1, 0}, 0.1, {3, 0, 0})}, 0.5, 0));
  w.run(1);
  const Ledger& books = *w->frame()->ledger;
  CHECK(books.line(LedgerLine::restitution).total().balance ==
        doctest::Approx(-(1 - 0.64) * g * 2).epsilon(1e-6));
  CHECK(books.line(LedgerLine::friction).total().balance ==
        doctest::Approx(-0.5 * 9).epsilon(1e-6));
  CHECK(books.drift() < 1e-9);
}

namespace {

/// Grains that fall on bodies and on each other, some of them on springs.
void mixed_heap(TestWorld& w) {
  slope_under(w, 0.1, 0.6);
  Random random(9);
  std::vector<ParticleDef> grains;
  for (int i = 0; i < 12; ++i)
    grains.push_back(
        particle_at(Vec3(0.3 * (i % 3), 0.9 + 0.3 * (i / 3), 0) + in_ball(random, 0.04), 0.1,
                    in_ball(random, 1), 1 + i));
  const ParticleSystemId id = add_system(w, system_of(grains, 0.4, 0.3));
  w.box({0.3, 0.5, 0}, {0.3, 0.15, 0.3});
  ParticleSystemDef fast = system_of({particle_at({0, 3, 0}, 0.1)}, 0.4, 0.3);
  fast.fast = true;
  const ParticleSystemId apart = add_system(w, fast);
  SpringDef spring;
  spring.a = {Anchor::Kind::particle, {}, id, 1, Vec3::Zero()};
  spring.b = {Anchor::Kind::particle, {}, id, 5, Vec3::Zero()};
  spring.stiffness = 200;
  w.force(spring);
  spring.b = {Anchor::Kind::particle, {}, apart, 1, Vec3::Zero()};
  w.force(spring);
  w.force(LinearDragDef{0.05, 0.05});
}

}  // namespace

TEST_CASE("particles: the same bits for 1, 2 and 4 threads, and after snapshots") {
  std::vector<uint64_t> hashes;
  const int ticks = scaled(60);
  for (const int threads : {1, 2, 4}) {
    TestWorld w(exact_settings(), threads, "law of impulses");
    mixed_heap(w);
    for (int i = 0; i < ticks; ++i) w.step();
    hashes.push_back(w->state_hash());
  }
  CHECK(hashes[1] == hashes[0]);
  CHECK(hashes[2] == hashes[0]);
  TestWorld w(exact_settings(), 1, "law of impulses");
  mixed_heap(w);
  for (int i = 0; i < ticks; ++i) {
    TestWorld other(exact_settings(), 1, "law of impulses");
    REQUIRE(other->load(w->save()).ok());
    w.step();
    other.step();
    REQUIRE(other->state_hash() == w->state_hash());
  }
  CHECK(w->state_hash() == hashes[0]);
}

TEST_CASE("particles: bodies and systems may come and go while particles touch") {
  TestWorld w(exact_settings(), 1, "law of impulses");
  mixed_heap(w);
  const double apart = test::only_to_run() ? 0.2 : 0.5;  // of coming and going [s]
  w.run(apart);
  const ParticleSystemId more = add_system(w, system_of({particle_at({2, 0.5, 1}, 0.1)}, 0.5, 0));
  const BodyId ball = w.sphere({2, 2, 1}, 0.2);
  w.run(apart);
  REQUIRE(w->destroy_body(ball).ok());
  w.run(0.1);
  REQUIRE(w->destroy_particles(more).ok());
  w.run(0.1);
  REQUIRE(w->contact_certificates().ok());
}

TEST_CASE("particles: steppers may be changed while they move") {
  TestWorld w(exact_settings(), 1, "law of impulses");
  mixed_heap(w);
  for (int i = 0; i < 6; ++i) {
    WorldSettings s = w->settings();
    s.stepper = i % 2 ? "event" : "realtime";
    REQUIRE(w->set_settings(s).ok());
    w.run(0.1);
  }
  CHECK(w.step().stats.max_penetration < 2e-3);
}

TEST_CASE("particles: those at one place come apart, at a bounded speed and with their momentum") {
  for (const char* stepper : {"event", "realtime"}) {
    CAPTURE(stepper);
    WorldSettings settings = weightless();
    settings.stepper = stepper;
    TestWorld w(settings);
    const Vec3 v(0, 0, 0.5), away(0.3, 0, 0);
    const ParticleSystemId id = add_system(
        w, system_of({particle_at(Vec3::Zero(), 0.1, v), particle_at(Vec3::Zero(), 0.1, v),
                      particle_at(Vec3::Zero(), 0.1, away, 2)},
                     0, 0));
    const Vec3 momentum = 2 * v + 2 * away;
    const double energy = v.squaredNorm() + away.squaredNorm();
    for (int i = 0; i < 60; ++i) {
      const StepStats stats = w.step().stats;
      REQUIRE(std::isfinite(stats.energies.kinetic));
      CHECK((stats.momentum - momentum).norm() < 1e-6);
    }
    // What works off the overlap is bounded, however deep it was.
    for (const Vec3& now : w->particles(id)->v) CHECK(now.norm() < 4);
    CHECK(w.step().stats.energies.kinetic < 20 * energy);
    // Soft contacts part by their radii within the second; an accepted offset is worked off slowly.
    const double apart = std::string(stepper) == "event" ? 0.04 : 0.19;
    const std::vector<Vec3>& x = w->particles(id)->x;
    for (size_t i = 0; i < x.size(); ++i)
      for (size_t j = 0; j < i; ++j) CHECK((x[i] - x[j]).norm() > apart);
  }
}

TEST_CASE("particles, realtime: collisions with each other and with bodies keep momentum") {
  Random random(17);
  TestWorld w(weightless());
  std::vector<ParticleDef> cloud;
  for (int i = 0; i < 40; ++i) {
    const Vec3 x(0.7 * (i % 4), 0.7 * (i / 4 % 4), 0.7 * (i / 16));
    cloud.push_back(
        particle_at(x, random.uniform(0.1, 0.3), in_ball(random, 2) - x, random.uniform(0.1, 20)));
  }
  const ParticleSystemId id = add_system(w, system_of(cloud, 0.4, 0.5));
  const BodyId a = w.box({-1.5, 0, 0}, {0.3, 0.4, 0.5}), b = w.sphere({4.5, 0.3, 0.1}, 0.5);
  REQUIRE(w->set_velocity(a, {3, 0.5, 0}, {1, 2, 3}).ok());
  REQUIRE(w->set_velocity(b, {-3, 0.5, 0}, {3, 2, 1}).ok());
  w.apply();
  Vec3 before = Vec3::Zero();
  double scale = 0;
  const auto add = [&](double m, const Vec3& v) { before += m * v, scale += m * v.norm(); };
  for (const ParticleDef& p : cloud) add(p.mass, p.v);
  for (const BodyId body : {a, b}) add(w.body(body).mass, w.body(body).v);
  uint64_t contacts = 0;
  for (int i = 0; i < 120; ++i) {
    const StepStats s = w.step().stats;
    CHECK((s.momentum - before).norm() < 1e-6 * scale);
    contacts += s.contacts;
  }
  CHECK(contacts > 20);
  CHECK((w->particles(id)->v[0] - cloud[0].v).norm() > 1e-3);
}

TEST_CASE("particles, realtime: a plank is turned by what falls on it, as the impulse says") {
  TestWorld w(weightless());
  BodyDef plank = TestWorld::box_def(Vec3::Zero(), {1, 0.05, 0.2});
  plank.shapes[0].material.friction = 0;
  const BodyId body = w.add(plank);
  const double m = 5, d = 0.7, v = 4, e = 0.5;
  const ParticleSystemId id =
      add_system(w, system_of({particle_at({d, 0.2, 0}, 0.1, {0, -v, 0}, m)}, 0, e));
  w.run(0.1);
  const RigidBody& b = w.body(body);
  const double J = (1 + e) * v / (1 / m + b.inverse_mass + d * d * b.inverse_inertia_body(2, 2));
  CHECK(w->particles(id)->v[0].y() == doctest::Approx(J / m - v).epsilon(1e-2));
  CHECK(b.v.y() == doctest::Approx(-J * b.inverse_mass).epsilon(1e-2));
  CHECK(b.omega.z() == doctest::Approx(-J * d * b.inverse_inertia_body(2, 2)).epsilon(1e-2));
}

TEST_CASE("particles, realtime: they slide and rest on slopes, and do not pass a thin wall") {
  const double tilt = 0.4, r = 0.05;
  const Vec3 down(-std::cos(tilt), -std::sin(tilt), 0);
  const Vec3 start = r * Vec3(-std::sin(tilt), std::cos(tilt), 0);
  for (const double mu : {0.0, 0.3, 0.6}) {
    CAPTURE(mu);
    TestWorld w;
    slope_under(w, tilt, mu);
    const ParticleSystemId id = add_system(w, system_of({particle_at(start, r)}, mu, 0));
    w.run(2);
    const ParticleSystem& p = *w->particles(id);
    const double a = std::max(0.0, g * (std::sin(tilt) - mu * std::cos(tilt)));
    CHECK((p.v[0] - 2 * a * down).norm() < 2e-3 * std::max(a, 1.0));
    CHECK((p.x[0] - start - 2 * a * down).norm() < 0.02 * std::max(a, 0.1));
  }
  TestWorld w(weightless());
  ShapeDef shape;
  shape.type = ShapeType::triangle_mesh;
  shape.mesh = std::make_shared<const TriangleMesh>(box_mesh({0.001, 1, 1}));
  w.add(TestWorld::shape_def(shape, {1.5, 0, 0}, BodyType::fixed));
  const ParticleSystemId id =
      add_system(w, system_of({particle_at({0, 0.1, 0.2}, 0.005, {150, 0, 0})}, 0, 0.5));
  w.run(0.1);
  CHECK(w->particles(id)->x[0].x() < 1.5);
}

TEST_CASE("particles, realtime: the same bits for 1, 2 and 4 threads, and after snapshots") {
  std::vector<uint64_t> hashes;
  const int ticks = scaled(120);
  for (const int threads : {1, 2, 4}) {
    TestWorld w({}, threads);
    mixed_heap(w);
    for (int i = 0; i < ticks; ++i) w.step();
    hashes.push_back(w->state_hash());
  }
  CHECK(hashes[1] == hashes[0]);
  CHECK(hashes[2] == hashes[0]);
  TestWorld w;
  mixed_heap(w);
  for (int i = 0; i < ticks; ++i) {
    TestWorld other;
    REQUIRE(other->load(w->save()).ok());
    w.step();
    other.step();
    REQUIRE(other->state_hash() == w->state_hash());
  }
}
