// Moments that are saved to be shown again. Reference: the frame that the world had then, compared
// member by member.
#include "engine/world/shown_state.hpp"

#include "engine/world/particle_frames.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <vector>

using namespace tumble;
using namespace tumble::test;

namespace {

/// Bodies that fall on each other, come and go, drops that touch them and tell where.
void fill_shown(TestWorld& w) {
  w.ground();
  for (int i = 0; i < 3; ++i) w.add(TestWorld::box_def({0.1 * i, 0.6 + 1.1 * i, 0}, {1, 1, 1}));
  ParticleSystemDef drops;
  drops.name = "drops";
  drops.fast = true;
  drops.detect = true;
  drops.look.colour_by = ParticleQuantity::speed;
  const auto system = w->create_particles(drops);
  REQUIRE(system.ok());
  w.apply();
  EmitterDef tap;
  tap.name = "tap";
  tap.particles = *system;
  tap.pose.x = {0, 5, 0};
  tap.shape = DiscEmission{1};
  tap.rate = 200;
  tap.speed = {-3};
  tap.life = {2};
  REQUIRE(w->create_emitter(tap).ok());
  EmitterDef crates;
  crates.name = "crate";
  crates.body = std::make_shared<const BodyDef>(TestWorld::box_def({0, 0, 0}, {0.3, 0.3, 0.3}));
  crates.pose.x = {2, 2, 0};
  crates.rate = 5;
  crates.life = {0.7};
  REQUIRE(w->create_emitter(crates).ok());
  w.apply();
}

void check_same_bodies(const Frame& a, const Frame& b) {
  REQUIRE(a.body_slots() == b.body_slots());
  for (size_t slot = 0; slot < a.body_slots(); ++slot) {
    const BodyFrame &p = a.body(slot), &q = b.body(slot);
    REQUIRE(p.id == q.id);
    CHECK(p.pose.x == q.pose.x);
    CHECK(p.pose.q.coeffs() == q.pose.q.coeffs());
    CHECK(p.v == q.v);
    CHECK(p.omega == q.omega);
    CHECK(p.island == q.island);
    CHECK(p.asleep == q.asleep);
    CHECK(p.jumped == q.jumped);
    if (p.id.is_null()) continue;
    CHECK(a.info(slot).name == b.info(slot).name);
    CHECK(a.info(slot).mass == b.info(slot).mass);
    CHECK(a.info(slot).look.colour == b.info(slot).look.colour);
    REQUIRE(a.info(slot).shapes.size() == b.info(slot).shapes.size());
  }
}

void check_same_contacts(const Frame& a, const Frame& b) {
  const auto p = a.all_contacts(), q = b.all_contacts();
  REQUIRE(p.size() == q.size());
  for (size_t i = 0; i < p.size(); ++i) {
    CHECK(p[i].a == q[i].a);
    CHECK(p[i].b == q[i].b);
    CHECK(p[i].x_world == q[i].x_world);
    CHECK(p[i].gap == q[i].gap);
    CHECK(p[i].impulse == q[i].impulse);
  }
  REQUIRE(bool(a.particle_contacts) == bool(b.particle_contacts));
  if (!a.particle_contacts) return;
  REQUIRE(a.particle_contacts->size() == b.particle_contacts->size());
  for (size_t i = 0; i < a.particle_contacts->size(); ++i) {
    const ParticleContactFrame &c = (*a.particle_contacts)[i], &d = (*b.particle_contacts)[i];
    CHECK(c.particle == d.particle);
    CHECK(c.body == d.body);
    CHECK(c.x_world == d.x_world);
    CHECK(c.time == d.time);
    CHECK(c.apart_again == d.apart_again);
  }
}

void check_same_particles(const Frame& a, const Frame& b) {
  REQUIRE(a.particles.size() == b.particles.size());
  for (size_t k = 0; k < a.particles.size(); ++k) {
    const ParticleFrame &p = *a.particles[k], &q = *b.particles[k];
    CHECK(p.name == q.name);
    CHECK(p.x == q.x);
    CHECK(p.ids == q.ids);
    CHECK(p.radius == q.radius);
    CHECK(p.colour == q.colour);
    CHECK(p.value == q.value);
    CHECK(p.range.low == q.range.low);
    CHECK(p.range.high == q.range.high);
  }
}

}  // namespace

TEST_CASE("a moment that is shown again has the frame of then, and goes on as it did") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    WorldSettings settings;
    settings.stepper = stepper;
    TestWorld w(settings), later(settings);
    fill_shown(w);
    size_t contacts = 0, new_ones = 0;
    for (int n = 0; n < 45; ++n) {
      if (n % 3 == 0) {
        const auto frame = w->frame();
        const auto shown = load_shown(*later.world, save_shown(*w.world, false));
        REQUIRE_MESSAGE(shown.ok(), test::why_not(shown));
        CHECK((*shown)->tick == frame->tick);
        CHECK((*shown)->time == frame->time);
        CHECK((*shown)->stats.bodies == frame->stats.bodies);
        CHECK(later->state_hash() == w->state_hash());
        check_same_bodies(*frame, **shown);
        check_same_contacts(*frame, **shown);
        check_same_particles(*frame, **shown);
        contacts += frame->particle_contacts ? frame->particle_contacts->size() : 0;
        for (size_t slot = 0; slot < frame->body_slots(); ++slot)
          new_ones += frame->body(slot).jumped;
      }
      w.step();
    }
    CHECK(contacts > 0);
    CHECK(new_ones > 0);
  }
}

TEST_CASE("damaged bytes of a shown state are an error, and leave the world alone") {
  TestWorld w;
  fill_shown(w);
  w.run(0.2);
  Bytes bytes = save_shown(*w.world, false);
  const uint64_t hash = w->state_hash();
  for (const size_t size : {size_t{0}, size_t{7}, size_t{40}, bytes.size() / 2})
    CHECK_FALSE(load_shown(*w.world, std::span(bytes).first(size)).ok());
  CHECK(w->state_hash() == hash);
  CHECK(load_shown(*w.world, bytes).ok());
}

TEST_CASE("particles are shown in another way than they were simulated with") {
  TestWorld w;
  fill_shown(w);
  w.run(0.5);
  ParticleFrame frame = *w->frame()->particles[0];
  ParticleLook look;
  look.colour_by = ParticleQuantity::age;
  look.low = 0, look.high = 2;
  const ParticleSystem& system = *w->particles(frame.id);
  show_particles_as(
      look, system, [&w](EmitterId id) { return w->emitter(id); }, frame);
  REQUIRE(frame.value.size() == system.size());
  for (size_t i = 0; i < system.size(); ++i) CHECK(frame.value[i] == float(system.age[i]));
  CHECK(frame.range.high == 2);
  look = {};
  look.style = ParticleStyle::smoke;
  show_particles_as(
      look, system, [&w](EmitterId id) { return w->emitter(id); }, frame);
  CHECK(frame.value.empty());
  CHECK(frame.opacity == std::vector<float>(system.size(), 0.4f));
}
