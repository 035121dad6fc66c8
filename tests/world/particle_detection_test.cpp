// Contacts of particles in the frames of a world. Reference: paths without gravity, whose contacts
// with planes, balls and moving sheets follow by hand.
#include "engine/core/random.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>

using namespace tumble;
using namespace tumble::test;

namespace {

ParticleSystemId dust(TestWorld& w, std::vector<ParticleDef> particles, bool detect = true) {
  ParticleSystemDef def;
  def.gravity_scale = 0;
  def.detect = detect;
  def.collide = false;
  def.particles = std::move(particles);
  const auto id = w->create_particles(std::move(def));
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  return *id;
}

const std::vector<ParticleContactFrame>& contacts(const TestWorld& w) {
  const auto& found = w.world->frame()->particle_contacts;
  REQUIRE(found);
  return *found;
}

bool has_stage(const StepReport& report) {
  return std::any_of(report.stats.stages.begin(), report.stats.stages.end(),
                     [](const StageTime& s) { return s.name == "particle contacts"; });
}

/// The ticks of these tests.
constexpr double tick = 1.0 / 60;

}  // namespace

TEST_CASE("particles meet the ground, a thin plate and each other within one tick") {
  TestWorld w;
  const BodyId ground = w.ground();
  BodyDef plate = TestWorld::box_def({10, 5, 0}, {1, 0.0001, 1});
  plate.type = BodyType::fixed;
  const BodyId plate_id = w.add(plate);
  const auto first = dust(w, {{.x = {0, 0.5, 0}, .v = {0, -60, 0}, .radius = 0.1},
                              {.x = {10, 6, 0}, .v = {0, -180, 0}, .radius = 0.01},
                              {.x = {20, 5, 0}, .v = {0, 0, 0}, .radius = 0.1}});
  const auto second = dust(w, {{.x = {21, 5, 0}, .v = {-120, 0, 0}, .radius = 0.2}});
  // One that does not look for contacts, in the middle of another.
  dust(w, {{.x = {20, 5, 0}, .radius = 0.5}}, false);
  const StepReport report = w.step();
  CHECK(has_stage(report));
  const auto& found = contacts(w);
  REQUIRE(found.size() == 3);

  CHECK(found[0].system == first);
  CHECK(found[0].particle == 0);
  CHECK(found[0].body == ground);
  CHECK_FALSE(found[0].apart_again);
  CHECK(found[0].gap == doctest::Approx(-0.6));
  CHECK(found[0].time == doctest::Approx(0.4 * tick).epsilon(1e-5));
  CHECK(found[0].normal.y() == doctest::Approx(-1));
  CHECK((found[0].x_world - Vec3(0, 0, 0)).norm() < 1e-9);

  CHECK(found[1].particle == 1);
  CHECK(found[1].body == plate_id);
  CHECK(found[1].apart_again);
  CHECK(found[1].gap == 0);
  CHECK(found[1].time == doctest::Approx((1 - 0.0101) / 180).epsilon(1e-5));
  CHECK((found[1].x_world - Vec3(10, 5.0001, 0)).norm() < 1e-5);

  CHECK(found[2].particle == 2);
  CHECK(found[2].body.is_null());
  CHECK(found[2].other == second);
  CHECK(found[2].other_particle == 0);
  CHECK(found[2].apart_again);
  CHECK(found[2].time == doctest::Approx(0.7 / 120));
  CHECK(found[2].normal.x() == doctest::Approx(1));
}

TEST_CASE("a mesh that is swept over a still particle meets it") {
  TestWorld w;
  BodyDef fan =
      TestWorld::shape_def({.type = ShapeType::triangle_mesh,
                            .mesh = std::make_shared<const TriangleMesh>(
                                make_mesh::terrain(4, 4, [](double, double) { return 0.0; }))},
                           {0, 0, 0}, BodyType::kinematic);
  fan.angular_velocity = {0, 0, 60};  // a radian in the tick
  const BodyId id = w.add(fan);
  const double rho = 1.2, phi = 0.6, radius = 0.05;
  dust(w, {{.x = {rho * std::cos(phi), rho * std::sin(phi), 0.1}, .radius = radius},
           {.x = {0, 1.2, 0.1}, .radius = radius}});
  w.step();
  const auto& found = contacts(w);
  REQUIRE(found.size() == 1);
  CHECK(found[0].body == id);
  CHECK(found[0].particle == 0);
  CHECK(found[0].apart_again);
  CHECK(found[0].time == doctest::Approx((phi - std::asin(radius / rho)) / 60).epsilon(1e-4));
}

TEST_CASE("no system detects: no contacts, no stage, commands clear them") {
  TestWorld w;
  const BodyId ground = w.ground();
  const auto quiet = dust(w, {{.x = {0, 0, 0}, .radius = 1}}, false);
  CHECK_FALSE(has_stage(w.step()));
  CHECK_FALSE(w->frame()->particle_contacts);
  dust(w, {{.x = {0, 0, 0}, .radius = 1}});
  w.step();
  CHECK(contacts(w).size() == 1);
  REQUIRE(w->destroy_body(ground).ok());
  REQUIRE(w->destroy_particles(quiet).ok());
  w.apply();
  CHECK_FALSE(w->frame()->particle_contacts);
  w.step();
  CHECK(contacts(w).empty());
}

TEST_CASE("the same contacts for any number of threads, and after loading a snapshot") {
  const auto make = [](int threads) {
    TestWorld w({}, threads);
    w.ground();
    Random r(5);
    for (int i = 0; i < 20; ++i) {
      BodyDef def = TestWorld::box_def({r.uniform(-2, 2), r.uniform(1, 4), r.uniform(-2, 2)},
                                       {0.3, 0.2, 0.4});
      def.angular_velocity = {r.uniform(-9, 9), r.uniform(-9, 9), r.uniform(-9, 9)};
      w.add(def);
    }
    ParticleSystemDef cloud;
    cloud.detect = true;
    cloud.collide = false;
    for (int i = 0; i < scaled(3000); ++i)
      cloud.particles.push_back({.x = {r.uniform(-2, 2), r.uniform(0, 4), r.uniform(-2, 2)},
                                 .v = {r.uniform(-9, 9), r.uniform(-9, 9), r.uniform(-9, 9)},
                                 .radius = r.uniform(0.01, 0.04)});
    REQUIRE(w->create_particles(cloud).ok());
    w.apply();
    return w;
  };
  const auto same = [](const TestWorld& a, const TestWorld& b) {
    const auto &x = contacts(a), &y = contacts(b);
    REQUIRE(x.size() == y.size());
    for (size_t k = 0; k < x.size(); ++k) {
      const bool equal = x[k].particle == y[k].particle && x[k].body == y[k].body &&
                         x[k].other_particle == y[k].other_particle && x[k].gap == y[k].gap &&
                         x[k].time == y[k].time && x[k].x_world == y[k].x_world &&
                         x[k].normal == y[k].normal && x[k].apart_again == y[k].apart_again;
      if (!equal) FAIL_CHECK("contact ", k, " differs");
    }
  };
  TestWorld one = make(1), two = make(2), loaded;
  for (int k = 0; k < 3; ++k) {
    one.step();
    two.step();
    same(one, two);
  }
  if (scaled(100) == 100) CHECK(contacts(one).size() > 100);
  const Bytes saved = one->save();
  REQUIRE(loaded->load(saved).ok());
  CHECK_FALSE(loaded->frame()->particle_contacts);
  one.step();
  loaded.step();
  same(one, loaded);
  CHECK(one->state_hash() == loaded->state_hash());
}
