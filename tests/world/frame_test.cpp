// Published frames. Reference: the world's own bodies, and pointer identity for what must be
// shared.
#include "tests/support/test_world.hpp"

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
  w.run(3);
  CHECK(w->frame()->stats.awake == 0);
  const auto a = w->frame();
  w.step();
  const auto b = w->frame();
  CHECK(a->chunks == b->chunks);
  CHECK(a->contacts == b->contacts);
  REQUIRE(w->set_velocity(a->info(1).id, {0, 2, 0}, Vec3::Zero()).ok());
  w.step();
  CHECK(w->frame()->chunks[0] != b->chunks[0]);
  CHECK(w->frame()->chunks[1] == b->chunks[1]);
}
