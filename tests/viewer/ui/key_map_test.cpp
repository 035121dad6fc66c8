// Reference: the table of keys promised to users, written out here by hand.
#include "viewer/interact/key_map.hpp"

#include "viewer/ui/panel.hpp"
#include "viewer/ui/shell.hpp"

#include <map>
#include <set>
#include <string>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("no two bindings share a key with the same modifiers") {
  std::set<std::pair<Key, uint8_t>> seen;
  for (const Binding& b : all_bindings()) {
    CAPTURE(chord_text(b));
    CHECK(b.key != Key::none);
    CHECK(seen.insert({b.key, b.mods}).second);
    CHECK_FALSE(b.doc.empty());
    CHECK_FALSE(b.group.empty());
  }
}

TEST_CASE("keys do what users were promised") {
  const std::map<std::string, Action> promised = {{"Space", Action::toggle_pause},
                                                  {".", Action::step_forward},
                                                  {",", Action::step_back},
                                                  {"Shift+.", Action::step_forward_ten},
                                                  {"Ctrl+.", Action::next_impact},
                                                  {"Shift+,", Action::step_back_ten},
                                                  {"R", Action::restart},
                                                  {"Shift+R", Action::restart_as_scene},
                                                  {"C", Action::scene_camera},
                                                  {"F", Action::frame_all},
                                                  {"-", Action::slower},
                                                  {"=", Action::faster},
                                                  {"[", Action::previous_scene},
                                                  {"]", Action::next_scene},
                                                  {"Ctrl+O", Action::pick_scene},
                                                  {"Ctrl+Z", Action::undo},
                                                  {"Ctrl+Shift+Z", Action::redo},
                                                  {"Ctrl+Y", Action::redo},
                                                  {"Ctrl+D", Action::duplicate},
                                                  {"Ctrl+C", Action::copy},
                                                  {"Ctrl+V", Action::paste},
                                                  {"Ctrl+A", Action::select_all},
                                                  {"G", Action::handles_move},
                                                  {"T", Action::handles_turn},
                                                  {"X", Action::handles_scale},
                                                  {"K", Action::toggle_compare},
                                                  {"J", Action::toggle_assertions},
                                                  {"L", Action::toggle_lesson},
                                                  {"I", Action::toggle_parts},
                                                  {"Shift+I", Action::toggle_description},
                                                  {"PageDown", Action::lesson_next},
                                                  {"PageUp", Action::lesson_back},
                                                  {"Ctrl+S", Action::save_scene},
                                                  {"Del", Action::delete_body},
                                                  {"F5", Action::save_snapshot},
                                                  {"F7", Action::restore_snapshot},
                                                  {"F12", Action::screenshot},
                                                  {"Ctrl+F12", Action::screenshot_plain},
                                                  {"F9", Action::toggle_sequence},
                                                  {"Ctrl+=", Action::larger},
                                                  {"Ctrl+-", Action::smaller},
                                                  {"F6", Action::next_theme},
                                                  {"Shift+F9", Action::toggle_video},
                                                  {"Ctrl+F9", Action::save_replay},
                                                  {"Ctrl+Shift+F9", Action::save_packed_replay},
                                                  {"Tab", Action::toggle_panels},
                                                  {"F1", Action::toggle_help},
                                                  {"?", Action::toggle_help},
                                                  {"F3", Action::toggle_statistics},
                                                  {"F4", Action::toggle_energy},
                                                  {"B", Action::toggle_build},
                                                  {"P", Action::toggle_measure},
                                                  {"V", Action::toggle_events},
                                                  {"Shift+B", Action::toggle_bookmarks},
                                                  {"Ctrl+B", Action::toggle_bookmark},
                                                  {"Ctrl+]", Action::next_bookmark},
                                                  {"Ctrl+[", Action::previous_bookmark},
                                                  {"Ctrl+L", Action::toggle_loop},
                                                  {"U", Action::toggle_ruler},
                                                  {"Y", Action::add_camera_key},
                                                  {"Shift+Y", Action::toggle_flight},
                                                  {"H", Action::toggle_free_flight},
                                                  {"W", Action::fly_forward},
                                                  {"S", Action::fly_back},
                                                  {"A", Action::fly_left},
                                                  {"D", Action::fly_right},
                                                  {"E", Action::fly_up},
                                                  {"Q", Action::fly_down},
                                                  {"Shift+1", Action::overlay_velocities},
                                                  {"Shift+2", Action::overlay_momenta},
                                                  {"Shift+3", Action::overlay_total_forces},
                                                  {"Shift+K", Action::next_comparison_view},
                                                  {"F11", Action::full_screen},
                                                  {"Ctrl+Q", Action::quit},
                                                  {"M", Action::toggle_microscope},
                                                  {"N", Action::microscope_next},
                                                  {"Shift+N", Action::microscope_previous},
                                                  {"Ctrl+Shift+N", Action::microscope_first},
                                                  {"Ctrl+N", Action::new_scene},
                                                  {"1", Action::overlay_contacts},
                                                  {"2", Action::overlay_normals},
                                                  {"3", Action::overlay_forces},
                                                  {"4", Action::overlay_friction},
                                                  {"5", Action::overlay_bounds},
                                                  {"6", Action::overlay_hierarchy},
                                                  {"Shift+6", Action::overlay_hierarchy_back},
                                                  {"7", Action::overlay_grid},
                                                  {"8", Action::overlay_joints},
                                                  {"9", Action::overlay_collision_shape},
                                                  {"0", Action::overlay_none},
                                                  {"Esc", Action::close}};
  std::map<std::string, Action> table;
  for (const Binding& b : all_bindings()) table[chord_text(b)] = b.action;
  CHECK(table.size() == promised.size());
  for (const auto& promise : promised) {
    CAPTURE(promise.first);
    REQUIRE(table.count(promise.first) == 1);
    CHECK(table[promise.first] == promise.second);
  }
}

TEST_CASE("a key with other modifiers is another chord, and only some keys repeat") {
  CHECK(find_action(letter_key('R'), Mods::none) == Action::restart);
  CHECK_FALSE(find_action(letter_key('R'), Mods::ctrl));
  CHECK_FALSE(find_action(letter_key('Z'), Mods::none));
  CHECK(find_action(Key::period, Mods::none, true) == Action::step_forward);
  CHECK_FALSE(find_action(Key::space, Mods::none, true));
}

TEST_CASE("every key has a name that leads back to it") {
  for (const Binding& b : all_bindings()) {
    CAPTURE(key_name(b.key));
    CHECK(key_from_name(key_name(b.key)) == b.key);
  }
}

TEST_CASE("the help shows every action of the table once") {
  UiHost host;
  UiModel model;
  model.frame = std::make_shared<Frame>();
  const std::vector<SceneItem> scenes;
  const History history;
  model.scenes = &scenes;
  model.history = &history;
  UiState state;
  state.shows(PanelId::help) = true;
  UiDrawList out;
  for (int i = 0; i < 3; ++i) {
    std::vector<UiRequest> requests;
    host.begin(1280, 800, 1.0 / 60, {}, false);
    PanelContext context{host, model, state, requests, 1.0 / 60};
    draw_ui(context, 1280, 800);
    host.end(out);
  }
  std::set<Action> listed, all;
  for (const Binding& b : all_bindings()) {
    all.insert(b.action);
    if (host.find("help." + chord_text(b))) CHECK(listed.insert(b.action).second);
  }
  CHECK(listed == all);
  CHECK(out.vertices.size() > 1000);
}
