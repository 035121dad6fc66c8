// Reference: what a person would see: ticks counted by hand, heights read from the frame; and the
// draw-list hash, which must be the same on every device for the same script.
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/context/gl_context.hpp"
#include "viewer/render/gl/gl_device.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// One session that touches everything; the hash of its last picture.
/// The statistics show wall times, which no two runs share: they are left out where hashes count.
uint64_t whole_session(Device& device, bool statistics) {
  Rig rig(device);
  rig.play("wait 5\nclick transport.pause");
  const uint64_t paused_at = rig.tick();
  rig.play("wait 10");
  CHECK(rig.tick() == paused_at);
  rig.play("key .");
  CHECK(rig.tick() == paused_at + 1);
  rig.play("key Shift+.");
  CHECK(rig.tick() == paused_at + 11);
  rig.play("key ,");
  CHECK(rig.tick() == paused_at + 10);
  rig.play("key R");
  CHECK(rig.tick() == 0);
  if (statistics) rig.play("key F3");
  rig.play("key Space\nkey 1\nkey 2\nkey F4\nwait 60\nclick body:box\nwait 2");
  CHECK(rig.app->selected());
  CHECK(rig.app->ui_state().shows(PanelId::inspector));
  rig.play("key Space");
  const uint64_t hash = rig.app->report().draws.hash;
  check_no_faults(device);
  return hash;
}

}  // namespace

TEST_CASE("pause, step, step back and restart by script on the null device") {
  const auto device = make_null_device();
  CHECK(whole_session(*device, true) != 0);
}

TEST_CASE("the same script draws the same list on the null device and on a real one") {
  const auto null_device = make_null_device();
  const uint64_t expected = whole_session(*null_device, false);
  auto context = create_context("auto");
  if (!context.ok()) {
    MESSAGE("no context here: ", context.error().text());
    return;
  }
  auto device = make_gl_device(*context->context);
  REQUIRE(device.ok());
  CHECK(whole_session(**device, false) == expected);
}

TEST_CASE("the mouse spring lifts a body, and it falls when it is let go") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 30\nmove body:box\npress left");
  const double before = rig.height("box");
  for (int i = 0; i < 30; ++i) rig.play("by 0 -4");
  rig.play("wait 40");
  CHECK(rig.app->dragging());
  CHECK(rig.height("box") > before + 0.5);
  const double held = rig.height("box");
  rig.play("wheel 2\nwait 10\nrelease left\nwait 60");
  CHECK_FALSE(rig.app->dragging());
  CHECK(rig.height("box") < held - 0.3);
  CHECK(rig.app->view().to->forces.empty());
  check_no_faults(*device);
}

TEST_CASE("who goes back into a drag finds the body let go") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 30\nmove body:box\npress left");
  for (int i = 0; i < 30; ++i) rig.play("by 0 -4");
  rig.play("wait 20");
  REQUIRE(rig.app->view().to->forces.size() == 1);
  rig.play("release left\nwait 5\nkey Space\nwait 2");
  CHECK(rig.app->view().to->forces.empty());
  rig.play("key Shift+,\nwait 2\nkey Shift+,\nwait 2");
  CHECK(rig.app->view().to->forces.empty());
  const double held = rig.height("box");
  REQUIRE(held > 1);
  rig.play("key Space\nwait 60");
  CHECK(rig.height("box") < held - 0.3);
  // While it is held, too.
  rig.play("move body:box\npress left");
  for (int i = 0; i < 30; ++i) rig.play("by 0 -4");
  rig.play("key Shift+,\nwait 2");
  CHECK_FALSE(rig.app->dragging());
  CHECK(rig.app->view().to->forces.empty());
  check_no_faults(*device);
}

TEST_CASE("what was changed in a pause is there when one comes back to it") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20\nkey Space\nwait 2\nclick body:box\nkey Del\nwait 2");
  REQUIRE(rig.height("box") == -1);
  rig.play("key Shift+.\nwait 2\nkey Shift+,\nwait 2");
  CHECK(rig.height("box") == -1);
  rig.play("key ,\nwait 2");
  CHECK(rig.height("box") > 0);
  // What was deleted is no part of the scene any more, as saving would write it.
  rig.play("key R\nwait 2");
  CHECK(rig.app->session().world().find_body("box").is_null());
}
