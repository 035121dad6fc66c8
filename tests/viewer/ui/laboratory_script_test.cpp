// Reference: the file and the state hash before building, after taking everything back, and after
// opening what was saved; places and counts of bodies by hand, against what sensors say.
#include "tests/viewer/ui/laboratory.hpp"

#include <algorithm>
#include <cmath>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("a cloth is woven over a ball in the window, and drapes") {
  Laboratory b;
  b.type("static");
  b.body("sphere", "sphere");
  b.play("click inspector.group.0\nwait 3");
  b.set("inspector.position", Vec3(0, 0.8, 0));
  b.play("click inspector.shape.0\nwait 3");
  b.set("inspector.shape.0.radius", "0.5");
  b.part("cloth", "body:sphere");
  REQUIRE(b.rig.app->ui_state().part.name == "cloth");
  b.set("part.cloth.0.corner", Vec3(-0.9, 1.45, -0.9));
  b.set("part.cloth.0.across.x", "1.8");
  b.set("part.cloth.0.down.z", "1.8");
  b.check_round_trip(150);
  const auto& cloth = *b.world().frame()->particles.at(0);
  REQUIRE(cloth.x.size() == 31 * 31);
  double low = 10, high = -10, inside = 0;
  for (size_t i = 0; i < cloth.x.size(); ++i) {
    low = std::min(low, cloth.x[i].y());
    high = std::max(high, cloth.x[i].y());
    inside = std::max(inside, 0.5 - (cloth.x[i] - Vec3(0, 0.8, 0)).norm());
  }
  CHECK(high > 1.25);  // it lies on the ball,
  CHECK(high < 1.45);
  CHECK(low < 0.8);      // hangs down beside it
  CHECK(inside < 0.01);  // and is not in it
  check_no_faults(*b.device);
}

TEST_CASE("a trebuchet is built in the window, and throws its stone") {
  Laboratory b;
  b.type("static");
  b.play("click build.material\nwait 2\nclick build.material.wood\nwait 2");
  b.body("box", "box");  // the post
  b.play("click inspector.group.0\nwait 3\nclick inspector.shape.0\nwait 3");
  const auto box = [&](const char* name, const Vec3& size, const Vec3& x) {
    if (std::string_view(name) != "box") b.body("box", name);
    b.set("inspector.shape.0.size", size);
    b.set("inspector.position", x);
  };
  box("box", {0.2, 1.5, 0.2}, {0, 0.75, -0.25});
  b.type("dynamic");
  box("box_2", {2.6, 0.12, 0.12}, {-0.6, 1.5, 0});  // the arm
  b.play("click build.material\nwait 2\nclick build.material.steel\nwait 2");
  box("box_3", {0.5, 0.5, 0.5}, {0.65, 1.1, 0});  // the weight
  b.play("click build.material\nwait 2\nclick build.material.stone\nwait 2");
  b.body("sphere", "sphere");
  b.play("click inspector.shape.0\nwait 3");
  b.set("inspector.shape.0.radius", "0.1");
  b.set("inspector.position", Vec3(-1.2, 0.1, 0));
  // The pivot, from the arm to the post below it; the axis leaves the face towards the eye.
  b.play("click build.revolute\nwait 2\nclick " + b.at({0, 1.5, 0.06}) + "\nwait 2\nclick " +
         b.at({0, 0.6, -0.15}) + "\nwait 3");
  b.play("click " + b.at({0.65, 1.5, 0.06}) + "\nwait 2\nclick " + b.at({0.65, 1.1, 0.25}) +
         "\nwait 3");
  b.play("click build.distance\nwait 2\nclick " + b.at({-1.85, 1.5, 0.06}) +
         "\nwait 2\nclick body:sphere\nwait 3\nkey Esc\nwait 2");
  REQUIRE_FALSE(b.world().find_joint("revolute_2").is_null());
  const JointId sling = b.world().find_joint("distance_1");
  REQUIRE_FALSE(sling.is_null());
  // The sling lets go of the stone where it has to pull harder than this: when the weight strikes
  // the post.
  b.play(
      "click body:sphere\nwait 3\nclick joint.0\nwait 3\nclick joint.0.break_force.given\nwait 3");
  b.set("joint.0.break_force", "7000");
  CHECK(b.world().joint(sling)->break_force == 7000);
  b.check_round_trip(180);
  CHECK(b.world().find_joint("distance_1").is_null());
  CHECK(place(b, "sphere").x() > 5);
  check_no_faults(*b.device);
}

TEST_CASE("a Galton board with a counter for each bin is built in the window, and counts") {
  constexpr double step = 0.3, row = 0.26;
  constexpr int rows = 4, balls = 16;
  Laboratory b;
  b.type("static");
  b.body("sphere", "sphere");  // a peg
  b.play("click inspector.group.0\nwait 3\nclick inspector.shape.0\nwait 3");
  b.set("inspector.shape.0.radius", "0.06");
  b.set("inspector.position", Vec3(0, 2.2, 0));
  // A peg and its copies, put where they belong by numbers.
  for (int r = 1; r < rows; ++r)
    for (int k = 0; k <= r; ++k) {
      b.play("key Ctrl+D\nwait 4");
      b.set("inspector.position", Vec3(step * (k - 0.5 * r), 2.2 - row * r, 0));
    }
  CHECK_FALSE(b.world().find_body("sphere_10").is_null());
  b.body("box", "box");
  b.play("click inspector.shape.0\nwait 3");
  b.set("inspector.shape.0.size", Vec3(0.02, 1, 0.2));
  b.set("inspector.position", Vec3(-2.5 * step, 0.5, 0));
  b.play("key Ctrl+D\nwait 4");
  b.set("inspector.position", Vec3(-1.5 * step, 0.5, 0));
  b.play("key Ctrl+D\nwait 4\nkey Ctrl+D\nwait 4\nkey Ctrl+D\nwait 4\nkey Ctrl+D\nwait 4");
  CHECK((place(b, "box_6") - Vec3(2.5 * step, 0.5, 0)).norm() < 1e-9);  // copies go on alike
  // Walls beside the pegs, panes before and behind.
  b.body("box", "box_7");
  b.set("inspector.shape.0.size", Vec3(0.02, 1.8, 0.2));
  b.set("inspector.position", Vec3(-2.5 * step, 1.9, 0));
  b.play("key Ctrl+D\nwait 4");
  b.set("inspector.position", Vec3(2.5 * step, 1.9, 0));
  b.body("box", "box_9");
  b.set("inspector.shape.0.size", Vec3(2, 2.8, 0.05));
  b.set("inspector.position", Vec3(0, 1.4, -0.09));
  b.play("key Ctrl+D\nwait 4");
  b.set("inspector.position", Vec3(0, 1.4, 0.09));
  b.play("click inspector.group.2\nwait 3\nclick inspector.visible\nwait 3");
  // What falls: a ball beside, which the emitter copies.
  b.type("dynamic");
  b.body("sphere", "sphere_11");
  b.set("inspector.shape.0.radius", "0.05");
  b.set("inspector.position", Vec3(1.6, 0.05, 0));
  b.part("emitter", b.at({0, 0, 3.5}));
  b.set("part.position", Vec3(0.01, 2.6, 0));
  b.set("part.rate", "4");
  b.play("click part.count.given\nwait 3");
  b.set("part.count", std::to_string(balls));
  b.play(
      "click part.shape.given\nwait 3\nclick part.shape.type\nwait 2\nclick part.shape.type.box"
      "\nwait 3");
  b.set("part.shape.size", Vec3(0.08, 0.02, 0.001));
  b.part("gate", b.at({0, 0, 3.5}));
  b.set("part.size.0", "0.3");
  b.set("part.size.1", "0.2");
  b.set("part.position", Vec3(-2 * step, 0.9, 0));
  b.set("part.euler_deg.x", "180");
  b.set("part.count", "5");
  b.set("part.step.x", "0.3");
  b.check_round_trip(600);
  const auto frame = b.world().frame();
  REQUIRE(frame->sensors);
  REQUIRE(frame->sensors->size() == 5);
  int in_bins = 0, sum = 0;
  for (const SensorFrame& gate : *frame->sensors) {
    int below = 0;
    for (size_t slot = 0; slot < frame->body_slots(); ++slot) {
      const Vec3& x = frame->body(slot).pose.x;
      if (frame->body(slot).id.is_null() || frame->info(slot).type != BodyType::dynamic) continue;
      below += x.y() < 0.9 && std::abs(x.x() - gate.pose.x.x()) < 0.5 * step;
    }
    CAPTURE(gate.name);
    CHECK(int(gate.forward) - int(gate.backward) == below);
    in_bins += below;
    sum += int(gate.forward) - int(gate.backward);
  }
  CHECK(sum == in_bins);
  CHECK(in_bins >= balls - 2);
  check_no_faults(*b.device);
}

TEST_CASE("an emitter, a net and a spring are changed and deleted in their panel, and come back") {
  Laboratory b;
  b.part("emitter", b.at({0, 0, 1}));
  b.play("wait 2");
  REQUIRE(b.rig.app->ui_state().part.name == "emitter");
  const auto frame = [&] { return b.world().frame(); };
  REQUIRE(frame()->particles.size() == 1);
  b.set("part.rate", "100");
  b.play("click parts.particles.spray\nwait 3");
  b.set("part.radius", "0.02");
  REQUIRE(b.rig.app->session().advance(60).ok());
  b.play("wait 2");
  const size_t emitted = frame()->particles.back()->x.size();
  CHECK(emitted >= 95);  // the emitter fills the system that took the place of its own
  CHECK(emitted <= 101);
  b.play("click parts.emitters.emitter\nwait 3\nclick parts.delete\nwait 3");
  REQUIRE(b.rig.app->session().advance(30).ok());
  b.play("wait 2");
  CHECK(frame()->particles.back()->x.size() <= emitted);
  b.play("key Ctrl+Z\nwait 3");
  CHECK(says(b.rig, "Taken back: Delete emitter"));
  REQUIRE(b.rig.app->session().advance(30).ok());
  b.play("wait 2");
  CHECK(frame()->particles.back()->x.size() > emitted + 40);
  // A value that the world refuses is said, and nothing changes.
  b.play(
      "click parts.emitters.emitter\nwait 3\nclick part.body\nwait 2\ntext nobody\nkey Enter\n"
      "wait 3");
  CHECK(says(b.rig, "not possible"));
  check_no_faults(*b.device);
}
