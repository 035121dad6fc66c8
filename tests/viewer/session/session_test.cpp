// Reference: a second world stepped by hand with the same commands; the state hash decides.
#include "viewer/app/session/session.hpp"

#include "engine/core/hash.hpp"
#include "engine/scene/pack/pack.hpp"
#include "engine/world/world.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/viewer/cli/program.hpp"
#include "tests/viewer/cli/recorded_run.hpp"
#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/app/window/open_scene.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <chrono>
#include <thread>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

std::unique_ptr<World> falling_ball() {
  WorldDef def;
  def.threads = 1;
  auto world = World::create(def);
  REQUIRE(world.ok());
  BodyDef ball;
  ball.name = "ball";
  ball.pose.x = {0, 50, 0};
  ball.shapes.emplace_back();
  REQUIRE((*world)->create_body(ball).ok());
  REQUIRE((*world)->apply_commands().ok());
  return *std::move(world);
}

uint64_t hash_after(uint64_t ticks) {
  const auto world = falling_ball();
  for (uint64_t i = 0; i < ticks; ++i) REQUIRE(world->step().ok());
  return world->state_hash();
}

uint64_t hash_of(Session& session) {
  return session.call([](World& w) { return w.state_hash(); }).get();
}

/// Waits for what the simulation thread should soon do; false after ten seconds.
template <class F>
bool eventually(F done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (std::chrono::steady_clock::now() < end) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

SessionOptions paused() {
  SessionOptions options;
  options.paused = true;
  options.keyframe_ticks = 7;
  return options;
}

}  // namespace

TEST_CASE("the triple buffer gives the newest value, and keeps the last one") {
  TripleBuffer<int> buffer;
  buffer.publish(1);
  buffer.publish(2);
  CHECK(buffer.latest() == 2);
  CHECK(buffer.latest() == 2);
  buffer.publish(3);
  CHECK(buffer.latest() == 3);

  std::atomic<bool> stop{false};
  std::thread writer([&] {
    for (int i = 4; !stop; ++i) buffer.publish(i);
  });
  int last = 0;
  for (int i = 0; i < 20000; ++i) {
    const int now = buffer.latest();
    CHECK_MESSAGE(now >= last, "an older value came after a newer one");
    last = now;
  }
  stop = true;
  writer.join();
}

TEST_CASE("advance on the caller's thread is stepping the world") {
  Session session(falling_ball(), paused());
  REQUIRE(session.advance(20).ok());
  CHECK(session.world().state_hash() == hash_after(20));
  CHECK(session.counters().tick == 20);
  CHECK(session.view().to->tick == 20);
}

TEST_CASE("steps forward and back land on the same states") {
  Session session(falling_ball(), paused());
  session.start();
  session.step(20);
  CHECK(hash_of(session) == hash_after(20));
  session.step(-5);
  CHECK(hash_of(session) == hash_after(15));
  session.step(-1);
  CHECK(hash_of(session) == hash_after(14));
  session.step(10);
  CHECK(hash_of(session) == hash_after(24));
  session.step(-1000);
  CHECK(hash_of(session) == hash_after(0));
  session.seek(33);
  CHECK(hash_of(session) == hash_after(33));
  session.restart();
  CHECK(hash_of(session) == hash_after(0));
  CHECK(session.paused());
}

TEST_CASE("stepping back and doing something else takes the new course") {
  Session session(falling_ball(), paused());
  session.start();
  session.step(20);
  session.step(-10);
  const auto push = [](World& w) {
    CHECK(w.set_velocity(w.find_body("ball"), Vec3(3, 0, 0), Vec3::Zero()).ok());
  };
  session.post(push);
  session.step(10);
  session.step(-3);
  session.step(3);
  const uint64_t there = hash_of(session);

  const auto world = falling_ball();
  for (int i = 0; i < 10; ++i) REQUIRE(world->step().ok());
  push(*world);
  for (int i = 0; i < 10; ++i) REQUIRE(world->step().ok());
  CHECK(there == world->state_hash());
}

TEST_CASE("stepping back from a restored moment goes the way that led to it") {
  // Pushes at ticks 5 and 12, kept at 20; then another course is taken and left again.
  const auto push = [](double x) {
    return [x](World& w) {
      CHECK(w.set_velocity(w.find_body("ball"), Vec3(x, 0, 0), Vec3::Zero()).ok());
    };
  };
  std::vector<uint64_t> way;
  const auto by_hand = falling_ball();
  for (uint64_t tick = 0; tick <= 30; ++tick) {
    if (tick > 0) REQUIRE(by_hand->step().ok());
    if (tick == 5) push(1)(*by_hand);
    if (tick == 12) push(2)(*by_hand);
    way.push_back(by_hand->state_hash());
  }
  Session session(falling_ball(), paused());
  session.start();
  session.step(5);
  session.post(push(1));
  session.step(7);
  session.post(push(2));
  session.step(8);
  const auto kept = session.keep();
  REQUIRE(hash_of(session) == way[20]);

  SUBCASE("after going on") {
    session.step(25);
  }
  SUBCASE("after going back behind the commands and another way") {
    session.step(-17);
    session.post(push(-7));
    session.step(40);
  }
  SUBCASE("after a restart") {
    session.restart();
  }
  for (int round = 0; round < 2; ++round) {
    session.restore(kept);
    CHECK(hash_of(session) == way[20]);
    for (const uint64_t tick : {19u, 13u, 11u, 6u, 4u, 1u, 0u}) {
      session.seek(tick);
      CHECK_MESSAGE(hash_of(session) == way[tick], "tick ", tick);
      session.restore(kept);
      CHECK(hash_of(session) == way[20]);
    }
    session.step(10);
    CHECK(hash_of(session) == way[30]);
    session.step(-14);
    CHECK(hash_of(session) == way[16]);
  }
  CHECK_FALSE(session.fault());
}

TEST_CASE("a moment is kept with the changes that were made at its tick") {
  Session session(falling_ball(), paused());
  session.start();
  session.step(10);
  session.post([](World& w) {
    CHECK(w.set_velocity(w.find_body("ball"), Vec3(0, 9, 0), Vec3::Zero()).ok());
  });
  const auto kept = session.keep();
  const uint64_t there = hash_of(session);
  session.step(3);
  session.restore(kept);
  CHECK(hash_of(session) == there);
  session.step(3);
  session.step(-3);
  CHECK(hash_of(session) == there);
}

TEST_CASE("views say which world they show") {
  Session session(falling_ball(), paused());
  CHECK(session.view().world == 0);
  const uint64_t number = session.replace(falling_ball());
  CHECK(number != 0);
  CHECK(session.view().world == 0);
  session.start();
  CHECK(eventually([&] { return session.view().world == number; }));
}

TEST_CASE("a change while paused is shown at once, in the order of posting") {
  Session session(falling_ball(), paused());
  session.start();
  for (const double y : {10.0, 20.0, 30.0})
    session.post([y](World& w) {
      Pose pose;
      pose.x = {0, y, 0};
      CHECK(w.set_pose(w.find_body("ball"), pose).ok());
    });
  REQUIRE(eventually([&] { return session.view().to->body(0).pose.x.y() == 30; }));
  CHECK(session.counters().tick == 0);
}

TEST_CASE("a running session keeps real time, and s lies between two frames") {
  Session session(falling_ball());
  session.start();
  REQUIRE(eventually([&] { return session.counters().tick > 12; }));
  for (int i = 0; i < 200; ++i) {
    const SessionView view = session.view();
    REQUIRE(view.from);
    REQUIRE(view.to);
    CHECK(view.s >= 0);
    CHECK(view.s <= 1);
    CHECK(view.to->tick - view.from->tick <= 1);
    std::this_thread::sleep_for(std::chrono::microseconds(300));
  }
  session.set_paused(true);
  const uint64_t tick = session.call([](World& w) { return w.tick(); }).get();
  CHECK(hash_of(session) == hash_after(tick));
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  CHECK(session.counters().tick == tick);
}

TEST_CASE("at a speed that no computer keeps, real time is dropped and not ticks") {
  Session session(falling_ball());
  session.set_speed(1000);
  session.start();
  CHECK(eventually([&] { return session.counters().dropped_seconds > 0; }));
  session.set_paused(true);
  const uint64_t tick = session.call([](World& w) { return w.tick(); }).get();
  CHECK(hash_of(session) == hash_after(tick));
}

TEST_CASE("another world takes the place of the first") {
  Session session(falling_ball(), paused());
  session.start();
  session.step(5);
  const uint64_t before = session.view().generation;
  session.replace(falling_ball());
  CHECK(hash_of(session) == hash_after(0));
  CHECK(session.view().generation != before);
}

TEST_CASE("to the next impact goes to the ticks in which a ball that was dropped bounces") {
  // Dropped through 1 m with restitution 1/2 it strikes after t, 2 t, 2.5 t, ... of t = sqrt(2/g).
  for (const char* stepper : {"event", "realtime"}) {
    CAPTURE(stepper);
    WorldDef def;
    def.threads = 1;
    def.settings.stepper = stepper;
    auto world = World::create(def);
    REQUIRE(world.ok());
    BodyDef ground, ball;
    ground.type = BodyType::fixed;
    ground.shapes.emplace_back().shape.type = ShapeType::half_space;
    ball.pose.x = {0, 1.5, 0};
    ball.shapes.emplace_back().shape.type = ShapeType::sphere;
    ball.shapes.back().shape.radius = 0.5;
    ball.shapes.back().material.restitution = 0.5;
    REQUIRE((*world)->create_body(ground).ok());
    REQUIRE((*world)->create_body(ball).ok());
    REQUIRE((*world)->apply_commands().ok());
    const double t = std::sqrt(2 / (*world)->settings().gravity.now().norm());
    const double tick = (*world)->settings().tick.tick();
    Session session(*std::move(world), paused());
    session.start();
    for (const double at : {t, 2 * t, 2.5 * t}) {
      session.step_to_impact(10);
      const double now = session.call([](World& w) { return w.time(); }).get();
      CHECK(now >= at - (def.settings.stepper == "event" ? 0 : 4 * tick));
      CHECK(now <= at + (def.settings.stepper == "event" ? tick : 4 * tick));
      CHECK(session.paused());
    }
  }
}

namespace {

/// A world whose ticks are slow: every one of many pairs is compared.
std::unique_ptr<World> slow_world() {
  WorldDef def;
  def.threads = 1;
  def.settings.broad_phase = "brute_force";
  auto world = World::create(def);
  REQUIRE(world.ok());
  for (int i = 0; i < 16000; ++i) {
    BodyDef ball;
    ball.pose.x = {double(i % 100), 50, double(i / 100)};
    ball.shapes.emplace_back().shape.type = ShapeType::sphere;
    ball.shapes.back().shape.radius = 0.2;
    REQUIRE((*world)->create_body(ball).ok());
  }
  REQUIRE((*world)->apply_commands().ok());
  return *std::move(world);
}

/// Until a tick has been under way for a while.
bool in_a_tick(Session& session) {
  return eventually([&] { return session.counters().under_way_seconds > 0.02; });
}

}  // namespace

TEST_CASE("a slow tick is given up for going back, for another world, and on demand") {
  // Reference: a world of which no tick was cancelled.
  const auto never = slow_world();
  std::vector<uint64_t> hashes{never->state_hash()};
  const auto as_if_never = [&](Session& session) {
    const auto [tick, hash] =
        session.call([](World& w) { return std::pair(w.tick(), w.state_hash()); }).get();
    while (hashes.size() <= tick) {
      REQUIRE(never->step().ok());
      hashes.push_back(never->state_hash());
    }
    return hash == hashes[tick];
  };

  Session session(slow_world());
  session.start();
  REQUIRE(in_a_tick(session));
  session.cancel_tick();
  CHECK(session.paused());
  CHECK(as_if_never(session));
  CHECK(session.counters().under_way_seconds == 0);
  CHECK_FALSE(session.fault());

  session.step(1000);  // most of them are never begun
  REQUIRE(in_a_tick(session));
  session.restart();
  CHECK(hash_of(session) == hashes[0]);
  CHECK(session.view().to->tick == 0);
  CHECK(session.paused());

  session.step(1);
  CHECK(as_if_never(session));
  CHECK(session.counters().tick == 1);

  const auto kept = session.keep();
  session.set_paused(false);
  REQUIRE(in_a_tick(session));
  session.set_paused(true);
  session.restore(kept);
  CHECK(as_if_never(session));
  CHECK(session.counters().tick == 1);

  session.set_paused(false);
  REQUIRE(in_a_tick(session));
  session.set_paused(true);
  const uint64_t number = session.replace(falling_ball());
  CHECK(hash_of(session) == hash_after(0));
  CHECK(session.view().world == number);
  CHECK_FALSE(session.fault());
}

TEST_CASE("who ends the session in the midst of a slow tick does not wait for the rest") {
  auto session = std::make_unique<Session>(slow_world());
  session->start();
  REQUIRE(in_a_tick(*session));
  session->step(100000);
  const auto start = std::chrono::steady_clock::now();
  session.reset();
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
}

TEST_CASE("a question to the world says that it is asked, and is stopped by itself") {
  Session session(falling_ball(), paused());
  session.start();
  session.step(5);
  std::atomic<bool> begun = false, stopped = false;
  session.ask("how long", [&](const World&) {
    begun = true;
    while (!stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    stopped = true;
  });
  REQUIRE(eventually([&] { return begun.load(); }));
  CHECK(session.counters().asking == "how long");
  CHECK(session.counters().asking_seconds >= 0);
  session.cancel_question();
  REQUIRE(eventually([&] { return stopped.load() && session.counters().asking.empty(); }));
  // The next one is not stopped, and the world is as it was.
  bool asked_to_stop = true;
  session.ask("again", [&](const World&) { asked_to_stop = stop_requested(); });
  CHECK(hash_of(session) == hash_after(5));
  CHECK_FALSE(asked_to_stop);
  // What leaves the moment behind stops it as well, whether it has begun or not.
  begun = stopped = false;
  for (int i = 0; i < 2; ++i)
    session.ask("how long", [&](const World&) {
      begun = true;
      while (!stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      stopped = true;
    });
  REQUIRE(eventually([&] { return begun.load(); }));
  session.restart();
  CHECK(hash_of(session) == hash_after(0));
  CHECK(stopped);
}

TEST_CASE("a replay is played, left by what somebody else does, and taken up when that is undone") {
  const auto push = [](World& w, double v) {
    CHECK(w.set_velocity(w.find_body("ball"), Vec3(v, 0, 0), Vec3::Zero()).ok());
    CHECK(w.apply_commands().ok());
  };
  const auto recorded = falling_ball();
  std::vector<uint64_t> way;
  for (int tick = 0; tick <= 30; ++tick) {
    if (tick == 0 || tick == 12 || tick == 30) push(*recorded, 1 + tick);
    if (tick == 12) push(*recorded, 5);
    way.push_back(recorded->state_hash());
    if (tick < 30) REQUIRE(recorded->step().ok());
  }
  const Bytes bytes = save_replay(*recorded);
  CHECK(run_replay(bytes)->same);
  auto replay = Replay::read(bytes);
  REQUIRE(replay.ok());
  auto world = falling_ball();
  CHECK(replay->begins_as(*world));
  auto player = std::make_shared<ReplayPlayer>(*std::move(replay), "run.bin");
  REQUIRE(player->follow(*world).ok());
  SessionOptions options = paused();
  options.replay = player;
  Session session(std::move(world), options);
  session.start();
  using Course = ReplayPlayer::Course;
  const auto course = [&] {
    (void)hash_of(session);
    return player->course();
  };
  CHECK(hash_of(session) == way[0]);
  for (const int tick : {11, 12, 13, 5, 20, 30}) {
    session.seek(uint64_t(tick));
    CHECK_MESSAGE(hash_of(session) == way[size_t(tick)], tick);
  }
  CHECK(course() == Course::ended_same);
  session.restart();
  CHECK(hash_of(session) == way[0]);
  CHECK(course() == Course::goes_on);
  session.seek(11);
  const auto kept = session.keep();
  session.post([&](World& w) { push(w, 7); });
  CHECK(course() == Course::left);
  session.seek(12);
  CHECK(hash_of(session) != way[12]);
  CHECK(course() == Course::left);
  session.restore(kept);
  CHECK(course() == Course::goes_on);
  session.seek(30);
  CHECK(hash_of(session) == way[30]);
  CHECK(course() == Course::ended_same);
  // Of another world it says so.
  const auto other = falling_ball();
  push(*other, 3);
  CHECK_FALSE(Replay::read(bytes)->begins_as(*other));
}

TEST_CASE("a pack opens in the window with its replay, as the command line plays it") {
  TempFolder folder;
  setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
  const std::string scene = write_text(folder / "s.json", small_scene());
  const auto replay = folder / "run.bin", pack = folder / "s.tumble";
  const std::string last = record(scene, replay, 2);
  auto files = pack_files(scene);
  REQUIRE(files.ok());
  files->push_back({pack_replay_name, *read_file(replay)});
  REQUIRE(write_pack(pack, *files).ok());
  SceneRequest request;
  request.scene = pack.string();
  request.threads = 1;
  auto opened = open_scene(request, 1.6);
  REQUIRE(opened.ok());
  REQUIRE(opened->replay);
  CHECK(opened->warnings.empty());
  SessionOptions options = paused();
  options.replay = opened->replay;
  Session session(std::move(opened->world), options);
  REQUIRE(session.advance(40).ok());
  CHECK(hash_text(session.world().state_hash()) == last);
  CHECK(options.replay->course() == ReplayPlayer::Course::ended_same);
  request.replay.none = true;
  CHECK_FALSE(open_scene(request, 1.6)->replay);
  // With other values it is another run: the scene is there, and says so.
  request.replay.none = false;
  request.overrides = {"bodies.ball.mass=3"};
  opened = open_scene(request, 1.6);
  REQUIRE(opened.ok());
  CHECK_FALSE(opened->replay);
  REQUIRE(opened->warnings.size() == 1);
  CHECK(opened->warnings[0].find("not played") != std::string::npos);
  // One that was asked for by name must be right.
  request.replay.file = replay.string();
  CHECK_FALSE(open_scene(request, 1.6).ok());
}
