#pragma once
#include "viewer/interact/input.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

/// Everything a key can ask for. Adding one: a line here, one in all_bindings(), one in
/// app/actions.cpp.
enum class Action : uint8_t {
  toggle_pause,
  step_forward,
  step_forward_ten,
  next_impact,
  step_back,
  step_back_ten,
  restart,
  restart_as_scene,
  slower,
  faster,
  previous_scene,
  next_scene,
  pick_scene,
  save_scene,
  undo,
  redo,
  duplicate,
  copy,
  paste,
  select_all,
  delete_body,
  save_snapshot,
  restore_snapshot,
  screenshot,
  screenshot_plain,
  toggle_sequence,
  handles_move,
  handles_turn,
  handles_scale,
  close,
  scene_camera,
  frame_all,
  toggle_panels,
  toggle_help,
  toggle_statistics,
  toggle_energy,
  toggle_build,
  toggle_measure,
  toggle_compare,
  toggle_events,
  toggle_assertions,
  full_screen,
  quit,
  toggle_microscope,
  microscope_next,
  microscope_previous,
  microscope_first,
  overlay_contacts,
  overlay_normals,
  overlay_forces,
  overlay_friction,
  overlay_bounds,
  overlay_hierarchy,
  overlay_hierarchy_back,
  overlay_grid,
  overlay_joints,
  overlay_collision_shape,
  overlay_none,
};

/// One line of the binding table: the one source of what keys do, of the help panel and of the
/// shortcuts printed on buttons.
struct Binding {
  Action action;
  Key key;
  uint8_t mods;  ///< exactly these are held
  std::string_view group;
  std::string_view doc;  ///< what it does, for people
  bool repeats = false;  ///< holding the key goes on
};
std::span<const Binding> all_bindings();

/// What the pointer does; for the help only, the behaviour is PointerTool's.
struct PointerBinding {
  std::string_view gesture;
  std::string_view doc;
};
std::span<const PointerBinding> all_pointer_bindings();

std::optional<Action> find_action(Key key, uint8_t mods, bool repeat = false);
/// "Ctrl+F12", "Shift+.", "?".
std::string chord_text(const Binding& binding);
/// The first chord of an action, or "" when it has none.
std::string shortcut_of(Action action);

}  // namespace tumble
