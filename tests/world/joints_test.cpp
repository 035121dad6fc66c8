// Joints of a world as commands and state. References: the generational rules of ids, equality of
// bits between a run and its repetition from a snapshot, and statics (a hung body's
// weight).
#include "engine/world/world.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

BodyDef ball(const Vec3& x) {
  BodyDef d;
  d.pose.x = x;
  d.shapes.emplace_back();
  d.shapes[0].shape.type = ShapeType::sphere;
  d.shapes[0].shape.radius = 0.1;
  d.mass = 2;
  return d;
}

JointDef ball_joint(BodyId a, BodyId b, const Vec3& on_a, const Vec3& on_b) {
  JointDef d;
  d.a = a;
  d.b = b;
  d.frame_a.x = on_a;
  d.frame_b.x = on_b;
  return d;
}

/// Two balls hung on each other and on the world at the origin; the second begins aside.
struct HungBalls {
  std::unique_ptr<World> world;
  BodyId first, second;
  JointId top, low;

  explicit HungBalls(bool aside = true, const char* stepper = "realtime", int threads = 0) {
    WorldDef def;
    def.settings.stepper = stepper;
    def.threads = threads;
    auto made = World::create(def);
    REQUIRE(made.ok());
    world = std::move(*made);
    first = *world->create_body(ball({0, -1, 0}));
    second = *world->create_body(ball(aside ? Vec3(1, -1, 0) : Vec3(0, -2, 0)));
    top = *world->create_joint(ball_joint({}, first, Vec3::Zero(), {0, 1, 0}));
    const Vec3 on_second = aside ? Vec3(-1, 0, 0) : Vec3(0, 1, 0);
    low = *world->create_joint(ball_joint(first, second, Vec3::Zero(), on_second));
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) REQUIRE(world->step().ok());
  }
};

}  // namespace

TEST_CASE("joints hold bodies, and frames show where and how strongly") {
  HungBalls w(false);
  w.run(30);
  const auto& joints = *w.world->frame()->joints;
  REQUIRE(joints.size() == 2);
  CHECK(joints[0].id == w.top);
  CHECK(joints[1].a == w.first);
  CHECK((joints[0].frame_b.x - joints[0].frame_a.x).norm() < 1e-5);
  CHECK(joints[0].mean_force.y() == doctest::Approx(4 * 9.81).epsilon(1e-6));
  CHECK(joints[1].mean_force.y() == doctest::Approx(2 * 9.81).epsilon(1e-6));
}

TEST_CASE("a world with joints goes on from its snapshot with the same bits") {
  HungBalls w;
  w.run(40);
  const Bytes snapshot = w.world->save();
  auto copy = World::create();
  REQUIRE(copy.ok());
  REQUIRE((*copy)->load(snapshot).ok());
  w.run(60);
  for (int i = 0; i < 60; ++i) REQUIRE((*copy)->step().ok());
  CHECK((*copy)->state_hash() == w.world->state_hash());
  HungBalls again;
  again.run(100);
  CHECK(again.world->state_hash() == w.world->state_hash());
}

TEST_CASE("commands of joints that wait are in the snapshot too") {
  HungBalls w;
  const Bytes waiting = w.world->save();
  auto copy = World::create();
  REQUIRE(copy.ok());
  REQUIRE((*copy)->load(waiting).ok());
  w.run(30);
  for (int i = 0; i < 30; ++i) REQUIRE((*copy)->step().ok());
  CHECK((*copy)->state_hash() == w.world->state_hash());
  CHECK((*copy)->frame()->joints->size() == 2);
}

TEST_CASE("joints go with their bodies, and their ids are then stale") {
  HungBalls w;
  w.run(5);
  REQUIRE(w.world->destroy_body(w.first).ok());
  CHECK_FALSE(w.world->destroy_joint(w.top).ok());
  CHECK_FALSE(w.world->set_joint(w.low, JointDef{}).ok());
  // The slots are given out again at once, while the old joints are still there.
  const BodyId third = *w.world->create_body(ball({0, 3, 0}));
  const auto next = w.world->create_joint(ball_joint({}, third, {0, 3, 0}, Vec3::Zero()));
  REQUIRE(next.ok());
  CHECK_FALSE(*next == w.top);
  w.run(5);
  CHECK(w.world->joint(w.top) == nullptr);
  CHECK(w.world->frame()->joints->size() == 1);
  CHECK((w.world->body(third)->pose.x - Vec3(0, 3, 0)).norm() < 1e-5);
  CHECK(w.world->body(w.second)->v.y() < -0.5);
}

TEST_CASE("joints can be changed and destroyed, what hung on them wakes and falls") {
  HungBalls w(false);
  w.run(120);
  REQUIRE(w.world->body(w.second)->asleep);
  JointDef longer = *w.world->joint(w.low);
  longer.kind = JointKind::distance;
  longer.length = 1.5;
  longer.frame_b.x.setZero();
  REQUIRE(w.world->set_joint(w.low, longer).ok());
  w.run(120);
  CHECK(w.world->body(w.second)->pose.x.y() == doctest::Approx(-2.5).epsilon(1e-3));
  REQUIRE(w.world->destroy_joint(w.low).ok());
  w.run(30);
  CHECK(w.world->body(w.second)->pose.x.y() < -3);
  CHECK(w.world->body(w.first)->pose.x.y() == doctest::Approx(-1).epsilon(1e-3));
}

TEST_CASE("a joint bears nothing once neither of its bodies can move") {
  for (const char* stepper : {"realtime", "event"}) {
    INFO(stepper);
    HungBalls w(false, stepper);
    w.run(60);
    const auto load = [&w](size_t joint) {
      return w.world->frame()->joints->at(joint).mean_force.norm();
    };
    CHECK(load(0) == doctest::Approx(2 * 2 * 9.81).epsilon(1e-3));
    BodyDef held = *w.world->body_def(w.first);
    held.pose = w.world->frame()->body(w.first.index).pose;
    held.type = BodyType::fixed;
    REQUIRE(w.world->set_body(w.first, held).ok());
    w.run(30);
    CHECK(load(0) == 0);
    CHECK(load(1) == doctest::Approx(2 * 9.81).epsilon(1e-3));
  }
}

TEST_CASE("joints that cannot be are refused when they are asked for") {
  HungBalls w;
  CHECK_FALSE(w.world->create_joint(ball_joint({}, {}, Vec3::Zero(), Vec3::Zero())).ok());
  CHECK_FALSE(w.world->create_joint(ball_joint(w.first, w.first, Vec3::Zero(), Vec3::Zero())).ok());
  REQUIRE(w.world->destroy_body(w.second).ok());
  const auto gone =
      w.world->create_joint(ball_joint(w.first, w.second, Vec3::Zero(), Vec3::Zero()));
  REQUIRE_FALSE(gone.ok());
  CHECK(gone.error().text().find("does not exist") != std::string::npos);
}

TEST_CASE("jointed worlds under the event stepper go on from snapshots with the same bits") {
  HungBalls w(true, "event", 1);
  w.run(20);
  auto copy = World::create();
  REQUIRE(copy.ok());
  REQUIRE((*copy)->load(w.world->save()).ok());
  w.run(20);
  for (int i = 0; i < 20; ++i) REQUIRE((*copy)->step().ok());
  CHECK((*copy)->state_hash() == w.world->state_hash());
  for (const int threads : {2, 4}) {
    HungBalls other(true, "event", threads);
    other.run(40);
    CHECK(other.world->state_hash() == w.world->state_hash());
  }
}

TEST_CASE("joints hold while the stepper is changed from one to the other and back") {
  HungBalls w;
  double gap = 0;
  for (const char* stepper : {"realtime", "event", "realtime", "event"}) {
    WorldSettings settings = w.world->settings();
    settings.stepper = stepper;
    REQUIRE(w.world->set_settings(settings).ok());
    for (int i = 0; i < 30; ++i) {
      w.run(1);
      gap = 0;
      for (const JointFrame& j : *w.world->frame()->joints)
        gap = std::max(gap, (j.frame_b.x - j.frame_a.x).norm());
      CHECK(gap < 1e-3);
    }
  }
  CHECK(gap < 1e-12);
}

TEST_CASE("event: what joints do between bodies is nothing, and to the world their reaction") {
  HungBalls w(false, "event");
  w.run(60);
  const Ledger& still = *w.world->frame()->ledger;
  const LedgerEntry held = still.line(LedgerLine::joints).total();
  CHECK(std::fabs(held.work) < 1e-12);
  CHECK(held.momentum.y() == doctest::Approx(4 * 9.81).epsilon(1e-9));
  HungBalls swing(true, "event");
  swing.run(60);
  const Ledger& books = *swing.world->frame()->ledger;
  CHECK(std::fabs(books.line(LedgerLine::joints).total().balance) < 1e-4);
  CHECK(books.drift() < 1e-3);
  Vec3 momentum = Vec3::Zero();
  for (size_t i = 0; i < ledger_lines; ++i) momentum += books.line(LedgerLine(i)).total().momentum;
  CHECK((momentum - books.now().momentum).norm() < 1e-12);
}

TEST_CASE("event: the reaction of a physical pendulum is in the balance of its certificate") {
  WorldDef def;
  def.settings.stepper = "event";
  def.settings.tick.num = 480;
  auto world = std::move(*World::create(def));
  BodyDef rod;
  rod.shapes.emplace_back();
  rod.shapes[0].shape.type = ShapeType::box;
  rod.shapes[0].shape.half_extents = {0.5, 0.05, 0.05};
  rod.mass = 2;
  rod.pose.x = {0.5, 0, 0};
  const BodyId id = *world->create_body(rod);
  JointDef pivot;
  pivot.kind = JointKind::revolute;
  pivot.b = id;
  pivot.frame_b.x = {-0.5, 0, 0};
  REQUIRE(world->create_joint(pivot).ok());
  for (int i = 0; i < 200; ++i) REQUIRE(world->step().ok());
  const auto certificates = world->contact_certificates();
  REQUIRE(certificates.ok());
  REQUIRE(certificates->bodies.size() == 1);
  const BodyBalance& balance = certificates->bodies[0];
  CHECK(balance.residual < 1e-12);
  // m (a - g) with a = alpha x c - omega^2 c, alpha = -m g c cos / I, omega^2 = 2 m g c sin / I.
  const double m = 2, c = 0.5, g = 9.81, inertia = m * ((1 + 0.01) / 12 + 0.25);
  const Vec3 arm = world->body(id)->pose.x;
  const double alpha = -m * g * arm.x() / inertia, square = -2 * m * g * arm.y() / inertia;
  CHECK(arm.norm() == doctest::Approx(c).epsilon(1e-12));
  const Vec3 want = m * (Vec3(0, 0, alpha).cross(arm) - square * arm + Vec3(0, g, 0));
  CHECK((balance.joint_force - want).norm() < 1e-6 * want.norm());
}
