// Snapshot, replay and rewind. Reference: the same world never saved; equality is of bytes.
#include "engine/collision/broad_phase.hpp"
#include "engine/core/random.hpp"
#include "engine/world/keyframes.hpp"
#include "engine/world/replay.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

/// A small pile with everything in it: bodies that collide, a spring, drag, particles.
void fill(TestWorld& w) {
  w.ground();
  Random random(7);
  BodyId last;
  for (int i = 0; i < 20; ++i) {
    const double x = random.uniform(-0.6, 0.6), z = random.uniform(-0.6, 0.6);
    last = i % 2 ? w.box({x, 0.6 + 0.8 * i, z}, {0.3, 0.2, 0.4})
                 : w.sphere({x, 0.6 + 0.8 * i, z}, 0.3);
  }
  SpringDef spring;
  spring.a.point = Vec3(0, 12, 0);
  spring.b.kind = Anchor::Kind::body;
  spring.b.body = last;
  w.force(spring);
  w.force(LinearDragDef{0.05, 0.05});
  ParticleSystemDef particles;
  particles.particles.resize(10);
  for (int i = 0; i < 10; ++i) particles.particles[size_t(i)].x = {3, 0.1 + 0.3 * i, 0.01 * i};
  REQUIRE(w->create_particles(particles).ok());
  w.apply();
}

std::unique_ptr<World> loaded(const Bytes& snapshot, int threads = 1) {
  WorldDef def;
  def.threads = threads;
  auto made = World::create(std::move(def));
  REQUIRE(made.ok());
  const Status s = (*made)->load(snapshot);
  REQUIRE_MESSAGE(s.ok(), test::why_not(s));
  return std::move(*made);
}

}  // namespace

TEST_CASE(
    "a loaded snapshot has the same future, after each of 60 ticks, and saves the same bytes") {
  TestWorld w;
  fill(w);
  for (int i = 0; i < 60; ++i) {
    const Bytes before = w->save();
    auto copy = loaded(before);
    // The length of the replay log is the one thing a fresh world cannot have.
    CHECK(copy->state_hash() == w->state_hash());
    w.step();
    REQUIRE(copy->step().ok());
    CHECK(copy->state_hash() == w->state_hash());
    const Bytes a = loaded(w->save())->save(), b = loaded(copy->save())->save();
    CHECK_MESSAGE(first_difference(a, b).empty(), "tick ", i, ": section ", first_difference(a, b));
  }
}

TEST_CASE("results are the same bits for 1, 2 and 4 threads") {
  std::vector<uint64_t> hashes;
  for (const int threads : {1, 2, 4}) {
    TestWorld w({}, threads);
    fill(w);
    w.run(3);
    hashes.push_back(w->state_hash());
  }
  CHECK(hashes[1] == hashes[0]);
  CHECK(hashes[2] == hashes[0]);
}

TEST_CASE("two worlds side by side do not know of each other") {
  TestWorld alone;
  fill(alone);
  alone.run(1);
  TestWorld a, b;
  fill(a);
  fill(b);
  REQUIRE(b->apply_impulse(b->frame()->info(2).id, Vec3(50, 0, 0), Vec3::Zero()).ok());
  for (int i = 0; i < 60; ++i) {
    a.step();
    b.step();
  }
  CHECK(a->state_hash() == alone->state_hash());
  CHECK(b->state_hash() != alone->state_hash());
}

TEST_CASE("commands wait in the queue of a snapshot") {
  TestWorld w;
  w.ground();
  const BodyId b = w.sphere({0, 1, 0});
  REQUIRE(w->set_velocity(b, {3, 0, 0}, Vec3::Zero()).ok());
  auto copy = loaded(w->save());
  w.step();
  REQUIRE(copy->step().ok());
  CHECK(copy->body(b)->v.x() == w.body(b).v.x());
  CHECK(copy->body(b)->v.x() > 2);
}

TEST_CASE("step back and restart by keyframes give the bits of the first time, edits included") {
  TestWorld w;
  fill(w);
  KeyframeRing ring(size_t{1} << 20, 10);
  ring.reset(*w.world);
  std::vector<uint64_t> hashes = {w->state_hash()};
  for (int i = 0; i < 100; ++i) {
    if (i == 37) {
      REQUIRE(w->apply_impulse(w->frame()->info(3).id, Vec3(200, 100, 0), Vec3(0, 1, 0)).ok());
      w.box({0, 8, 0});
    }
    w.step();
    ring.after_step(*w.world);
    hashes.push_back(w->state_hash());
  }
  for (const uint64_t tick : {99u, 98u, 61u, 40u, 38u, 36u, 5u, 0u}) {
    const Status s = ring.seek(*w.world, tick);
    REQUIRE_MESSAGE(s.ok(), test::why_not(s));
    CHECK(w->tick() == tick);
    CHECK(w->state_hash() == hashes[tick]);
  }
}

TEST_CASE("going back to a tick finds it with what was changed at it, a restart without") {
  TestWorld w;
  fill(w);
  KeyframeRing ring(size_t{1} << 20, 10);
  ring.reset(*w.world);
  const uint64_t untouched = w->state_hash();
  // Changes at the first tick, at one with a keyframe and at one between two.
  std::vector<uint64_t> left;
  for (uint64_t tick = 0; tick <= 30; ++tick) {
    if (tick > 0) {
      w.step();
      ring.after_step(*w.world);
    }
    if (tick == 0 || tick == 10 || tick == 17) {
      w.box({0, 9, double(tick)});
      REQUIRE(w->apply_commands().ok());
    }
    left.push_back(w->state_hash());
  }
  for (const uint64_t tick : {25u, 17u, 16u, 10u, 9u, 0u}) {
    REQUIRE(ring.seek(*w.world, tick).ok());
    CHECK_MESSAGE(w->state_hash() == left[tick], "tick ", tick);
  }
  REQUIRE(ring.restart(*w.world).ok());
  CHECK(w->tick() == 0);
  CHECK(w->state_hash() == untouched);
  CHECK(ring.count() == 1);
}

TEST_CASE("the keyframe ring keeps its budget and its first frame") {
  TestWorld w;
  fill(w);
  KeyframeRing ring(200000, 1);
  ring.reset(*w.world);
  const uint64_t first = w->state_hash();
  for (int i = 0; i < 200; ++i) {
    w.step();
    ring.after_step(*w.world);
  }
  CHECK(ring.bytes() <= 200000 + 40000);
  REQUIRE(ring.seek(*w.world, 0).ok());
  CHECK(w->state_hash() == first);
}

TEST_CASE("a replay log runs to the same hash in a fresh world") {
  TestWorld w;
  fill(w);
  for (int i = 0; i < 90; ++i) {
    if (i == 20) w.box({0.2, 6, 0});
    if (i == 40) REQUIRE(w->destroy_body(w->frame()->info(5).id).ok());
    if (i == 50) {
      WorldSettings s = w->settings();
      s.gravity = Vec3(1, -5, 0);
      s.broad_phase = "brute_force";
      REQUIRE(w->set_settings(s).ok());
    }
    w.step();
  }
  const Bytes replay = save_replay(*w.world);
  auto again = run_replay(replay);
  REQUIRE_MESSAGE(again.ok(), test::why_not(again));
  CHECK(again->same);
  CHECK(again->world->state_hash() == w->state_hash());
}

TEST_CASE("the broad phase is switched while a world runs, and no bit changes") {
  TestWorld still, switched;
  fill(still);
  fill(switched);
  const auto& list = all_broad_phases();
  for (size_t i = 0; i < 40 * list.size(); ++i) {
    if (i % 20 == 0) {
      // Settings are hashed too, so both worlds get the command and differ in the middle only.
      WorldSettings s = switched->settings();
      s.broad_phase = list[i / 20 % list.size()].name;
      REQUIRE(switched->set_settings(s).ok());
    }
    still.step();
    switched.step();
  }
  WorldSettings s = switched->settings();
  s.broad_phase = still->settings().broad_phase;
  REQUIRE(switched->set_settings(s).ok());
  still.step();
  switched.step();
  CHECK(switched->state_hash() == still->state_hash());
}

TEST_CASE("damaged snapshots and replays are refused and change nothing") {
  TestWorld w;
  fill(w);
  w.run(0.2);
  const Bytes good = w->save();
  const uint64_t hash = w->state_hash();
  Random random(3);
  const size_t stride = std::max<size_t>(1, good.size() / size_t(test::scaled(300)));
  for (size_t n = 0; n < good.size(); n += stride) {
    const Bytes cut(good.begin(), good.begin() + std::ptrdiff_t(n));
    CHECK_FALSE(w->load(cut).ok());
    CHECK(w->state_hash() == hash);
  }
  CHECK_FALSE(run_replay(std::span(good)).ok());
  CHECK_FALSE(run_replay({}).ok());
}
