#include "viewer/interact/key_map.hpp"

#include "viewer/interact/key_file.hpp"

#include <algorithm>
#include <iterator>

namespace tumble {
namespace {

constexpr uint8_t none = Mods::none, shift = Mods::shift, ctrl = Mods::ctrl;

constexpr Key digit(int n) {
  return Key('0' + n);
}

/// In the order of the enumeration.
constexpr std::string_view names[] = {
    "toggle_pause",
    "step_forward",
    "step_forward_ten",
    "next_impact",
    "step_back",
    "step_back_ten",
    "toggle_bookmark",
    "next_bookmark",
    "previous_bookmark",
    "toggle_loop",
    "restart",
    "restart_as_scene",
    "slower",
    "faster",
    "previous_scene",
    "next_scene",
    "pick_scene",
    "new_scene",
    "save_scene",
    "undo",
    "redo",
    "duplicate",
    "copy",
    "paste",
    "select_all",
    "delete_body",
    "save_snapshot",
    "restore_snapshot",
    "screenshot",
    "screenshot_plain",
    "toggle_sequence",
    "toggle_video",
    "save_replay",
    "save_packed_replay",
    "handles_move",
    "handles_turn",
    "handles_scale",
    "close",
    "scene_camera",
    "frame_all",
    "add_camera_key",
    "toggle_flight",
    "toggle_free_flight",
    "fly_forward",
    "fly_back",
    "fly_left",
    "fly_right",
    "fly_up",
    "fly_down",
    "toggle_panels",
    "toggle_help",
    "toggle_statistics",
    "toggle_energy",
    "toggle_build",
    "toggle_measure",
    "toggle_compare",
    "next_comparison_view",
    "toggle_events",
    "toggle_bookmarks",
    "toggle_ruler",
    "toggle_assertions",
    "toggle_lesson",
    "toggle_parts",
    "toggle_description",
    "lesson_next",
    "lesson_back",
    "larger",
    "smaller",
    "next_theme",
    "full_screen",
    "quit",
    "toggle_microscope",
    "microscope_next",
    "microscope_previous",
    "microscope_first",
    "overlay_contacts",
    "overlay_normals",
    "overlay_forces",
    "overlay_friction",
    "overlay_bounds",
    "overlay_hierarchy",
    "overlay_hierarchy_back",
    "overlay_grid",
    "overlay_joints",
    "overlay_collision_shape",
    "overlay_velocities",
    "overlay_momenta",
    "overlay_total_forces",
    "overlay_none",
};
static_assert(std::size(names) == action_count);

constexpr Binding usual[] = {
    {Action::toggle_pause, Key::space, none, "Time", "pause and go on"},
    {Action::step_forward, Key::period, none, "Time", "one tick forward", true},
    {Action::step_forward_ten, Key::period, shift, "Time", "ten ticks forward", true},
    {Action::next_impact, Key::period, ctrl, "Time", "to the next impact, or event of the list",
     true},
    {Action::step_back, Key::comma, none, "Time", "one tick back", true},
    {Action::step_back_ten, Key::comma, shift, "Time", "ten ticks back", true},
    {Action::restart, letter_key('R'), none, "Time", "restart, with the settings of now"},
    {Action::restart_as_scene, letter_key('R'), shift, "Time",
     "restart, with the scene's settings"},
    {Action::toggle_bookmark, letter_key('B'), ctrl, "Time", "a bookmark here, or no longer"},
    {Action::next_bookmark, Key::right_bracket, ctrl, "Time", "to the next bookmark"},
    {Action::previous_bookmark, Key::left_bracket, ctrl, "Time", "to the one before"},
    {Action::toggle_loop, letter_key('L'), ctrl, "Time", "play a span over and over"},
    {Action::slower, Key::minus, none, "Time", "half the speed"},
    {Action::faster, Key::equal, none, "Time", "twice the speed"},

    {Action::pick_scene, letter_key('O'), ctrl, "Scenes", "find a scene by name"},
    {Action::new_scene, letter_key('N'), ctrl, "Scenes", "a new scene: a floor, and nothing on it"},
    {Action::save_scene, letter_key('S'), ctrl, "Scenes", "save what was changed"},
    {Action::previous_scene, Key::left_bracket, none, "Scenes", "previous scene"},
    {Action::next_scene, Key::right_bracket, none, "Scenes", "next scene"},

    {Action::undo, letter_key('Z'), ctrl, "Edit", "take back what was done last", true},
    {Action::redo, letter_key('Z'), ctrl | shift, "Edit", "do it again", true},
    {Action::redo, letter_key('Y'), ctrl, "Edit", "do it again", true},
    {Action::duplicate, letter_key('D'), ctrl, "Edit", "a copy of the selected body", true},
    {Action::delete_body, Key::del, none, "Edit", "delete the selected body"},
    {Action::copy, letter_key('C'), ctrl, "Edit", "copy the selected bodies"},
    {Action::paste, letter_key('V'), ctrl, "Edit", "paste them, in another scene too"},
    {Action::select_all, letter_key('A'), ctrl, "Edit", "select everything that moves"},
    {Action::handles_move, letter_key('G'), none, "Edit", "handles that move"},
    {Action::handles_turn, letter_key('T'), none, "Edit", "handles that turn"},
    {Action::handles_scale, letter_key('X'), none, "Edit", "handles that scale"},
    {Action::save_snapshot, f_key(5), none, "Edit", "keep a snapshot"},
    {Action::restore_snapshot, f_key(7), none, "Edit", "go back to the snapshot"},

    {Action::screenshot, f_key(12), none, "Capture", "screenshot"},
    {Action::screenshot_plain, f_key(12), ctrl, "Capture", "screenshot without panels"},
    {Action::toggle_sequence, f_key(9), none, "Capture", "record pictures"},
    {Action::toggle_video, f_key(9), shift, "Capture", "record a video"},
    {Action::save_replay, f_key(9), ctrl, "Capture", "save a replay"},
    {Action::save_packed_replay, f_key(9), ctrl | shift, "Capture", "and the scene, in a pack"},

    {Action::scene_camera, letter_key('C'), none, "View", "the scene's camera"},
    {Action::frame_all, letter_key('F'), none, "View", "show everything"},
    {Action::add_camera_key, letter_key('Y'), none, "View", "a key of a flight, here and now"},
    {Action::toggle_flight, letter_key('Y'), shift, "View", "fly along the keys"},

    {Action::close, Key::escape, none, "Panels", "close, deselect, cancel a slow tick"},
    {Action::toggle_panels, Key::tab, none, "Panels", "hide and show all panels"},
    {Action::toggle_help, f_key(1), none, "Panels", "this help"},
    {Action::toggle_help, Key::slash, shift, "Panels", "this help"},
    {Action::toggle_statistics, f_key(3), none, "Panels", "statistics and stage profile"},
    {Action::toggle_energy, f_key(4), none, "Panels", "energy plot"},
    {Action::toggle_build, letter_key('B'), none, "Panels", "build: bodies, joints, springs"},
    {Action::toggle_measure, letter_key('P'), none, "Panels", "plot what bodies and joints do"},
    {Action::toggle_compare, letter_key('K'), none, "Panels", "compare with a second world"},
    {Action::next_comparison_view, letter_key('K'), shift, "Panels",
     "the second world as a ghost, side by side, or not"},
    {Action::toggle_events, letter_key('V'), none, "Panels", "list of events: impacts and others"},
    {Action::toggle_bookmarks, letter_key('B'), shift, "Panels",
     "bookmarks, loop, flight, recording"},
    {Action::toggle_ruler, letter_key('U'), none, "Panels", "ruler and protractor"},
    {Action::toggle_assertions, letter_key('J'), none, "Panels", "what the scene asserts, judged"},
    {Action::toggle_lesson, letter_key('L'), none, "Panels", "the lesson of the scene"},
    {Action::toggle_parts, letter_key('I'), none, "Panels", "emitters, sensors, forces, particles"},
    {Action::toggle_description, letter_key('I'), shift, "Panels",
     "all that the scene's file says"},
    {Action::lesson_next, Key::page_down, none, "Panels", "next page of the lesson"},
    {Action::lesson_back, Key::page_up, none, "Panels", "the page before"},
    {Action::larger, Key::equal, ctrl, "Panels", "larger panels and text", true},
    {Action::smaller, Key::minus, ctrl, "Panels", "smaller ones", true},
    {Action::next_theme, f_key(6), none, "Panels", "dark or light panels"},
    {Action::full_screen, f_key(11), none, "Panels", "full screen"},
    {Action::quit, letter_key('Q'), ctrl, "Panels", "quit"},

    {Action::toggle_microscope, letter_key('M'), none, "Microscope", "watch an algorithm at work"},
    {Action::microscope_next, letter_key('N'), none, "Microscope", "next step", true},
    {Action::microscope_previous, letter_key('N'), shift, "Microscope", "previous step", true},
    {Action::microscope_first, letter_key('N'), ctrl | shift, "Microscope", "first step"},

    {Action::overlay_contacts, digit(1), none, "Drawing", "contact points"},
    {Action::overlay_normals, digit(2), none, "Drawing", "contact normals"},
    {Action::overlay_forces, digit(3), none, "Drawing", "contact forces and fields"},
    {Action::overlay_friction, digit(4), none, "Drawing", "friction cones"},
    {Action::overlay_bounds, digit(5), none, "Drawing", "bounding boxes"},
    {Action::overlay_hierarchy, digit(6), none, "Drawing", "hierarchy of meshes, a level on"},
    {Action::overlay_hierarchy_back, digit(6), shift, "Drawing", "a level back"},
    {Action::overlay_grid, digit(7), none, "Drawing", "cells or boxes of the broad phase"},
    {Action::overlay_joints, digit(8), none, "Drawing", "joints and springs"},
    {Action::overlay_collision_shape, digit(9), none, "Drawing", "collision shapes"},
    {Action::overlay_velocities, digit(1), shift, "Drawing", "velocities"},
    {Action::overlay_momenta, digit(2), shift, "Drawing", "momenta"},
    {Action::overlay_total_forces, digit(3), shift, "Drawing", "total forces on bodies"},
    {Action::overlay_none, digit(0), none, "Drawing", "nothing but the scene"},

    {Action::toggle_free_flight, letter_key('H'), none, "Flying", "fly without holding a button"},
    {Action::fly_forward, letter_key('W'), none, "Flying", "forward (Shift: faster)"},
    {Action::fly_back, letter_key('S'), none, "Flying", "back"},
    {Action::fly_left, letter_key('A'), none, "Flying", "to the left"},
    {Action::fly_right, letter_key('D'), none, "Flying", "to the right"},
    {Action::fly_up, letter_key('E'), none, "Flying", "up"},
    {Action::fly_down, letter_key('Q'), none, "Flying", "down"},
};

constexpr PointerBinding pointer_bindings[] = {
    {"Click", "select a body"},
    {"  where 1-4 show contacts", "look into that contact"},
    {"  and Ctrl", "one more, or one less"},
    {"Ctrl + drag", "select what is in a box"},
    {"Left drag with handles shown", "stand the body on what is there"},
    {"Double click", "turn the view about this point"},
    {"Left drag on a body", "pull it by a spring"},
    {"  and wheel", "nearer or farther"},
    {"  and Shift", "turn it"},
    {"Left drag elsewhere", "orbit"},
    {"Middle drag, Alt + left drag", "pan"},
    {"Wheel", "zoom"},
    {"Hold right", "look around, and fly by the keys"},
    {"Shift + left", "shoot a ball"},
    {"Drop a file", "load a scene or a mesh"},
};

std::vector<Binding>& table() {
  static std::vector<Binding> bindings(std::begin(usual), std::end(usual));
  return bindings;
}

}  // namespace

std::span<const Binding> usual_bindings() {
  return usual;
}
std::span<const Binding> all_bindings() {
  return table();
}
void take_usual_bindings() {
  table().assign(std::begin(usual), std::end(usual));
}

std::string_view action_name(Action action) {
  return names[size_t(action)];
}
std::optional<Action> action_from_name(std::string_view name) {
  for (size_t i = 0; i < action_count; ++i)
    if (names[i] == name) return Action(i);
  return std::nullopt;
}

std::span<const PointerBinding> all_pointer_bindings() {
  return pointer_bindings;
}

std::vector<std::string> take_bindings(std::string_view json) {
  std::vector<std::string> faults;
  table() = read_key_file(json, faults);
  return faults;
}

bool is_held(Action action, const HeldInput& held) {
  return std::ranges::any_of(
      table(), [&](const Binding& b) { return b.action == action && held.key(b.key); });
}

bool is_fly_key(Key key) {
  return std::ranges::any_of(table(), [&](const Binding& b) {
    return b.action >= Action::fly_forward && b.action <= Action::fly_down && b.key == key;
  });
}

std::optional<Action> find_action(Key key, uint8_t mods, bool repeat) {
  for (const Binding& b : table())
    if (b.key == key && b.mods == mods && (!repeat || b.repeats)) return b.action;
  return std::nullopt;
}

std::string chord_text(const Binding& b) {
  if (b.key == Key::slash && b.mods == shift) return "?";
  std::string text;
  if (b.mods & Mods::ctrl) text += "Ctrl+";
  if (b.mods & Mods::alt) text += "Alt+";
  if (b.mods & Mods::shift) text += "Shift+";
  return text + key_name(b.key);
}

std::string shortcut_of(Action action) {
  for (const Binding& b : table())
    if (b.action == action) return chord_text(b);
  return {};
}

}  // namespace tumble
