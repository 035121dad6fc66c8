// Reference: worlds that are stepped by hand with the same settings and the same commands.
#include "engine/world/world.hpp"
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/app/session/changed_settings.hpp"
#include "viewer/app/session/second_world.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("a second world with equal settings keeps the same bits, whatever is done to the first") {
  TestWorld a;
  BodyDef box = TestWorld::box_def({0, 2, 0});
  box.name = "box";
  const BodyId id = a.add(box);
  SecondWorld second(a->settings());
  second.begin(*a.world);
  for (int i = 0; i < 60; ++i) {
    if (i == 20) CHECK(a->apply_impulse(id, Vec3(500, 200, 0), Vec3(0, 2, 0.2)).ok());
    REQUIRE(a->step().ok());
    second.follow(*a.world);
  }
  CHECK(second.shown().to->tick == a->tick());
  CHECK(second.shown().samples.size() == 61);
  CHECK_FALSE(second.shown().first);
  CHECK(second.shown().worst.distance == 0);
  CHECK(second.shown().fault.empty());
}

TEST_CASE("other settings part, from the first tick in which they matter") {
  TestWorld a;
  BodyDef box = TestWorld::box_def({0, 2, 0});
  box.name = "box";
  (void)a.add(box);
  WorldSettings settings = a->settings();
  settings.gravity = Vec3(0, -1, 0);
  SecondWorld second(settings);
  REQUIRE(a->apply_commands().ok());
  second.begin(*a.world);
  for (int i = 0; i < 30; ++i) {
    REQUIRE(a->step().ok());
    second.follow(*a.world);
  }
  const SecondWorld::Shown shown = second.shown();
  REQUIRE(shown.first);
  CHECK(shown.first->tick_a == 1);
  CHECK(shown.first->what == "box");
  // Two falls, apart by (g - 1) t^2 / 2 but for the scheme's first-order term.
  const double t = shown.now.time, g = -a->settings().gravity.y();
  const double expected = 0.5 * (g - 1) * t * t;
  CHECK(shown.now.distance == doctest::Approx(expected).epsilon(0.05));
  CHECK(shown.worst.distance == shown.now.distance);
}

TEST_CASE("a world of half the tick is compared at the moments that both have") {
  TestWorld a;
  (void)a.add(TestWorld::box_def({0, 2, 0}));
  WorldSettings settings = a->settings();
  settings.tick.num *= 2;
  SecondWorld second(settings);
  REQUIRE(a->apply_commands().ok());
  second.begin(*a.world);
  const uint64_t begun = second.shown().to->tick;
  for (int i = 0; i < 10; ++i) {
    REQUIRE(a->step().ok());
    second.follow(*a.world);
  }
  CHECK(second.shown().to->tick - begun == 20);
  CHECK(second.shown().samples.size() == 11);
}

TEST_CASE("the window compares, shows where worlds part, and goes there") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  rig.play("wait 3\nkey Space\nkey K\nwait 3\nclick compare.start\nwait 3");
  REQUIRE(rig.app->comparison());
  const size_t alone = rig.app->picture().instances.size();
  CHECK(alone == 2);  // box and ball: no ghost covers what it does not differ from
  rig.play("key Space\nwait 30\nkey Space\nwait 3");
  CHECK_FALSE(rig.app->comparison()->first_tick);
  WorldSettings settings = rig.app->settings();
  settings.gravity = Vec3(0, -3, 0);
  rig.app->ask(Compare{settings});
  rig.play("wait 3");
  const uint64_t from = rig.tick();
  rig.play("key Space\nwait 20\nkey Space\nwait 3");
  REQUIRE(rig.app->comparison()->first_tick);
  CHECK(*rig.app->comparison()->first_tick == from + 1);
  CHECK(rig.app->comparison()->distance > 0);
  CHECK(rig.app->picture().instances.size() > alone);
  const double apart = rig.app->comparison()->worst;
  rig.play("click compare.go_there\nwait 3");
  CHECK(rig.tick() == from + 1);
  CHECK(rig.app->comparison()->distance < apart);
  CHECK(rig.app->comparison()->distance > 0);
  // On again both come to where they were.
  rig.play("key Space\nwait 19\nkey Space\nwait 3");
  CHECK(rig.app->comparison()->worst >= 0.9 * apart);
  rig.play("click compare.end\nwait 3");
  CHECK_FALSE(rig.app->comparison());
  CHECK(rig.app->picture().instances.size() == alone);
  check_no_faults(*device);
}

TEST_CASE("halves of a picture are equally wide, between the panels, in whole pixels") {
  const ViewArea whole(1280, 720, 2);
  CHECK(whole.width() == 640);
  CHECK(whole.aspect() == doctest::Approx(1280.0 / 720));
  CHECK(whole.origin_at(500) == 0);
  const ViewArea area = ViewArea::beside(1280, 720, 2, UiRect{310, 56, 320, 290});
  REQUIRE(area.places());
  CHECK(area.left() == 302);  // where a panel of 292 ends that stands 10 from the edge
  CHECK(area.right() + area.width() == 640);
  CHECK(area.left() + area.width() < area.right());
  CHECK(area.origin_at(303) == area.left());
  CHECK(area.origin_at(639) == area.right());
  // Without room between the panels it takes the whole window.
  const ViewArea narrow = ViewArea::beside(600, 400, 1, UiRect{300, 56, 20, 290});
  CHECK(narrow.left() == 0);
  CHECK(narrow.right() + narrow.width() == 600);
  // As much is seen from left to right as in the whole window.
  CHECK(whole.heightening() == 1);
  CHECK(area.heightening() == doctest::Approx(640 / area.width()));
}

TEST_CASE("worlds are called by what differs in them") {
  WorldSettings a, b;
  CHECK(names_by_settings(a, b).first.empty());
  a.stepper = "event";
  b.stepper = "realtime";
  CHECK(names_by_settings(a, b) == std::pair<std::string, std::string>("event", "realtime"));
  b.gravity = Vec3(0, -1.5, 0);
  CHECK(names_by_settings(a, b).second.find("0 -1.5 0") != std::string::npos);
  b.tick.num *= 2;
  CHECK(names_by_settings(a, b).second.find("and 1 more") != std::string::npos);
}

TEST_CASE("the second world has a picture of its own, with the same camera, and A is worked on") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("wait 3\nkey Space\nkey Shift+K\nwait 2");
  CHECK(says(rig, "Nothing is compared yet"));
  rig.play("click compare.start\nwait 3");
  const size_t with_ghost = rig.app->picture().instances.size();
  const uint32_t passes = rig.app->report().draws.passes;
  const Camera whole = rig.app->picture().camera;
  const double at_whole = rig.app->locate("body:ball")->x / 1280;
  rig.play("click compare.beside\nwait 3");
  REQUIRE(rig.app->area().places());
  CHECK(rig.app->picture().instances.size() == with_ghost);
  CHECK((rig.app->locate("body:ball")->x - rig.app->area().left()) / rig.app->area().width() ==
        doctest::Approx(at_whole).epsilon(1e-3));
  CHECK(rig.app->picture().camera.fov_deg > whole.fov_deg);
  CHECK(rig.app->camera().camera().fov_deg == whole.fov_deg);
  CHECK(rig.app->report().draws.passes > passes);
  Image image;
  REQUIRE(rig.app->read_back(image).ok());
  CHECK(image.width == 1280);
  // What is clicked on the left is A's; its fellow on the right is the same body.
  rig.play("click body:box\nwait 3");
  CHECK(rig.app->selected() == rig.app->session().world().find_body("box"));
  rig.play("key Esc\nwait 3");
  REQUIRE(rig.app->selected().is_null());
  const ViewArea area = rig.app->area();
  const auto at = *rig.app->locate("body:box");
  const double aside = area.right() - area.left();
  const auto spot = [](double x, double y) {
    return std::to_string(int(x)) + "," + std::to_string(int(y));
  };
  rig.play("click " + spot(at.x + aside, at.y) + "\nwait 3");
  CHECK_FALSE(rig.app->selected().is_null());
  // A drag there turns the camera of both, and pulls nobody.
  const Vec3 eye = rig.app->camera().camera().eye;
  rig.play("key Esc\nwait 2\ndrag " + spot(at.x + aside, at.y) + " 60 0\nwait 20");
  CHECK((rig.app->camera().camera().eye - eye).norm() > 0.1);
  CHECK_FALSE(rig.app->dragging());
  // Nor is anything shot into A from there.
  const size_t bodies = rig.app->session().world().frame()->body_slots();
  rig.play("shift_click " + spot(at.x + aside, at.y) + "\nwait 3");
  CHECK(rig.app->session().world().frame()->body_slots() == bodies);
  CHECK(says(rig, "only looked at"));
  rig.play("key Shift+K\nwait 2");
  CHECK_FALSE(rig.app->area().places());
  CHECK(rig.app->ui_state().compared_as == ComparedAs::hidden);
  rig.play("key Shift+K\nwait 2");
  CHECK(rig.app->picture().instances.size() == with_ghost);
  check_no_faults(*device);
}
