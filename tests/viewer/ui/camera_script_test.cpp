// The camera by script. Reference: geometry of eye and pivot by hand, heights read from the frame.
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/interact/key_map.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("dragging the ground orbits, and a shot makes a body") {
  const auto device = make_null_device();
  Rig rig(*device);
  const Vec3 eye = rig.app->camera().camera().eye;
  rig.play("drag 320,390 80 0 10\nwait 20");
  CHECK((rig.app->camera().camera().eye - eye).norm() > 1);
  const auto bodies = rig.app->view().to->stats.bodies;
  rig.play("shift_click body:box\nwait 2");
  CHECK(rig.app->view().to->stats.bodies == bodies + 1);
}

TEST_CASE("C brings the scene's camera back, F shows everything") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("key Space\nwait 2");
  const Vec3 eye = rig.app->camera().camera().eye, target = rig.app->camera().camera().target;
  rig.play("drag 100,400 200 40 10\nwait 60");
  CHECK((rig.app->camera().camera().eye - eye).norm() > 1);
  rig.play("key C\nwait 90");
  CHECK((rig.app->camera().camera().eye - eye).norm() < 1e-3);
  CHECK((rig.app->camera().camera().target - target).norm() < 1e-3);
  rig.app->camera().zoom(30);
  rig.play("wait 60\nkey F\nwait 90");
  for (const char* name : {"body:box", "body:ball"}) {
    const auto at = rig.app->locate(name);
    REQUIRE(at);
    CHECK((at->x > 0 && at->x < 800 && at->y > 0 && at->y < 500));
  }
}

TEST_CASE("a camera that follows a body goes along with it, however it has been turned") {
  const auto device = make_null_device();
  Rig rig(*device, "following");
  const auto eye = [&] { return rig.app->camera().camera().eye; };
  const auto fallen = [&] { return 4 - rig.height("ball"); };
  rig.play("wait 30");
  REQUIRE(fallen() > 0.5);
  CHECK((eye() - Vec3(0, 2 - fallen(), 9)).norm() < 1e-9);
  rig.play("key Space\ndrag 320,390 80 0 10\nwait 60");
  const Vec3 turned = eye();
  const double before = fallen();
  CHECK((turned - Vec3(0, 2 - before, 9)).norm() > 1);
  rig.play("key Shift+.\nwait 2");
  CHECK((eye() - (turned - Vec3(0, fallen() - before, 0))).norm() < 1e-4);
  rig.play("key R\nwait 2");
  CHECK((eye() - (turned + Vec3(0, before, 0))).norm() < 1e-4);
  const Vec3 start = eye();
  rig.app->session().post([](World& w) { CHECK(w.destroy_body(w.find_body("ball")).ok()); });
  rig.play("wait 5\nkey Space\nwait 5");
  CHECK(rig.height("ball") == -1);
  CHECK((eye() - start).norm() < 1e-4);
}

TEST_CASE("Shift while a body is held turns it, and flying moves the eye") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 30");
  const auto box = *rig.app->locate("body:box");
  const auto turned = [&] {
    const Frame& f = *rig.app->view().to;
    for (size_t slot = 0; slot < f.body_slots(); ++slot)
      if (f.info(slot).name == "box") return 2 * std::asin(f.body(slot).pose.q.y());
    return 0.0;
  };
  rig.frame({PointerMoved{box.x, box.y}, PointerPressed{PointerButton::left, true}});
  for (int i = 1; i <= 40; ++i) rig.frame({PointerMoved{box.x, box.y - 2 * i}});
  rig.frame({KeyPressed{Key::shift, true, false}});
  const double before = turned();
  for (int i = 1; i <= 20; ++i) rig.frame({PointerMoved{box.x + 5 * i, box.y - 80}});
  CHECK(turned() - before > 0.3);
  rig.frame({KeyPressed{Key::shift, false, false}, PointerPressed{PointerButton::left, false}});
  CHECK_FALSE(rig.app->dragging());

  const Vec3 eye = rig.app->camera().camera().eye;
  rig.frame({PointerPressed{PointerButton::right, true}});
  rig.frame({KeyPressed{letter_key('W'), true, false}});
  for (int i = 0; i < 20; ++i) rig.frame();
  rig.frame({KeyPressed{letter_key('W'), false, false}});
  rig.frame({PointerPressed{PointerButton::right, false}});
  for (int i = 0; i < 60; ++i) rig.frame();
  const Vec3 moved = rig.app->camera().camera().eye - eye;
  CHECK(moved.z() < -1);
  CHECK(std::abs(moved.x()) < 0.3);
}

TEST_CASE("without a held button keys fly and a drag looks around, until it is switched off") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("key Space\nwait 3");
  const auto eye = [&] { return rig.app->camera().camera().eye; };
  const Vec3 start = eye();
  rig.play("hold W\nwait 20\nlet W\nwait 40");
  CHECK(eye() == start);
  rig.play("key H\nwait 2");
  CHECK(says(rig, "Flying"));
  rig.play("hold W\nwait 20\nlet W\nwait 60");
  const Vec3 ahead = eye();
  CHECK(ahead.z() < start.z() - 0.5);
  CHECK(says(rig, "Flying"));
  // With Ctrl the same key is a command.
  rig.play("key Ctrl+D\nwait 40");
  CHECK((eye() - ahead).norm() < 1e-6);
  // About the eye, and no body is pulled; a click still selects one.
  const Vec3 target = rig.app->camera().camera().target;
  rig.play("drag body:box 120 0 10\nwait 60");
  CHECK((eye() - ahead).norm() < 1e-6);
  CHECK((rig.app->camera().camera().target - target).norm() > 0.3);
  CHECK_FALSE(rig.app->dragging());
  rig.play("click body:box\nwait 5");
  CHECK(rig.app->selected() == rig.app->session().world().find_body("box"));
  rig.play("key Esc\nwait 2\nhold W\nwait 20\nlet W\nwait 60");
  CHECK((eye() - ahead).norm() < 1e-6);
  CHECK_FALSE(rig.app->selected().is_null());  // Esc ends one thing at a time
  CHECK_FALSE(says(rig, "Flying"));
}

TEST_CASE("keys of flying are the person's own") {
  const auto device = make_null_device();
  Rig rig(*device);
  CHECK(
      take_bindings(R"({"fly_forward": "Up", "fly_left": ["Left", "J"], "toggle_assertions": ""})")
          .empty());
  rig.play("key Space\nwait 3");
  const auto eye = [&] { return rig.app->camera().camera().eye; };
  const Vec3 start = eye();
  rig.play("press right\nhold W\nwait 20\nlet W\nrelease right\nwait 40");
  CHECK((eye() - start).norm() < 1e-6);
  rig.play("press right\nhold Up\nwait 20\nlet Up\nrelease right\nwait 40");
  CHECK(eye().z() < start.z() - 0.5);
  rig.play("press right\nhold J\nwait 20\nlet J\nrelease right\nwait 40");
  CHECK(eye().x() < start.x() - 0.5);
  take_usual_bindings();
}

TEST_CASE("a double click makes the point the pivot, the wheel pulls what is held, middle pans") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20\ndouble_click body:box\nwait 60");
  CHECK((rig.app->camera().pivot() - Vec3(0, 0.5, 0)).norm() < 0.9);
  CHECK((rig.app->camera().camera().eye - Vec3(0, 2, 9)).norm() < 0.01);
  const auto depth = [&] {
    const auto id = rig.app->selected();
    const auto slot = find_slot(*rig.app->view().to, id);
    return slot ? rig.app->view().to->body(*slot).pose.x.z() : 0;
  };
  rig.play("move body:box\npress left\nby 0 -30\nby 0 -30\nwait 40");
  const double before = depth();
  rig.play("wheel 3\nwait 40");
  CHECK(depth() > before + 0.5);
  rig.play("wheel -6\nwait 40");
  CHECK(depth() < before - 0.5);
  rig.play("release left\nwait 2");
  const Vec3 pivot = rig.app->camera().pivot();
  rig.play("move 320,390\npress middle\nby 50 0\nrelease middle");
  const Vec3 panned = rig.app->camera().pivot();
  CHECK((panned - pivot).norm() > 0.2);
  // So does the left button with Alt, for who has no middle one; also over a body.
  rig.play("hold Alt\nmove body:box\npress left\nby -50 0\nrelease left\nlet Alt\nwait 2");
  CHECK((rig.app->camera().pivot() - pivot).norm() < 0.2 * (panned - pivot).norm());
  CHECK_FALSE(rig.app->dragging());
}

TEST_CASE("a double click makes a body the pivot wherever it is seen, in windows large and small") {
  const auto device = make_null_device();
  for (const Application::Picture& picture :
       {Application::Picture{1280, 720, 1}, Application::Picture{420, 320, 1},
        Application::Picture{1600, 1200, 2}})
    for (double side = -4; side <= 4; side += 0.5) {
      CAPTURE(picture.width);
      CAPTURE(side);
      Rig rig(*device);
      rig.picture = picture;
      rig.play("wait 2");
      Camera camera;
      camera.eye = Vec3(side, 2, 9);
      camera.target = Vec3(side, 1.2, 0);
      rig.app->camera().set(camera);
      rig.frame();
      const auto at = rig.app->locate("body:box");
      REQUIRE(at);
      if (at->x < 0 || at->x >= picture.width / picture.scale) continue;
      rig.play("click body:box\nwait 8\nclick body:box\nwait 5");  // 8 pictures are 0.13 s
      CHECK((rig.app->camera().pivot() - Vec3(0, 0.5, 0)).norm() < 0.9);
      CHECK(rig.app->selected());
      // What opens by itself covers no more than an edge of the picture.
      CHECK(rig.app->ui_state().shows(PanelId::inspector) == (picture.width > 420));
    }
}

TEST_CASE("clicks far apart in time or place are no double click, and a panel keeps its own") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("wait 20");
  Camera camera;
  camera.eye = Vec3(-3.5, 2, 9);
  camera.target = Vec3(-3.5, 1.2, 0);
  rig.app->camera().set(camera);
  rig.frame();
  const auto at = rig.app->locate("body:box");
  REQUIRE(at);
  REQUIRE(at->x > 1000);  // where the panel of the body opens
  rig.play("click body:box\nwait 30\nclick body:box\nwait 30");
  CHECK((rig.app->camera().pivot() - camera.target).norm() < 1e-9);
  CHECK(rig.app->selected());
  rig.play("click 500,150\nwait 30");
  CHECK_FALSE(rig.app->selected());
  // At once after a click on the body, but elsewhere: on the panel.
  rig.app->ui_state().shows(PanelId::inspector) = false;
  rig.play("wait 2\nclick body:box\nclick inspector.close");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::inspector));
}

TEST_CASE("F shows the scene and not what has flown away") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("key Space\nwait 2");
  rig.app->session().post([](World& w) {
    Pose far;
    far.x = Vec3(1e6, 4e5, 0);
    CHECK(w.set_pose(w.find_body("ball"), far).ok());
  });
  rig.play("wait 2\nkey F\nwait 90");
  const Camera& camera = rig.app->camera().camera();
  CHECK((camera.eye - camera.target).norm() < 20);
  const auto at = rig.app->locate("body:box");
  REQUIRE(at);
  CHECK((at->x > 0 && at->x < 800 && at->y > 0 && at->y < 500));
}
