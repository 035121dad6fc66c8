// Reference: places by hand, and the state hash before an undo step and after it was taken back.
#include "engine/world/world.hpp"
#include "tests/viewer/ui/session_rig.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

BodyDef def_of(Rig& rig, std::string_view name) {
  World& world = rig.app->session().world();
  const auto def = world.body_def(world.find_body(name));
  REQUIRE_MESSAGE(def.has_value(), name);
  return *def;
}
bool there(Rig& rig, std::string_view name) {
  return !rig.app->session().world().find_body(name).is_null();
}
uint64_t hash_of(Rig& rig) {
  return rig.app->session().world().state_hash();
}
bool selected(Rig& rig, std::string_view name) {
  return rig.app->selection().contains(rig.app->session().world().find_body(name));
}

}  // namespace

TEST_CASE("Ctrl selects more, a box what is in it, and Del deletes all of them as one undo step") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 3\nkey Space\nclick body:box\nhold Ctrl\nclick body:ball\nlet Ctrl\nwait 2");
  CHECK(rig.app->selection().size() == 2);
  CHECK(selected(rig, "box"));
  CHECK(rig.app->selected() == rig.app->session().world().find_body("ball"));
  rig.play("hold Ctrl\nclick body:ball\nlet Ctrl\nwait 2");
  CHECK(rig.app->selection().size() == 1);
  CHECK(selected(rig, "box"));
  rig.play("key Esc\nwait 2");
  CHECK(rig.app->selection().empty());
  rig.play(
      "hold Ctrl\nmove 300,60\npress left\nby 300 200\nby 500 500\nrelease left\nlet Ctrl\nwait 2");
  CHECK(rig.app->selection().size() == 2);
  const uint64_t whole = hash_of(rig);
  rig.play("key Del\nwait 2");
  CHECK_FALSE(there(rig, "box"));
  CHECK_FALSE(there(rig, "ball"));
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(hash_of(rig) == whole);
  rig.play("key Esc\nkey Ctrl+A\nwait 2");
  CHECK(rig.app->selection().size() == 2);
  CHECK_FALSE(selected(rig, "ground"));
  check_no_faults(*device);
}

TEST_CASE("an arm moves all that is selected, in one undo step, and the file learns of it") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play(
      "wait 3\nkey Space\nclick body:ball\nhold Ctrl\nclick body:box\nlet Ctrl\nkey G\nwait 2");
  const uint64_t before = hash_of(rig);
  const Vec3 box = def_of(rig, "box").pose.x, ball = def_of(rig, "ball").pose.x;
  rig.play("drag handle:x 60 0\nwait 2");
  const Vec3 way = def_of(rig, "box").pose.x - box;
  CHECK(way.x() > 0.3);
  CHECK(std::abs(way.y()) + std::abs(way.z()) < 1e-12);
  CHECK((def_of(rig, "ball").pose.x - ball - way).norm() < 1e-12);
  CHECK(rig.app->selection().size() == 2);
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(says(rig, "Taken back: Move box and 1 more"));
  CHECK(hash_of(rig) == before);
  // With Ctrl held in whole steps.
  rig.play(
      "move handle:y\npress left\nhold Ctrl\nby 0 -30\nby 0 -31\nrelease left\nlet Ctrl\nwait 2");
  const double up = def_of(rig, "box").pose.x.y();
  CHECK(up - box.y() > 0.2);
  CHECK(std::abs(up / 0.1 - std::round(up / 0.1)) < 1e-9);
  check_no_faults(*device);
}

TEST_CASE("a body that is dragged stands on the face under the pointer") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 3\nkey Space\nclick body:ball\nkey G\nwait 2");
  const auto box = rig.app->locate("body:box");
  const auto ball = rig.app->locate("body:ball");
  REQUIRE(box);
  REQUIRE(ball);
  // The handles' middle is at the ball's centre: taken beside it. To the top of the box.
  rig.play("move " + std::to_string(ball->x + 16) + "," + std::to_string(ball->y + 12) +
           "\npress left\nby -5 5\nmove " + std::to_string(box->x) + "," + std::to_string(box->y) +
           "\nwait 1\nrelease left\nwait 2");
  const Vec3 at = def_of(rig, "ball").pose.x, on = def_of(rig, "box").pose.x;
  // The box of 1 m shows its front: the ball of .5 m touches it there.
  CHECK(std::abs(at.z() - on.z() - 1) < 1e-6);
  CHECK(std::abs(at.x() - on.x()) < 0.5);
  check_no_faults(*device);
}

TEST_CASE(
    "a body that was not selected is dragged itself, and not by an arm drawn after the press") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 3\nkey Space\nclick body:box\nkey G\nwait 2");
  const auto ball = rig.app->locate("body:ball");
  const auto box = rig.app->locate("body:box");
  REQUIRE(ball);
  REQUIRE(box);
  const Vec3 before = def_of(rig, "ball").pose.x;
  // Above the ball's middle, where its arm along y will be.
  rig.play("move " + std::to_string(ball->x) + "," + std::to_string(ball->y - 14) +
           "\npress left\nby -5 5\nmove " + std::to_string(box->x) + "," + std::to_string(box->y) +
           "\nwait 1\nrelease left\nwait 2");
  CHECK(std::abs(def_of(rig, "ball").pose.x.x() - before.x()) > 1);
  check_no_faults(*device);
}

TEST_CASE("a drag that moves nothing is no undo step and changes no state") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 60\nkey Space\nclick body:box\nkey G\nwait 2");
  const uint64_t before = hash_of(rig);
  rig.play("move handle:y\nwait 1\npress left\nby 0 0\nwait 2\nrelease left\nwait 2");
  CHECK(hash_of(rig) == before);
  // There and back.
  rig.play(
      "move handle:y\nwait 1\npress left\nby 0 -40\nwait 2\nby 0 40\nwait 2\nrelease left\nwait 2");
  CHECK(hash_of(rig) == before);
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(says(rig, "There is nothing to take back"));
  check_no_faults(*device);
}

TEST_CASE("near the horizon nothing is dragged, pasted or built out of sight") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 3\nkey Space\nclick body:ball\nkey Ctrl+C\nwait 2");
  // The ground a little below the horizon is some hundred metres away.
  const Camera& camera = rig.app->camera().camera();
  const Vec3 far = project(camera, camera.eye + Vec3(0, -2, -200), 1400, 900);
  const std::string there = std::to_string(far.x()) + "," + std::to_string(far.y());
  rig.play("move " + there + "\nwait 1\nkey Ctrl+V\nwait 3");
  const Vec3 pasted = rig.app->session().world().body_def(rig.app->selected())->pose.x;
  CHECK((pasted - camera.eye).norm() < 2.5 * (camera.target - camera.eye).norm());
  const Vec3 before = def_of(rig, "ball").pose.x;
  rig.play(
      "key Esc\nclick body:ball\nkey G\nwait 2\nmove body:ball\nby 25 12\npress left\nby 5 "
      "5\nmove " +
      there + "\nwait 1\nrelease left\nwait 2");
  const Vec3 after = def_of(rig, "ball").pose.x;
  CHECK((after - camera.eye).norm() < 2.6 * (camera.target - camera.eye).norm());
  CHECK((after - before).norm() < 15);
  check_no_faults(*device);
}

TEST_CASE("while time runs a body is held where it is dragged to, and falls when it is let go") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 3\nclick body:box\nkey G\nwait 2\nmove handle:y\npress left\nby 0 -50\nby 0 -60");
  const double high = def_of(rig, "box").pose.x.y();
  CHECK(high > 1.2);
  rig.play("wait 30");
  CHECK(std::abs(def_of(rig, "box").pose.x.y() - high) < 0.02);
  rig.play("release left\nwait 30");
  CHECK(def_of(rig, "box").pose.x.y() < high - 0.3);
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(says(rig, "Taken back: Move box"));
  check_no_faults(*device);
}

TEST_CASE("rings turn, the middle scales, and numbers are typed") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.play("wait 3\nkey Space\nkey B\nwait 3\nclick body:box\nwait 2\nclick arrange.turn\nwait 2");
  const Quat before = def_of(rig, "box").pose.q;
  rig.play("drag handle:z 30 30\nwait 2");
  const Quat q = def_of(rig, "box").pose.q * before.conjugate();
  CHECK(std::abs(q.z()) > 0.05);
  CHECK(std::abs(q.x()) + std::abs(q.y()) < 1e-12);
  rig.play("key Ctrl+Z\nkey X\nwait 2\ndrag handle:middle 120 0\nwait 2");
  CHECK(def_of(rig, "box").shapes[0].shape.half_extents.x() == doctest::Approx(1).epsilon(0.02));
  rig.play(
      "key Ctrl+Z\nwait 2\ndouble_click arrange.times\ntext 3\nkey Enter\nwait 2\n"
      "click arrange.apply\nwait 2");
  CHECK((def_of(rig, "box").shapes[0].shape.half_extents - Vec3::Constant(1.5)).norm() < 1e-12);
  const auto edits = rig.app->session().world().body(rig.app->selected())->mass;
  CHECK(edits == doctest::Approx(27 * 1000));
  rig.play("key X\nwait 2");
  CHECK(rig.app->ui_state().handles.kind == HandleKind::none);
  check_no_faults(*device);
}

TEST_CASE("bodies with their joints and springs are pasted, in another scene too") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 3\nkey Space\nwait 2");
  World& first = rig.app->session().world();
  JointDef joint;
  joint.name = "hinge";
  joint.kind = JointKind::revolute;
  joint.a = first.find_body("box");
  joint.b = first.find_body("ball");
  joint.frame_a.x = Vec3(1, 1.75, 0);
  joint.frame_b.x = Vec3(-1, -1.75, 0);
  rig.app->session().post([joint](World& world) { CHECK(world.create_joint(joint).ok()); });
  SpringDef spring;
  spring.a.kind = spring.b.kind = Anchor::Kind::body;
  spring.a.body = joint.a;
  spring.b.body = joint.b;
  rig.app->session().post([spring](World& world) { CHECK(world.create_force(spring).ok()); });
  rig.play(
      "wait 2\nkey Ctrl+A\nkey Ctrl+C\nkey Ctrl+O\nwait 3\ntext second\nwait 2\nkey Enter\nwait 3");
  REQUIRE(rig.app->scene_name() == "second");
  rig.play("key Space\nmove 700,700\nwait 2\nkey Ctrl+V\nwait 3");
  REQUIRE(there(rig, "box_2"));
  REQUIRE(there(rig, "ball_2"));
  World& second = rig.app->session().world();
  const JointId made = second.find_joint("hinge");
  REQUIRE_FALSE(made.is_null());
  CHECK(second.joint(made)->a == second.find_body("box_2"));
  CHECK(second.joint(made)->b == second.find_body("ball_2"));
  REQUIRE(second.frame()->forces.size() == 1);
  CHECK(std::get<SpringDef>(second.frame()->forces[0].def).b.body == second.find_body("ball_2"));
  // As far apart as they were.
  const Vec3 apart = def_of(rig, "ball").pose.x - def_of(rig, "box").pose.x;
  CHECK((def_of(rig, "ball_2").pose.x - def_of(rig, "box_2").pose.x - apart).norm() < 0.2);
  CHECK(rig.app->selection().size() == 2);
  CHECK(selected(rig, "box_2"));
  rig.play("key Ctrl+Z\nwait 2");
  CHECK_FALSE(there(rig, "box_2"));
  CHECK(second.find_joint("hinge").is_null());
  check_no_faults(*device);
}

TEST_CASE("a copy hangs from the world where it stands itself") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 3\nkey Space\nwait 2");
  World& world = rig.app->session().world();
  const BodyId ball = world.find_body("ball");
  JointDef hook;
  hook.name = "hook";
  hook.kind = JointKind::spherical;
  hook.b = ball;
  hook.frame_a.x = world.body_def(ball)->pose.x + Vec3(0, 1, 0);
  hook.frame_b.x = Vec3(0, 1, 0);
  rig.app->session().post([hook](World& w) { CHECK(w.create_joint(hook).ok()); });
  rig.play("wait 2\nclick body:ball\nwait 2\nkey Ctrl+D\nwait 3");
  const JointId made = world.find_joint("hook_2");
  REQUIRE_FALSE(made.is_null());
  const JointDef copy = *world.joint(made);
  CHECK(copy.a.is_null());
  CHECK(copy.b == world.find_body("ball_2"));
  const Vec3 aside = def_of(rig, "ball_2").pose.x - def_of(rig, "ball").pose.x;
  CHECK(aside.norm() > 0.5);
  CHECK((copy.frame_a.x - hook.frame_a.x - aside).norm() < 1e-9);
}

TEST_CASE(
    "Esc in the middle of a gesture gives it up: what is moved goes back, what is held falls") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 3\nkey Space\nclick body:ball\nkey G\nwait 3");
  const uint64_t before = hash_of(rig);
  rig.play("move handle:x\npress left\nby 40 0\nby 40 0\nwait 2");
  REQUIRE(hash_of(rig) != before);
  rig.play("key Esc\nwait 3");
  CHECK(hash_of(rig) == before);
  CHECK(rig.app->ui_state().handles.kind == HandleKind::move);
  CHECK(selected(rig, "ball"));
  rig.play("by 60 0\nrelease left\nwait 3");
  CHECK(hash_of(rig) == before);

  rig.play("key Esc\nwait 2");  // now the handles
  CHECK(rig.app->ui_state().handles.kind == HandleKind::none);
  rig.play("move body:ball\npress left\nby 40 0\nby 40 0\nwait 2");
  REQUIRE(rig.app->dragging());
  rig.play("key Esc\nby 20 0\nwait 3");
  CHECK_FALSE(rig.app->dragging());
  CHECK(selected(rig, "ball"));
  rig.play("release left\nwait 2");
  CHECK_FALSE(rig.app->dragging());

  rig.play(
      "hold Ctrl\nmove 300,60\npress left\nby 300 200\nby 200 200\nkey Esc\nrelease left\nlet "
      "Ctrl\nwait 2");
  CHECK(rig.app->selection().size() == 1);
  check_no_faults(*device);
}
