// A steady tick of the realtime stepper takes nothing from the heap. Reference: the allocator
// itself, which this executable counts the calls of.
#include "tests/support/allocations.hpp"

#include "engine/math/rotation.hpp"
#include "engine/scene/workloads/run.hpp"
#include "tests/support/test_world.hpp"

#include <memory>
#include <numbers>
#include <vector>

#include <malloc.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// A tick whose frame somebody looks at.
void tick(World& world) {
  REQUIRE(world.step().ok());
  REQUIRE(world.frame()->tick == world.tick());
}

size_t allocations_in(World& world, int ticks) {
  return AllocationCount::during([&] {
    for (int i = 0; i < ticks; ++i) tick(world);
  });
}

void check_steady(World& world, int warm_up) {
  for (int i = 0; i < warm_up; ++i) tick(world);
  CHECK(allocations_in(world, 20) == 0);
}

/// A thread that comes late makes its scratch memory when it comes, and so do more contacts than
/// there ever were.
void check_soon_steady(World& world, int warm_up) {
  for (int i = 0; i < warm_up; ++i) tick(world);
  size_t last = 1;
  for (int i = 0; i < 20 && last > 0; ++i) last = allocations_in(world, 20);
  CHECK(last == 0);
}

void check_workload(std::string_view name, int warm_up, int threads = 1) {
  CAPTURE(name);
  CAPTURE(threads);
  for (const WorkloadEntry& entry : all_workloads()) {
    if (entry.name != name) continue;
    WorldDef def;
    def.threads = threads;
    const auto built = build_workload(make_workload(entry, true), def);
    REQUIRE(built.ok());
    (threads == 1 ? check_steady : check_soon_steady)(*built->world, warm_up);
    return;
  }
  FAIL("no such workload");
}

}  // namespace

TEST_CASE("the counter counts") {
  std::vector<int>* made = nullptr;
  CHECK(AllocationCount::during([&] { made = new std::vector<int>(100); }) == 2);
  CHECK(AllocationCount::during([&] { delete made; }) == 0);
}

TEST_CASE("a steady tick allocates nothing: boxes, balls, joints") {
  check_workload("W1", 60);   // one pile
  check_workload("W2", 60);   // many islands
  check_workload("W4", 200);  // contacts of one point
  check_workload("W5", 60);   // ball joints
  check_workload("W6", 400);  // hinges, capsules
}

TEST_CASE("a steady tick allocates nothing: a door whose hinges share its load") {
  TestWorld w;
  BodyDef def = TestWorld::box_def({0.5, 1, 0}, {0.5, 1, 0.02});
  def.can_sleep = false;
  const BodyId door = w.add(def);
  for (const double y : {0.3, 1.7}) {
    JointDef hinge;
    hinge.kind = JointKind::revolute;
    hinge.b = door;
    hinge.frame_a.x = Vec3(0, y, 0);
    hinge.frame_b.x = Vec3(-0.5, y - 1, 0);
    hinge.frame_a.q = hinge.frame_b.q = axis_angle(Vec3::UnitX(), -0.5 * std::numbers::pi);
    REQUIRE(w->create_joint(hinge).ok());
  }
  check_steady(*w.world, 60);
  const auto frame = w->frame();
  CHECK(frame->joints->at(0).mean_force.y() ==
        doctest::Approx(frame->joints->at(1).mean_force.y()).epsilon(1e-6));
}

TEST_CASE("a steady tick of several threads allocates nothing: W1 and W4") {
  check_workload("W1", 60, 3);
  check_workload("W4", 200, 3);
}

TEST_CASE("a steady tick allocates nothing: drag, wind, dust, a turning table") {
  TestWorld w;
  w.ground();
  BodyDef table = TestWorld::box_def({0, 0.5, 0}, {4, 0.5, 4});
  table.type = BodyType::kinematic;
  table.angular_velocity = {0, 0.2, 0};
  w.add(table);
  for (int i = 0; i < 49; ++i) w.box({-3.0 + i % 7, 1.3, -3.0 + int(i / 7)}, {0.25, 0.25, 0.25});
  w.force(LinearDragDef{.rate = 0.1, .angular_rate = 0.1});
  w.force(WindDef{});
  ParticleSystemDef dust;
  dust.name = "dust with a name that is too long to be stored in place";
  dust.collide = false;
  dust.particles.resize(200);
  for (size_t i = 0; i < 200; ++i) dust.particles[i].x = {0.01 * double(i), 20, 0};
  REQUIRE(w->create_particles(dust).ok());
  check_soon_steady(*w.world, 120);  // boxes slide off now and then: now more contacts, now fewer
}

TEST_CASE("a steady tick allocates nothing: gravity and a moved body that follow expressions") {
  const auto course = [](const char* text) {
    auto made = TimeCourse::expression(text, {{"size", 0.5}});
    REQUIRE(made.ok());
    return *std::move(made);
  };
  const TimeCourse swing = course("size * sin(2*pi*t) * min(1, max(t, 0.1)) + 0*size*t");
  double value = 0;
  CHECK(AllocationCount::during([&] { value = swing.at(0.3); }) == 0);
  CHECK(value != 0);
  WorldSettings settings;
  settings.gravity = {course("0.1*sin(t)"), course("-9.81 + size*cos(3*t)"), 0};
  TestWorld w(settings);
  w.ground();
  for (int i = 0; i < 20; ++i) w.box({2.0 * i, 0.25, 0}, {0.25, 0.25, 0.25});
  BodyDef paddle = TestWorld::box_def({0, 3, 0}, {0.5, 0.1, 0.1});
  paddle.type = BodyType::kinematic;
  BodyCourse path;
  path.x[0] = std::make_shared<const TimeCourse>(swing);
  path.angle = path.x[0];
  paddle.course = std::make_shared<const BodyCourse>(path);
  w.add(paddle);
  check_steady(*w.world, 60);
}

TEST_CASE("a steady tick allocates nothing: motors that follow expressions") {
  const auto course = TimeCourse::expression("0.5 * sin(3*t)", {});
  REQUIRE(course.ok());
  TestWorld w;
  std::vector<BodyId> wheels;
  for (const MotorKind kind : {MotorKind::position, MotorKind::velocity, MotorKind::force}) {
    const double x = double(wheels.size());
    wheels.push_back(w.box({x, 1, 0}, {0.1, 0.1, 0.1}));
    JointDef hinge;
    hinge.kind = JointKind::revolute;
    hinge.b = wheels.back();
    hinge.frame_a.x = {x, 1, 0};
    CoordinateMotor& motor = hinge.drives[0].motor;
    motor.kind = kind;
    motor.stiffness = 50, motor.damping = 2;
    motor.course = std::make_shared<const TimeCourse>(*course);
    REQUIRE(w->create_joint(hinge).ok());
  }
  check_steady(*w.world, 60);
  for (const BodyId wheel : wheels) CHECK(w.body(wheel).omega.norm() > 0.1);
}

TEST_CASE("a steady tick allocates nothing: particles are born and die") {
  TestWorld w;
  ParticleSystemDef dust;
  dust.collide = false;
  dust.fast = true;
  const auto system = w->create_particles(dust);
  REQUIRE(system.ok());
  EmitterDef spark;
  spark.particles = *system;
  spark.life = {0.2};
  const auto sparks = w->create_emitter(spark);
  REQUIRE(sparks.ok());
  EmitterDef jet = spark;
  jet.rate = 600;
  jet.bursts = {{0.5, 20, 100, 0.1}};
  jet.life = {0.5, 0.1};
  jet.size_over_life = {1, 0.5};
  jet.events = {{SpawnRule::On::death, *sparks, 2, 0, false}};
  REQUIRE(w->create_emitter(jet).ok());
  SinkDef sink;
  sink.pose.x = {0, -1, 0};
  REQUIRE(w->create_sink(sink).ok());
  check_steady(*w.world, 240);
}

TEST_CASE("a steady tick allocates nothing: nets of springs") {
  for (const int count : {7, 49}) {
    CAPTURE(count);
    TestWorld w;
    w.ground();
    std::vector<BodyId> bodies;
    for (int i = 0; i < count; ++i)
      bodies.push_back(w.box({double(i), 0.25, 0}, {0.25, 0.25, 0.25}));
    for (size_t i = 1; i < bodies.size(); ++i) {
      SpringDef spring;
      spring.a.kind = spring.b.kind = Anchor::Kind::body;
      spring.a.body = bodies[i - 1];
      spring.b.body = bodies[i];
      spring.stiffness = 10;
      spring.rest_length = 1;
      w.force(spring);
    }
    check_steady(*w.world, 60);
  }
}

TEST_CASE("a steady tick allocates nothing: a sleeping world, and one that is half asleep") {
  TestWorld w;
  w.ground();
  for (int i = 0; i < 100; ++i) w.box({2.0 * i, 0.5, 0});
  w.run(3);
  REQUIRE(w->frame()->stats.awake == 0);
  check_steady(*w.world, 10);
  const BodyId ball = w.sphere({0, 60, 20});
  w.run(0.2);
  REQUIRE(w->frame()->stats.awake == 1);
  check_steady(*w.world, 10);
  CHECK(w.body(ball).awake());
}

TEST_CASE("frames that somebody looks at stay what they are, and cost what they must") {
  TestWorld w;
  w.ground();
  const BodyId b = w.sphere({0, 60, 0});
  w.run(0.5);
  const auto held = w->frame();
  const double y = held->body(b.index).pose.x.y();
  CHECK(allocations_in(*w.world, 5) > 0);  // frames that are not used again
  CHECK(allocations_in(*w.world, 20) == 0);
  CHECK(held->body(b.index).pose.x.y() == y);
  CHECK(w.body(b).pose.x.y() < y);
}

namespace {

double heap_now() {
  const struct mallinfo2 info = mallinfo2();
  return double(info.uordblks + info.hblkhd);
}

}  // namespace

TEST_CASE("what the world says of its memory is most of what the heap gave it") {
  // The rest is the log of commands, the broad phase, the frame's small parts and what vectors
  // within vectors hold.
  for (const char* name : {"W1", "W4", "W6"}) {
    CAPTURE(name);
    for (const WorkloadEntry& entry : all_workloads()) {
      if (entry.name != name) continue;
      const Workload w = make_workload(entry, true);
      const double before = heap_now();
      const auto built = build_workload(w, {});
      REQUIRE(built.ok());
      for (int i = 0; i < 100; ++i) tick(*built->world);
      const double taken = heap_now() - before;
      const MemoryUse use = built->world->memory_use();
      const double said = double(use.bodies + use.contacts + use.joints);
      CHECK(said < taken);
      CHECK(said > 0.6 * taken);
      CHECK(use.contacts > 100 * built->world->frame()->stats.contacts);
      CHECK(use.bodies > sizeof(RigidBody) * w.bodies.size());
    }
  }
}
