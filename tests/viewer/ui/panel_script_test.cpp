// Panels, messages and what a person chooses in them, by script. Reference: the state of the panels
// and the settings of the world.
#include "tests/viewer/ui/session_rig.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

WorldSettings settings_of(Rig& rig) {
  auto answer = rig.app->session().call([](World& w) { return w.settings(); });
  rig.frame();
  return answer.get();
}

}  // namespace

TEST_CASE("scenes open by search and by brackets, a faulty file is shown and the old one stays") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("key Ctrl+O\nwait 3\ntext sec\nwait 2\nkey Enter\nwait 2");
  CHECK(rig.app->scene_name() == "second");
  rig.play("key ]");
  CHECK(rig.app->scene_name() == "first");
  rig.play("drop broken.json\nwait 2");
  CHECK(rig.app->scene_name() == "first");
  REQUIRE(rig.app->ui_state().toasts.size() == 1);
  CHECK(rig.app->ui_state().toasts[0].kind == ToastKind::error);
  CHECK(rig.app->ui_state().toasts[0].lines.size() == 2);
  rig.play("key Esc");
  CHECK(rig.app->ui_state().toasts.empty());
  rig.play("drop second\nwait 2");
  CHECK(rig.app->scene_name() == "second");
}

TEST_CASE("R keeps settings that were chosen and says so, Shift+R goes back to the scene's") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 800, 1};  // with room for all words of the bar
  rig.play("wait 10\nkey R\nwait 2");
  CHECK_FALSE(says(rig, "Restarted"));  // nothing was chosen
  rig.play("wait 10\nkey Space\nwait 2");
  const WorldSettings of_scene = settings_of(rig);
  REQUIRE(of_scene.broad_phase != "aabb_tree");
  rig.play("click bar.settings\nwait 3\nclick settings.broad_phase\nwait 3");
  rig.play("click settings.broad_phase.aabb_tree\nwait 3\nclick bar.settings\nwait 3");
  for (int times = 0; times < 2; ++times) {
    rig.play("key R\nwait 2");
    CHECK(rig.tick() == 0);
    CHECK(settings_of(rig).broad_phase == "aabb_tree");
    CHECK(says(rig, "Restarted with the settings chosen here"));
    CHECK(says(rig, "Kept: broad_phase"));
    rig.play("key Shift+.\nwait 2");
    CHECK(rig.tick() == 10);
  }
  rig.play("key Shift+R\nwait 2");
  CHECK(rig.tick() == 0);
  CHECK(settings_of(rig).broad_phase == of_scene.broad_phase);
  CHECK(says(rig, "Restarted as the scene has it"));
}

TEST_CASE("letters typed into a text field are no commands") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20\nkey Ctrl+O\nwait 3\nkey R\nkey Space\nwait 2");
  CHECK(rig.tick() > 20);
  CHECK_FALSE(rig.app->session().paused());
}

TEST_CASE("what is typed right behind Ctrl+O goes into the search and is no command") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20");
  // All within one picture, as on a machine that draws slowly.
  rig.frame({KeyPressed{Key::control, true, false}, KeyPressed{letter_key('O'), true, false},
             KeyPressed{letter_key('O'), false, false}, KeyPressed{Key::control, false, false},
             KeyPressed{letter_key('R'), true, false}, TextTyped{'s'},
             KeyPressed{letter_key('R'), false, false}});
  rig.frame({TextTyped{'e'}});
  rig.frame({TextTyped{'c'}});
  rig.play("wait 3");
  CHECK(rig.app->ui_state().search == "sec");
  CHECK(rig.tick() > 20);
  // Leaving it gives the keys back at once.
  rig.frame({KeyPressed{Key::escape, true, false}, KeyPressed{Key::escape, false, false},
             KeyPressed{f_key(3), true, false}, KeyPressed{f_key(3), false, false}});
  rig.play("wait 3");  // keys behind one that may move the focus wait for the next picture
  CHECK(rig.app->ui_state().shows(PanelId::statistics));
  rig.frame({KeyPressed{f_key(4), true, false}, KeyPressed{f_key(4), false, false}});
  CHECK(rig.app->ui_state().shows(PanelId::energy));
}

TEST_CASE("a message lies over the panels of a small window, also over one that was clicked") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {420, 320, 1};
  rig.app->ui_state().toasts.clear();
  rig.app->ui_state().shows(PanelId::drawing) = true;
  rig.play("wait 3\nclick panel.drawing\nwait 2\ndrop bad.json\nwait 5");
  REQUIRE(rig.app->ui_state().toasts.size() == 1);
  const auto panel = rig.app->ui().find("panel.drawing"),
             close = rig.app->ui().find("toast0.close");
  REQUIRE(panel);
  REQUIRE(close);
  REQUIRE(panel->overlaps(*close));
  rig.play("click toast0.close\nwait 2");
  CHECK(rig.app->ui_state().toasts.empty());
}

TEST_CASE("a setting that the world refuses is said and not shown") {
  const auto device = make_null_device();
  Rig rig(*device);
  const WorldSettings before = settings_of(rig);
  // As typed over the slider: the stepper has no such algorithm.
  WorldSettings wrong = before;
  wrong.event.integrator = "no_such_integrator";
  rig.app->ask(ChangeSettings{wrong});
  rig.play("wait 3");
  CHECK(says(rig, "This setting is not possible"));
  CHECK(rig.app->settings().event.integrator == before.event.integrator);
  CHECK(settings_of(rig).event.integrator == before.event.integrator);
  WorldSettings right = before;
  right.gravity = Vec3(0, -1.6, 0);
  rig.app->ask(ChangeSettings{right});
  rig.play("wait 3");
  CHECK(rig.app->settings().gravity.now() == right.gravity.now());
}

TEST_CASE("what is said of an entry of a panel stands beside the panel, and in the picture") {
  const auto device = make_null_device();
  Rig rig(*device);
  for (const double width : {800.0, 1200.0}) {
    CAPTURE(width);
    rig.picture = {int(width), 700, 1};
    rig.app->ui_state().shows(PanelId::settings) = true;
    rig.play("wait 3");
    for (const char* entry : {"settings.tick_hz", "settings.narrow_phase"}) {
      CAPTURE(entry);
      rig.play(std::string("move ") + entry + "\nwait 3");
      const auto panel = rig.app->ui().find("panel.settings"),
                 tooltip = rig.app->ui().find("tooltip"), of = rig.app->ui().find(entry);
      REQUIRE((panel && tooltip && of));
      CHECK_FALSE(tooltip->overlaps(*panel));
      CHECK(tooltip->x >= 0);
      CHECK(tooltip->x + tooltip->width <= float(width));
      CHECK(std::abs(tooltip->y + tooltip->height / 2 - of->y - of->height / 2) < of->height / 2);
    }
  }
}

TEST_CASE("a click on a number begins to type: what follows is no command") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 800, 1};
  rig.app->ui_state().shows(PanelId::settings) = true;
  rig.play("key Space\nwait 3\nclick settings.gravity.y\nwait 3\nkey 1\nwait 2");
  CHECK_FALSE(rig.app->ui_state().overlays.contacts);
  rig.play("text -3\nkey Enter\nwait 3");
  CHECK(rig.app->settings().gravity.now().y() == -3);
  // Pulled it changes as before.
  rig.play("drag settings.gravity.y 40 0\nwait 3");
  CHECK(rig.app->settings().gravity.now().y() > -3);
}

TEST_CASE("what is said of a button of the bar stands under the bar, and lies over no other") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  for (const char* button : {"bar.build", "bar.help", "bar.scene", "transport.pause"}) {
    rig.play(std::string("wait 2\nmove ") + button + "\nwait 3");
    const auto tooltip = rig.app->ui().find("tooltip"), bar = rig.app->ui().find("panel.bar");
    REQUIRE_MESSAGE(tooltip, button);
    REQUIRE(bar);
    CHECK_MESSAGE(tooltip->y >= bar->y + bar->height, button);
    CHECK_MESSAGE(tooltip->x >= 0, button);
    CHECK_MESSAGE(tooltip->x + tooltip->width <= 1280, button);
  }
}

TEST_CASE("a number that Esc gives up leaves nothing to be taken back") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 800, 1};
  rig.app->ui_state().shows(PanelId::settings) = true;
  const auto type = [&](const char* text, const char* end) {
    rig.play(std::string("double_click settings.gravity.y\nwait 3\nkey Ctrl+A\ntext ") + text +
             "\nwait 3\nkey " + end + "\nwait 3");
  };
  rig.play("key Space\nwait 3");
  type("-3", "Enter");
  REQUIRE(rig.app->settings().gravity.now().y() == -3);
  type("-7", "Esc");
  REQUIRE(rig.app->settings().gravity.now().y() == -3);
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(rig.app->settings().gravity.now().y() == doctest::Approx(-9.81));
  // What is typed after that is an undo step of its own.
  type("-5", "Esc");
  type("-4", "Enter");
  CHECK(rig.app->settings().gravity.now().y() == -4);
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(rig.app->settings().gravity.now().y() == doctest::Approx(-9.81));
  check_no_faults(*device);
}

TEST_CASE("what is said of a button of the bar lies over no cross of a panel") {
  const auto device = make_null_device();
  Rig rig(*device);
  size_t said = 0;
  for (const int width : {800, 1024, 1280}) {
    CAPTURE(width);
    rig.picture = {width, 720, 1};
    for (const PanelId panel : {PanelId::settings, PanelId::statistics, PanelId::drawing})
      rig.app->ui_state().shows(panel) = true;
    rig.play("wait 4");
    const auto widgets = rig.app->ui().widgets();
    for (const auto& [button, place] : widgets) {
      if (!button.starts_with("bar.") && !button.starts_with("transport.")) continue;
      const auto& shown_button = button;
      CAPTURE(shown_button);
      rig.play("move " + button + "\nwait 3");
      const auto tooltip = rig.app->ui().find("tooltip");
      if (!tooltip) continue;
      ++said;
      CHECK(tooltip->x >= 0);
      CHECK(tooltip->x + tooltip->width <= float(width));
      for (const auto& [name, cross] : rig.app->ui().widgets()) {
        const auto& shown_name = name;
        if (name.ends_with(".close")) CHECK_MESSAGE(!tooltip->overlaps(cross), shown_name);
      }
    }
  }
  CHECK(said > 20);
}

TEST_CASE("the heading of a panel stays while its contents scroll, and its cross closes it") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 420, 1};
  rig.play("key Space\nclick body:box\nwait 3");
  const auto y = [&](const char* name) { return rig.app->locate(name)->y; };
  const double cross = y("inspector.close"), below = y("inspector.focus");
  rig.play("move inspector.focus\nwheel -3\nwait 3");
  REQUIRE(rig.app->locate("inspector.close"));
  CHECK(y("inspector.close") == cross);
  const auto moved = rig.app->locate("inspector.focus");
  CHECK((!moved || moved->y < below - 20));
  rig.play("click inspector.close\nwait 3");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::inspector));
}

TEST_CASE("nothing of the body's panel moves when the first contact comes or goes") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.play("key Space\nclick body:ball\nwait 5");
  const auto places = [&] {
    std::vector<double> out;
    for (const char* name : {"inspector.focus", "inspector.group.0", "inspector.group.1",
                             "inspector.group.2", "panel.inspector"})
      out.push_back(rig.app->locate(name) ? rig.app->locate(name)->y : -1);
    return out;
  };
  const auto before = places();
  REQUIRE(before[1] > 0);
  bool touched = false;
  for (int tick = 0; tick < 80; ++tick) {
    rig.play("key .");
    CHECK(places() == before);
    rig.app->view().to->for_contacts([&](const ContactFrame& c) {
      touched = touched || c.a == rig.app->selected() || c.b == rig.app->selected();
    });
  }
  CHECK(touched);
}

TEST_CASE("the list of scenes shows titles, is searched by them, and its top stays") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("key Ctrl+O\nwait 4");
  const auto top = [&] { return rig.app->ui().find("panel.scenes")->y; };
  const float at_first = top();
  rig.play("text the title of sec\nwait 4");
  CHECK(top() == at_first);
  rig.play("key Enter\nwait 3");
  CHECK(rig.app->scene_name() == "second");
}

TEST_CASE("a word of the bar leads to bookmarks, loop and flight") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1280, 720, 1};
  rig.play("wait 3\nclick bar.bookmarks\nwait 3");
  CHECK(rig.app->ui_state().shows(PanelId::bookmarks));
  REQUIRE(rig.app->locate("bookmarks.key"));
}

TEST_CASE("a panel that is too long has a scrollbar at its edge, which can be dragged") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 500, 1};
  rig.play("click bar.settings\nwait 5");
  const auto panel = rig.app->ui().find("panel.settings");
  REQUIRE(panel);
  REQUIRE(rig.app->ui().find("settings.tick_hz"));
  const int x = int(panel->x + panel->width) - 4, y = int(panel->y) + 60;
  rig.play("drag " + std::to_string(x) + "," + std::to_string(y) + " 0 300\nwait 3");
  CHECK_FALSE(rig.app->ui().find("settings.tick_hz"));
  rig.play("drag " + std::to_string(x) + "," + std::to_string(y + 300) + " 0 -320\nwait 3");
  CHECK(rig.app->ui().find("settings.tick_hz"));
}

TEST_CASE("an open dialog takes the keys: nothing happens to the world behind it") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1600, 900, 1};
  rig.play("wait 5\nkey Space\nclick body:box\nwait 3");
  const UiState& ui = rig.app->ui_state();
  const uint64_t tick = rig.tick();
  REQUIRE(tick > 0);
  const World& world = rig.app->session().world();
  for (const char* open : {"key F1", "key Ctrl+S"}) {
    rig.play(std::string(open) + "\nwait 3\nkey Del\nkey R\nkey E\nkey B\nkey Space\nwait 3");
    CHECK(rig.tick() == tick);
    CHECK_FALSE(world.find_body("box").is_null());
    CHECK(rig.app->session().paused());
    CHECK_FALSE(ui.shows(PanelId::energy));
    CHECK_FALSE(ui.shows(PanelId::build));
    rig.play("key Esc\nwait 3");
    CHECK_FALSE(ui.shows(PanelId::help));
    CHECK_FALSE(ui.shows(PanelId::save));
  }
  rig.play("key F1\nwait 3\nkey F1\nwait 3");
  CHECK_FALSE(ui.shows(PanelId::help));
  rig.play("key R\nwait 3");
  CHECK(rig.tick() == 0);
  check_no_faults(*device);
}

TEST_CASE(
    "a click goes through a message of a fault but for its cross, and Esc closes all of them") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1600, 900, 1};
  UiState& ui = rig.app->ui_state();
  rig.play("wait 3");
  ui.toasts.clear();
  for (const char* title : {"one", "two", "three"}) ui.toast(ToastKind::error, title, {"a line"});
  rig.play("wait 3\nmove toast0\nwait 3");
  CHECK_FALSE(rig.app->ui().wants_pointer());
  rig.play("move toast0.close\nwait 3");
  CHECK(rig.app->ui().wants_pointer());
  rig.play("click toast0.close\nwait 3");
  CHECK_FALSE(says(rig, "one"));
  CHECK(says(rig, "two"));
  rig.play("key Esc\nwait 3");
  CHECK_FALSE(says(rig, "two"));
  CHECK_FALSE(says(rig, "three"));
}
