// Overlays, microscope and marks by script. Reference: what the scene and its contacts are known to
// be, by hand.
#include "tests/viewer/ui/session_rig.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("key 6 walks down the hierarchy and off again, the panel chooses the kind") {
  const auto device = make_null_device();
  Rig rig(*device, "meshes");
  rig.picture = {1280, 800, 1};
  const Overlays& overlays = rig.app->ui_state().overlays;
  const auto lines = [&] { return rig.app->picture().lines.size(); };
  rig.play("click transport.pause");
  const size_t without = lines();
  int depth = -1;
  for (size_t volumes = 1; depth < 100; volumes *= 2) {
    rig.play("key 6");
    if (!overlays.hierarchy) break;
    CHECK(overlays.hierarchy_level == ++depth);
    if (depth < 6) CHECK(lines() == without + 12 * volumes);
  }
  CHECK(depth >= 7);  // 1024 triangles, four to a leaf
  CHECK(lines() == without);
  rig.play("key Shift+6");
  CHECK(overlays.hierarchy);
  CHECK(overlays.hierarchy_level == depth);
  rig.play("key 0\nkey 6\nkey 6");
  CHECK(overlays.hierarchy_level == 1);
  rig.app->ui_state().shows(PanelId::drawing) = true;
  rig.play("wait 3\nclick drawing.hierarchy_kind\nwait 2\nclick drawing.hierarchy.sphere\nwait 2");
  CHECK(overlays.hierarchy_kind == "sphere");
  CHECK(lines() == without + 2 * 144);
  rig.play("key 0");
  CHECK_FALSE(overlays.hierarchy);
  CHECK(overlays.hierarchy_kind == "sphere");

  Rig none(*device);
  none.play("key 6");
  CHECK_FALSE(none.app->ui_state().overlays.hierarchy);
  CHECK(none.app->ui_state().toasts.back().title.find("mesh") != std::string::npos);
  check_no_faults(*device);
}

TEST_CASE("M puts the selected body and its neighbour under the microscope, N steps through") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 800, 1};
  const UiState& state = rig.app->ui_state();
  rig.play("click transport.pause\nkey N");
  CHECK(state.toasts.back().title.find("select a body") != std::string::npos);
  rig.play("click body:box\nwait 2\nkey M\nwait 2");
  CHECK(state.shows(PanelId::microscope));
  REQUIRE(rig.app->locate("microscope.next"));
  rig.play("key N\nkey N\nkey N");
  CHECK(state.microscope.step == 3);
  rig.play("key Shift+N");
  CHECK(state.microscope.step == 2);
  rig.play("click microscope.next\nwait 1");
  CHECK(state.microscope.step == 3);
  const size_t lines = rig.app->picture().lines.size();
  CHECK(lines > 20);
  CHECK_FALSE(rig.app->picture().plate.has_value());  // the panel has its words
  rig.play("key Tab");
  CHECK(rig.app->picture().plate.has_value());
  rig.play("key Tab\nkey Ctrl+Shift+N");
  CHECK(state.microscope.step == 0);
  rig.play("click microscope.algorithm\nwait 2\nclick microscope.time_of_contact\nwait 2");
  CHECK(state.microscope.algorithm == "time_of_contact");
  CHECK_FALSE(state.microscope.step.has_value());
  rig.play("click microscope.algorithm\nwait 2\nclick microscope.v_clip\nwait 2\nkey N");
  CHECK_FALSE(state.microscope.step.has_value());  // refused: a ball has no features
  rig.play("key M");
  CHECK_FALSE(state.shows(PanelId::microscope));
  CHECK(rig.app->picture().lines.size() < lines);
  check_no_faults(*device);
}

TEST_CASE("an overlay that shows nothing says so, one that does has a legend") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 30\nkey Space\nkey 8\nwait 2");
  CHECK(says(rig, "8 is on, and shows nothing at this moment"));
  CHECK(rig.app->locate("legend"));
  rig.play("key 0\nwait 2");
  CHECK_FALSE(rig.app->locate("legend"));
  rig.app->ui_state().toasts.clear();
  rig.play("key 9\nwait 2");
  CHECK_FALSE(says(rig, "shows nothing"));
  CHECK(rig.app->locate("legend"));
  rig.app->session().post([](World& w) {
    for (const char* name : {"box", "ball"}) CHECK(w.destroy_body(w.find_body(name)).ok());
  });
  rig.play("key 9\nwait 2\nkey 9\nwait 2");  // only the ground is left
  CHECK(says(rig, "9 is on, and shows nothing"));
}

TEST_CASE("key 4 draws friction cones, of the selected body alone, and 0 takes them away") {
  const auto device = make_null_device();
  Rig rig(*device);
  const auto lines = [&] { return rig.app->picture().lines.size(); };
  rig.play("wait 90\nclick transport.pause");
  REQUIRE(lines() == 0);
  const uint64_t without = rig.app->report().draws.hash;
  constexpr size_t lines_of_cone = 16 + 4 + 1;
  rig.play("key 4");
  const size_t all = lines();
  CHECK(all >= 5 * lines_of_cone);  // the box on four corners, the ball on a point
  CHECK(all % lines_of_cone == 0);
  CHECK(rig.app->report().draws.hash != without);
  rig.play("click body:ball\nwait 2");
  CHECK(lines() == lines_of_cone);
  rig.play("key Esc");
  CHECK(lines() == all);
  rig.play("key 0");
  CHECK(lines() == 0);
  check_no_faults(*device);
}

TEST_CASE("a click on a drawn contact shows what it claims, under both steppers") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 800, 1};
  const auto contact = [&] { return rig.app->contact(); };
  const double weight =
      rig.app->view().to->info(1).mass * rig.app->view().to->gravity.norm();  // of the box
  rig.play("wait 20\nclick transport.pause\nclick contact\nwait 3");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::contact));  // nothing was drawn there
  rig.play("key 1\nclick contact\nwait 3");
  REQUIRE(rig.app->ui_state().shows(PanelId::contact));
  REQUIRE(contact());
  REQUIRE(contact()->certificate);
  CHECK(contact()->certificate->solver == "realtime");
  CHECK_FALSE(contact()->balance_b);
  CHECK(contact()->certificate->force.norm() < weight);

  rig.app->session().post([](World& world) {
    WorldSettings settings = world.settings();
    settings.stepper = "event";
    REQUIRE(world.set_settings(settings).ok());
  });
  rig.play("key .\nwait 3");
  REQUIRE(contact());
  REQUIRE(contact()->certificate);
  CHECK(contact()->certificate->mode == ContactMode::sticking);
  CHECK(contact()->certificate->residual < 1e-9);
  REQUIRE(contact()->balance_b);
  CHECK(std::abs(contact()->balance_b->contact_force.y() / weight - 1) < 1e-9);
  CHECK(contact()->balance_b->residual < 1e-9);
  rig.play("click contact.b\nwait 2");
  CHECK(rig.app->selected() == contact()->pick.b);

  rig.play("key Del\nwait 3");
  REQUIRE(contact());
  CHECK_FALSE(contact()->certificate);
  rig.play("key Esc\nwait 2");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::contact));
  CHECK_FALSE(contact());
  check_no_faults(*device);
}

TEST_CASE(
    "overlays of a scene come and go with it, those that a person chose stay, trails follow") {
  const auto device = make_null_device();
  Rig rig(*device);
  const auto& on = rig.app->ui_state().overlays;
  rig.play("wait 2\nkey 1\nwait 2");
  CHECK(on.contacts);
  CHECK_FALSE(on.joints);
  rig.play("drop overlays\nwait 40");
  CHECK(on.contacts);
  CHECK(on.joints);
  const size_t lines = rig.app->picture().lines.size();
  CHECK(lines > 20);  // the ball has fallen
  rig.play("key Space\nwait 2\nkey Shift+,\nwait 2");
  CHECK(rig.app->picture().lines.size() < lines);
  rig.play("drop second\nwait 20");
  CHECK(on.contacts);
  CHECK_FALSE(on.joints);
  CHECK(rig.app->picture().lines.empty());
  check_no_faults(*device);
}

TEST_CASE("trails are switched on for any scene, have the length that is chosen, and go with it") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  const auto lines = [&] { return rig.app->picture().lines.size(); };
  rig.play("wait 5\nclick bar.drawing\nwait 3");
  REQUIRE(lines() == 0);
  rig.play("click drawing.trails\nwait 40");
  const size_t grown = lines();
  CHECK(grown > 10);  // the ball falls
  REQUIRE(rig.app->locate("drawing.trail_length").has_value());
  // Pulled to a shorter length it begins anew, when the slider is let go.
  rig.play("drag drawing.trail_length -60 0\nwait 2");
  CHECK(rig.app->ui_state().trail.value_or(0) < 2);
  CHECK(rig.app->ui_state().trail.value_or(0) > 0);
  rig.play("key Space\nwait 2");
  CHECK(lines() < grown);
  rig.play("click drawing.trails\nwait 2");
  CHECK(lines() == 0);  // at once, though time stands still
  rig.play("drop second\nwait 3");
  CHECK_FALSE(rig.app->ui_state().trail.has_value());
  check_no_faults(*device);
}

TEST_CASE("arrows of velocity, momentum and total force, with their scales, also while paused") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 800, 1};
  const Overlays& overlays = rig.app->ui_state().overlays;
  rig.play("wait 20\nkey Space\nwait 2");
  const size_t without = rig.app->picture().lines.size();
  rig.play("key Shift+3\nwait 2");
  CHECK(overlays.total_forces);
  const size_t with_forces = rig.app->picture().lines.size();
  CHECK(with_forces > without);  // the ball falls
  CHECK(rig.app->ui().find("legend"));
  rig.play("key Shift+2\nkey Shift+1\nwait 2");
  CHECK(overlays.momenta);
  CHECK(overlays.velocities);
  // Where one has gone back to, the tick before is known as well.
  rig.app->ask(SeekTick{7});
  rig.play("wait 3");
  REQUIRE(rig.tick() == 7);
  REQUIRE(rig.app->view().before);
  CHECK(rig.app->view().before->tick == 6);
  const double length = overlays.vector_length;
  rig.play("key 0\nwait 2");
  CHECK_FALSE(overlays.total_forces);
  CHECK(overlays.vector_length == length);
  CHECK(rig.app->picture().lines.size() == without);
  check_no_faults(*device);
}
