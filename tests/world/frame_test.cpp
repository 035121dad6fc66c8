// Published frames. Reference: the world's own bodies, and pointer identity for what must be
// shared.
#include "tests/support/test_world.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

TEST_CASE("a frame is what the world was, and stays so") {
  TestWorld w;
  w.ground();
  const BodyId b = w.sphere({0, 5, 0});
  const auto first = w->frame();
  CHECK(first->body(b.index).pose.x.y() == 5);
  CHECK(first->body(b.index).jumped);
  w.run(0.5);
  CHECK(first->body(b.index).pose.x.y() == 5);
  CHECK(w->frame()->body(b.index).pose.x.y() == w.body(b).pose.x.y());
  CHECK_FALSE(w->frame()->body(b.index).jumped);
  CHECK(w->frame()->infos == first->infos);
}

TEST_CASE("poses between frames are interpolated, but not across a jump") {
  TestWorld w;
  const BodyId b = w.sphere({0, 5, 0});
  w.step();
  const auto f0 = w->frame();
  w.step();
  const auto f1 = w->frame();
  const double mid = 0.5 * (f0->body(b.index).pose.x.y() + f1->body(b.index).pose.x.y());
  CHECK(interpolated_pose(*f0, *f1, b.index, 0.5).x.y() == doctest::Approx(mid).epsilon(1e-14));
  REQUIRE(w->set_pose(b, {Vec3(0, 100, 0), Quat::Identity()}).ok());
  w.step();
  const auto f2 = w->frame();
  CHECK(f2->body(b.index).jumped);
  CHECK(interpolated_pose(*f1, *f2, b.index, 0.5).x.y() == f2->body(b.index).pose.x.y());
}

TEST_CASE("a sleeping world shares its chunks and contacts between frames") {
  TestWorld w;
  w.ground();
  for (int i = 0; i < 100; ++i) w.box({2.0 * i, 0.5, 0});
  CHECK(w->frame()->body(3).jumped);  // said once: from here on they are not new
  w.run(3);
  CHECK(w->frame()->stats.awake == 0);
  const auto a = w->frame();
  w.step();
  const auto b = w->frame();
  CHECK(a->chunks == b->chunks);
  CHECK(a->contacts == b->contacts);
  CHECK(a->resting_contacts == b->resting_contacts);
  CHECK(a->all_contacts().size() == 400);
  REQUIRE(w->set_velocity(a->info(1).id, {0, 2, 0}, Vec3::Zero()).ok());
  w.step();
  CHECK(w->frame()->chunks[0] != b->chunks[0]);
  CHECK(w->frame()->chunks[1] == b->chunks[1]);
}

TEST_CASE(
    "that a body is new is said once, also where nobody looked for a while and nothing moves") {
  TestWorld w;
  w.ground();
  BodyDef def = TestWorld::box_def({0, 0.5, 0});
  def.starts_asleep = true;
  const BodyId b = w.add(def);
  for (int i = 0; i < 3; ++i) w.step();
  CHECK(w->frame()->body(b.index).jumped);
  for (int i = 0; i < 3; ++i) {
    w.step();
    CHECK_FALSE(w->frame()->body(b.index).jumped);
  }
  CHECK(w->frame()->stats.awake == 0);
}

TEST_CASE(
    "after a tick that fails the frame is that of the last good one, asked for before or not") {
  // Reference: the same world, of which every frame is asked for.
  const auto fail_at_last = [](bool looks) {
    TestWorld w;
    w.ground();
    w.box({0, 0.5, 0});
    const BodyId b = w.sphere({0, 5, 0});
    QuadraticDragDef drag;
    drag.fluid_density = 1;
    const ForceId force = w.force(drag);
    for (int i = 0; i < 30; ++i) {
      w.step();
      if (looks) w->frame();
    }
    drag.fluid_density = 1e300;
    REQUIRE(w->set_force(force, drag).ok());
    REQUIRE(w->set_velocity(b, {1e150, 0, 0}, Vec3::Zero()).ok());
    CHECK_FALSE(w->step().ok());
    return w->frame();
  };
  const auto seen = fail_at_last(true), unseen = fail_at_last(false);
  CHECK(unseen->tick == 30);
  CHECK(seen->tick == 30);
  CHECK(unseen->stats.contacts == seen->stats.contacts);
  CHECK(unseen->stats.contacts > 0);
  CHECK(unseen->all_contacts().size() == seen->all_contacts().size());
  CHECK(unseen->ledger->throughput() == seen->ledger->throughput());
  CHECK(unseen->ledger->line(LedgerLine::gravity).tick.work ==
        seen->ledger->line(LedgerLine::gravity).tick.work);
  CHECK(unseen->ledger->line(LedgerLine::gravity).tick.work != 0);
  for (size_t i = 0; i < 3; ++i) CHECK(unseen->body(i).pose.x == seen->body(i).pose.x);
}

TEST_CASE("a still world repeats its frames: they say what whole ticks would") {
  // Reference: a world that goes back to where it is before every tick, and knows nothing of the
  // one before.
  TestWorld w, whole;
  for (TestWorld* each : {&w, &whole}) {
    each->ground();
    BodyDef gate = TestWorld::box_def({-3, 0.5, 0});
    gate.type = BodyType::kinematic;  // one that stands is as still as what sleeps
    for (int i = 0; i < 70; ++i) each->box({2.0 * i, 0.5, 0});
    each->add(gate);
    CHECK((*each)->frame()->body(2).jumped);  // said once: from here on they are not new
    each->run(3);
    REQUIRE((*each)->frame()->stats.awake == 0);
  }
  for (int k = 0; k < 5; ++k) {
    const auto last = w->frame();
    w.step();
    REQUIRE(whole->rewind(whole->save()).ok());
    whole.step();
    const auto a = w->frame(), b = whole->frame();
    CHECK(a->chunks == last->chunks);
    CHECK(a->stats.stages.size() == 1);  // it was not computed anew
    CHECK(a->tick == b->tick);
    CHECK(a->time == b->time);
    CHECK(a->stats.energies.total() == b->stats.energies.total());
    CHECK(a->stats.contact_points == b->stats.contact_points);
    CHECK(a->all_contacts().size() == b->all_contacts().size());
    CHECK(a->ledger->throughput() == b->ledger->throughput());
    CHECK(w->state_hash() == whole->state_hash());
  }
  CHECK(w->save() == whole->save());
  for (TestWorld* each : {&w, &whole})
    REQUIRE((*each)->set_velocity((*each)->frame()->info(3).id, {2, 3, 0}, Vec3::Zero()).ok());
  for (int k = 0; k < 60; ++k) {
    w.step(), whole.step();
    REQUIRE(w->state_hash() == whole->state_hash());
  }
  CHECK(w.body(w->frame()->info(4).id).pose.x.x() != 6.0);  // it was hit
}

TEST_CASE("a world with a moving body is not taken for still, nor one in gusts") {
  TestWorld w;
  w.ground();
  const BodyId box = w.box({0, 0.5, 0});
  BodyDef pusher = TestWorld::box_def({-3, 0.5, 0}, {1, 1, 1});
  pusher.type = BodyType::kinematic;
  pusher.velocity = {0.25, 0, 0};
  w.add(pusher);
  w.run(14);
  CHECK(w.body(box).pose.x.x() > 0.4);
  TestWorld windy;
  windy.ground();
  const BodyId sail = windy.box({0, 0.05, 0}, {1, 0.05, 1});
  windy.run(3);
  REQUIRE(windy->frame()->stats.awake == 0);
  WindDef wind;
  wind.gusts = 0.5;
  windy.force(wind);
  windy.run(1);
  CHECK(windy->frame()->stats.awake == 1);
  CHECK(windy.body(sail).awake());
}

TEST_CASE("the energy of a published body counts the products of its inertia") {
  // Two boxes of one body off all planes of symmetry; it spins about a skew axis and turns while it
  // does. References: the statistics, which sum in world axes, and the sum over a fine grid of mass
  // points of 1/2 m |omega x r|^2, whose error is (1/32)^2.
  WorldSettings settings;
  settings.gravity = Vec3::Zero();
  TestWorld w(settings);
  BodyDef def = TestWorld::box_def({0, 0, 0}, {1, 0.2, 0.3});
  BodyShapeDef arm = def.shapes[0];
  arm.shape.half_extents = {0.2, 0.8, 0.25};
  arm.pose.x = {0.7, 1.0, 0.4};
  def.shapes.push_back(arm);
  def.velocity = {1, -2, 0.5};
  def.angular_velocity = {0.9, -1.3, 2.1};
  const BodyId b = w.add(def);
  const auto first = w->frame();
  const Mat3& inertia = first->info(b.index).inertia;
  CHECK(std::abs(inertia(0, 1)) > 0.1 * inertia.diagonal().maxCoeff());
  double spin = 0;
  for (const BodyShapeDef& part : def.shapes) {
    constexpr int n = 32;
    const Vec3 h = part.shape.half_extents;
    const double m = part.material.density * 8 * h.prod() / (n * n * n);
    for (int i = 0; i < n * n * n; ++i) {
      const Vec3 cell(i % n, i / n % n, i / n / n);
      const Vec3 x = part.pose.x + h.cwiseProduct((2 * cell + Vec3::Ones()) / n - Vec3::Ones());
      spin +=
          0.5 * m * def.angular_velocity.cross(x - first->info(b.index).centre_body).squaredNorm();
    }
  }
  const double v2 = first->body(b.index).v.squaredNorm();
  const double total = spin + 0.5 * first->info(b.index).mass * v2;
  CHECK(kinetic_energy(first->body(b.index), first->info(b.index)) ==
        doctest::Approx(total).epsilon(2e-3));
  for (int i = 0; i < 60; ++i) {
    const auto report = w.step();
    const auto frame = w->frame();
    CHECK(kinetic_energy(frame->body(b.index), frame->info(b.index)) ==
          doctest::Approx(report.stats.energies.kinetic).epsilon(1e-12));
  }
  CHECK(w->frame()->infos == first->infos);
}
