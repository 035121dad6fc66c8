// What frames say of how particles look. References: values by hand, and that the look changes
// nothing of the motion.
#include "engine/dynamics/particles/fluid_def.hpp"
#include "tests/support/test_world.hpp"

#include <cmath>

using namespace tumble;
using test::TestWorld;

namespace {

ParticleSystemDef three_balls() {
  ParticleSystemDef def;
  def.name = "three";
  def.collide = false;
  def.particles.resize(3);
  for (int i = 0; i < 3; ++i) {
    def.particles[size_t(i)].x = Vec3(i, 5, 0);
    def.particles[size_t(i)].v = Vec3(i, 0, 0);
  }
  return def;
}

}  // namespace

TEST_CASE("colours by speed: the value of each particle, and the range that there has been") {
  TestWorld w;
  ParticleSystemDef def = three_balls();
  def.look.colour_by = ParticleQuantity::speed;
  REQUIRE(w->create_particles(def).ok());
  w.apply();
  const auto first = w->frame()->particles.front();
  REQUIRE(first->value.size() == 3);
  CHECK(first->value[2] == doctest::Approx(2));
  CHECK(first->range.low == 0);
  CHECK(first->range.high == 2);
  w.run(1);
  const auto fallen = w->frame()->particles.front();
  for (int i = 0; i < 3; ++i)
    CHECK(double(fallen->value[size_t(i)]) == doctest::Approx(std::hypot(i, 9.81)).epsilon(0.01));
  CHECK(fallen->range.low == 0);  // as at the start
  CHECK(fallen->range.high == doctest::Approx(std::hypot(2, 9.81)).epsilon(0.01));
}

TEST_CASE("a look has a range of its own, says nothing unless asked, and moves nothing") {
  TestWorld plain, coloured;
  ParticleSystemDef def = three_balls();
  REQUIRE(plain->create_particles(def).ok());
  def.look.colour_by = ParticleQuantity::age;
  def.look.low = 1;
  def.look.high = 3;
  REQUIRE(coloured->create_particles(def).ok());
  plain.run(0.5);
  coloured.run(0.5);
  CHECK(plain->frame()->particles.front()->value.empty());
  const auto frame = coloured->frame()->particles.front();
  CHECK(double(frame->value[0]) == doctest::Approx(0.5));
  CHECK(frame->range.low == 1);
  CHECK(frame->range.high == 3);
  CHECK(plain->state_hash() == coloured->state_hash());
}

TEST_CASE("what has been seen comes back with a snapshot, whoever asked for frames") {
  ParticleSystemDef def = three_balls();
  def.look.colour_by = ParticleQuantity::speed;
  def.particles[1].v = Vec3(0, 9, 0);  // fastest at the start
  TestWorld w;
  REQUIRE(w->create_particles(def).ok());
  w.run(0.75);
  const auto bytes = w->save();
  TestWorld other;
  REQUIRE(other->load(bytes).ok());
  CHECK(other->frame()->particles.front()->range.high == w->frame()->particles.front()->range.high);
  CHECK(w->frame()->particles.front()->range.high > 8.8);
  CHECK(double(w->frame()->particles.front()->value[1]) < 2);
}

TEST_CASE("density and pressure are of fluids, a range must rise, only spheres are coloured") {
  TestWorld w;
  ParticleSystemDef def = three_balls();
  def.look.colour_by = ParticleQuantity::pressure;
  CHECK_FALSE(w->create_particles(def).ok());
  def.look.colour_by = ParticleQuantity::speed;
  def.look.low = 2;
  CHECK_FALSE(w->create_particles(def).ok());
  def.look.low = 0;
  def.look.style = ParticleStyle::smoke;
  CHECK_FALSE(w->create_particles(def).ok());
  def.look = {};
  def.look.opacity = 1.5;
  CHECK_FALSE(w->create_particles(def).ok());
}

TEST_CASE("a fluid's surface has velocities and densities, smoke its opacity and age") {
  TestWorld w;
  ParticleSystemDef water;
  water.name = "water";
  water.collide = false;
  water.fluid = std::make_shared<const FluidDef>();
  water.look.style = ParticleStyle::surface;
  for (int i = 0; i < 1000; ++i) {
    ParticleDef p;
    p.x = 0.1 * Vec3(i % 10, i / 10 % 10, i / 100);
    p.mass = 1;
    p.radius = 0.05;
    water.particles.push_back(p);
  }
  REQUIRE(w->create_particles(water).ok());
  ParticleSystemDef smoke = three_balls();
  smoke.look.style = ParticleStyle::smoke;
  smoke.look.opacity = 0.7;
  REQUIRE(w->create_particles(smoke).ok());
  w.run(0.1);
  const auto frame = w->frame();
  const ParticleFrame& liquid = *frame->particles[0];
  REQUIRE(liquid.share.size() == 1000);
  CHECK(double(liquid.v[500].y()) == doctest::Approx(-0.981).epsilon(0.05));
  CHECK(double(liquid.share[555]) == doctest::Approx(1).epsilon(0.03));  // inside
  CHECK(liquid.share[0] < 0.7f);                                         // at a corner
  const ParticleFrame& puffs = *frame->particles[1];
  REQUIRE(puffs.opacity.size() == 3);
  CHECK(puffs.opacity[0] == 0.7f);
  CHECK(double(puffs.age[0]) == doctest::Approx(0.1));
}
