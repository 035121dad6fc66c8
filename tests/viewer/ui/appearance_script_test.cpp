// Keys of one's own, theme and size of the panels. References: bindings and files written by hand.
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/app/window/preferences.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/interact/key_file.hpp"

#include <algorithm>
#include <set>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

/// The usual bindings come back at the end.
struct OwnBindings {
  std::vector<std::string> faults;
  explicit OwnBindings(std::string_view json) : faults(take_bindings(json)) {}
  ~OwnBindings() { take_usual_bindings(); }
};

bool any_with(const std::vector<std::string>& all, std::string_view words) {
  return std::ranges::any_of(all, [&](const std::string& s) { return s.find(words) != s.npos; });
}

}  // namespace

TEST_CASE("keys of one's own stand in the place of the usual ones, in help and buttons too") {
  const OwnBindings own(
      R"({"toggle_pause": "F2", /* as elsewhere */ "restart": ["Ctrl+R", "Home"], "quit": "",
                            "toggle_measure": "Space"})");
  CHECK(own.faults.empty());
  CHECK(find_action(f_key(2), Mods::none) == Action::toggle_pause);
  CHECK(find_action(Key::space, Mods::none) == Action::toggle_measure);
  CHECK(find_action(letter_key('R'), Mods::ctrl) == Action::restart);
  CHECK(find_action(Key::home, Mods::none) == Action::restart);
  CHECK_FALSE(find_action(letter_key('R'), Mods::none));
  CHECK_FALSE(find_action(letter_key('Q'), Mods::ctrl));
  CHECK(shortcut_of(Action::restart) == "Ctrl+R");
  CHECK(shortcut_of(Action::quit).empty());
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("key F2\nwait 2");
  CHECK(rig.app->session().paused());
  rig.play("key Space\nwait 2");
  CHECK(rig.app->session().paused());
  CHECK(rig.app->ui_state().shows(PanelId::measure));
  rig.picture = {1200, 900, 1};
  rig.play("key F1\nwait 3");
  CHECK(rig.app->ui().find("help.F2"));
  CHECK(rig.app->ui().find("help.Ctrl+R"));
  check_no_faults(*device);
}

TEST_CASE("what is wrong in a file of keys is said, and the rest holds") {
  const OwnBindings own(
      R"({"toggle_pause": "F2", "tuggle_help": "F8", "restart": "Ctrl+Nonsense", "faster": 3,
                            "slower": "F2", "frame_all": "C", "undo": "Shift"})");
  CHECK(own.faults.size() == 6);
  CHECK(any_with(own.faults, "did you mean 'toggle_help'?"));
  CHECK(any_with(own.faults, "restart: 'Ctrl+Nonsense' is no chord"));
  CHECK(any_with(own.faults, "faster: must be a chord"));
  CHECK(any_with(own.faults, "slower: F2 is toggle_pause already"));
  CHECK(
      any_with(own.faults, "frame_all: C is scene_camera already: give scene_camera another key"));
  CHECK(any_with(own.faults, "undo: 'Shift' is no chord"));
  CHECK(find_action(f_key(2), Mods::none) == Action::toggle_pause);
  CHECK(find_action(letter_key('R'), Mods::none) == Action::restart);
  CHECK(find_action(letter_key('C'), Mods::none) == Action::scene_camera);
  // What wished for a key that is taken keeps its usual one.
  CHECK_FALSE(shortcut_of(Action::frame_all).empty());
  CHECK_FALSE(shortcut_of(Action::slower).empty());
  const OwnBindings torn("{\n  \"undo\": \"U\",\n  \"redo\" \"Y\"\n}");
  REQUIRE(torn.faults.size() == 1);
  CHECK(torn.faults[0].starts_with("line 3, column 12: this is not JSON"));
  CHECK(torn.faults[0].find("json.exception") == std::string::npos);
  for (const char* bad : {"", "[]", "{\"a\"", "3"}) {
    const OwnBindings none(bad);
    CHECK(none.faults.size() == 1);
    CHECK(all_bindings().size() == usual_bindings().size());
  }
}

TEST_CASE("every action has a name of its own, and every usual chord leads back") {
  std::set<std::string_view> names;
  for (size_t i = 0; i < action_count; ++i) {
    const Action action = Action(i);
    CHECK(names.insert(action_name(action)).second);
    CHECK(action_from_name(action_name(action)) == action);
  }
  for (const Binding& b : usual_bindings()) {
    const auto chord = chord_from_text(chord_text(b));
    REQUIRE_MESSAGE(chord, chord_text(b));
    CHECK(chord->key == b.key);
    CHECK(chord->mods == b.mods);
  }
}

TEST_CASE("theme and size change by keys and buttons, and are kept") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.play("key F6\nkey Ctrl+=\nkey Ctrl+=\nwait 2");
  CHECK(rig.app->ui_state().theme == Theme::light);
  CHECK(rig.app->zoom() == doctest::Approx(1.2));
  std::vector<std::string> faults;
  const auto kept = [&] {
    return read_preferences(*read_file(rig.folder.path() / "config/window.json"), faults);
  };
  CHECK(kept().theme == Theme::light);
  CHECK(kept().zoom == doctest::Approx(1.2));
  rig.play("click bar.drawing\nwait 3\nclick drawing.dark\nwait 2\nclick drawing.smaller\nwait 2");
  CHECK(rig.app->ui_state().theme == Theme::dark);
  CHECK(kept().theme == Theme::dark);
  CHECK(kept().zoom == doctest::Approx(1.1));
  for (int i = 0; i < 30; ++i) rig.app->perform(Action::larger);
  CHECK(rig.app->zoom() == greatest_zoom);
  for (int i = 0; i < 30; ++i) rig.app->perform(Action::smaller);
  CHECK(rig.app->zoom() == least_zoom);
  CHECK(faults.empty());
  check_no_faults(*device);
}

TEST_CASE("what is wrong in the window's file is said, and the rest holds") {
  std::vector<std::string> faults;
  const Preferences p = read_preferences(R"({"theme": "pink", "scale": 1.3, "colour": 1})", faults);
  CHECK(p.theme == Theme::dark);
  CHECK(p.zoom == 1.3);
  CHECK(faults.size() == 2);
  CHECK(any_with(faults, "theme: 'pink' is none: write \"dark\" or \"light\""));
  faults.clear();
  CHECK(read_preferences(R"({"scale": 9})", faults).zoom == 1);
  CHECK(any_with(faults, "scale: must be a number from 0.7 to 2.5, got 9"));
}

TEST_CASE("text can be told from what is behind it in both themes") {
  // Relative luminance and contrast as the Web Content Accessibility Guidelines define them.
  const auto luminance = [](uint32_t c) {
    double sum = 0;
    const double weights[3] = {0.2126, 0.7152, 0.0722};
    for (int k = 0; k < 3; ++k) {
      const double v = double(c >> 8 * k & 255) / 255;
      sum += weights[k] * (v <= 0.03928 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
    return sum;
  };
  const auto contrast = [&](uint32_t a, uint32_t b) {
    const double x = luminance(a) + 0.05, y = luminance(b) + 0.05;
    return std::max(x, y) / std::min(x, y);
  };
  UiHost host;
  for (const Theme theme : {Theme::light, Theme::dark}) {
    host.set_theme(theme);
    using namespace palette;
    CHECK(contrast(text, panel) > 7);
    for (const uint32_t c : {dim, accent, green, blue, violet, red, yellow})
      CHECK(contrast(c, panel) > 4.5);
    CHECK(contrast(faint, panel) > 3);
    CHECK(contrast(text, raised) > 7);
    for (const uint32_t c : series) CHECK(contrast(c, panel) > 3);
  }
}
