// Bodies on courses, and bodies that begin asleep, moved and changed in the window. Reference: the
// world that the saved file makes, by the hash of its state at once and later.
#include "tests/viewer/ui/described.hpp"

using namespace tumble;
using namespace tumble::test;

namespace {

const std::string cam_and_ball = R"x(  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" }, "material": "wood" },
    "cam": {
      "type": "kinematic", "shape": { "type": "sphere", "radius": 0.5 }, "position": [0, 2, 0],
      "course": { "x": "= 1 + 0.5*sin(2*t)", "angle_deg": "= 170*t" }
    },
    "ball": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [3, 2, 0], "starts_asleep": true }
  },
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0] } })x";

BodyDef def_of(Laboratory& b, const char* name) {
  return *b.world().body_def(b.world().find_body(name));
}
void displace(Laboratory& b, const char* name, const Vec3& shift) {
  b.rig.app->ask(SelectBody{b.world().find_body(name)});
  b.play("wait 3");
  Displacement way;
  way.shift = shift;
  b.rig.app->ask(DisplaceSelected{way});
  b.play("wait 3");
}
/// Saved and opened again, the world is the same, and after half a second too.
void check_opens_alike(Described& b) {
  const uint64_t now = b.hash();
  (void)b.saved();
  REQUIRE(b.rig.app->session().advance(30).ok());
  const uint64_t later = b.hash();
  b.rig.app->open(b.file);
  b.play("wait 3");
  REQUIRE(b.rig.tick() == 0);
  CHECK(b.hash() == now);
  REQUIRE(b.rig.app->session().advance(30).ok());
  CHECK(b.hash() == later);
}

}  // namespace

TEST_CASE("a body that is moved before the first tick takes its course along, and goes on asleep") {
  Described b(cam_and_ball);
  displace(b, "cam", {0, 1, 0});
  CHECK((place(b, "cam") - Vec3(1, 3, 0)).norm() < 1e-12);
  CHECK(def_of(b, "cam").course != nullptr);
  displace(b, "ball", {0, 1, 0});
  CHECK(b.world().body(b.world().find_body("ball"))->asleep);
  // Its place is typed as it is shown.
  b.rig.app->ask(EditBody{b.world().find_body("cam"), "Change position of cam",
                          [](BodyDef& d) { d.pose.x.x() = 2; }});
  b.play("wait 3");
  CHECK((place(b, "cam") - Vec3(2, 3, 0)).norm() < 1e-12);
  check_opens_alike(b);
  check_no_faults(*b.device);
}

TEST_CASE("a body that is moved later leaves its course from where it stands, in the file too") {
  for (const bool typed : {false, true}) {
    INFO(typed);
    Described b(cam_and_ball);
    REQUIRE(b.rig.app->session().advance(30).ok());
    b.play("wait 3");
    const Pose then = b.world().body(b.world().find_body("cam"))->body_frame();
    if (typed)
      b.rig.app->ask(EditBody{b.world().find_body("cam"), "Change position of cam",
                              [y = then.x.y()](BodyDef& d) { d.pose.x.y() = y + 0.1; }});
    else
      displace(b, "cam", {0, 0.1, 0});
    b.play("wait 3");
    const Pose now = b.world().body(b.world().find_body("cam"))->body_frame();
    CHECK((now.x - then.x - Vec3(0, 0.1, 0)).norm() < 1e-12);
    CHECK(now.q.angularDistance(then.q) < 1e-7);
    CHECK(def_of(b, "cam").course == nullptr);
    CHECK(b.saved().find("course") == std::string::npos);
    b.play("key Ctrl+Z\nwait 4");
    CHECK(def_of(b, "cam").course != nullptr);
    CHECK(b.saved() == b.start);
    check_no_faults(*b.device);
  }
}

TEST_CASE("description: what a gesture ends with is what the file says, in one undo step") {
  Described b(cam_and_ball);
  const ScenePath x = ScenePath{} / "bodies" / "cam" / "course" / "x";
  b.play("move 1300,1300\npress left\nwait 1");
  for (const char* value : {"\"= 1 + 0.25*sin(2*t)\"", "\"= 1 + 0.125*sin(2*t)\""}) {
    b.rig.app->ask(EditDescription{x, EditDescription::How::set, value});
    b.play("wait 2");
  }
  b.play("release left\nwait 3");
  CHECK(b.saved() == with(b.start, "0.5*sin", "0.125*sin"));
  b.play("key Ctrl+Z\nwait 4");
  CHECK(b.hash() == b.start_hash);
  check_no_faults(*b.device);
}

TEST_CASE("description: sleep is changed by a new start where a force may wake the body") {
  Described b(with(cam_and_ball, "\"starts_asleep\": true", "\"starts_asleep\": false") + R"(,
  "forces": { "air": { "type": "quadratic_drag", "wind": [1, 0, 0] } })");
  b.go("bodies.ball");
  b.play("click description.starts_asleep\nwait 4");
  CHECK_FALSE(b.world().body(b.world().find_body("ball"))->asleep);
  check_opens_alike(b);
  check_no_faults(*b.device);
}
