#pragma once
#include "viewer/interact/input.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// All actions of keys. To add one: a line here, its name and its keys in key_map.cpp, its effect
/// in viewer/app/window/actions.cpp.
enum class Action : uint8_t {
  toggle_pause,
  step_forward,
  step_forward_ten,
  next_impact,
  step_back,
  step_back_ten,
  toggle_bookmark,
  next_bookmark,
  previous_bookmark,
  toggle_loop,
  restart,
  restart_as_scene,
  slower,
  faster,
  previous_scene,
  next_scene,
  pick_scene,
  new_scene,
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
  toggle_video,
  save_replay,
  save_packed_replay,
  handles_move,
  handles_turn,
  handles_scale,
  close,
  scene_camera,
  frame_all,
  add_camera_key,
  toggle_flight,
  toggle_free_flight,
  fly_forward,
  fly_back,
  fly_left,
  fly_right,
  fly_up,
  fly_down,
  toggle_panels,
  toggle_help,
  toggle_statistics,
  toggle_energy,
  toggle_build,
  toggle_measure,
  toggle_compare,
  next_comparison_view,
  toggle_events,
  toggle_bookmarks,
  toggle_ruler,
  toggle_assertions,
  toggle_lesson,
  toggle_parts,
  toggle_description,
  lesson_next,
  lesson_back,
  larger,
  smaller,
  next_theme,
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
  overlay_velocities,
  overlay_momenta,
  overlay_total_forces,
  overlay_none,
};
constexpr size_t action_count = size_t(Action::overlay_none) + 1;
/// The name in key files and `tumble keys`: "toggle_pause".
std::string_view action_name(Action action);
std::optional<Action> action_from_name(std::string_view name);

/// One entry of the table of bindings, from which key handling, the help panel and the shortcuts
/// shown on buttons are all derived.
struct Binding {
  Action action;
  Key key;
  uint8_t mods;  ///< exactly these modifiers are held
  std::string_view group;
  std::string_view doc;  ///< description of the action
  bool repeats = false;  ///< holding the key repeats the action
};
std::span<const Binding> all_bindings();
/// The default bindings.
std::span<const Binding> usual_bindings();

/// Replaces default bindings by those of a text such as `{"toggle_pause": "F2", "restart": ["R",
/// "Home"], "quit": ""}`; actions not named keep theirs. Invalid entries are left out and reported,
/// one line each, with path, cause and cure. Must be called before all_bindings() is read
/// elsewhere: the table is global.
std::vector<std::string> take_bindings(std::string_view json);
/// Restores the default bindings.
void take_usual_bindings();

/// Description of a pointer gesture for the help; PointerTool implements it.
struct PointerBinding {
  std::string_view gesture;
  std::string_view doc;
};
std::span<const PointerBinding> all_pointer_bindings();

/// Whether a key bound to this action is held, regardless of modifiers.
bool is_held(Action action, const HeldInput& held);
/// Whether holding this key moves a flying camera.
bool is_fly_key(Key key);

std::optional<Action> find_action(Key key, uint8_t mods, bool repeat = false);
/// "Ctrl+F12", "Shift+.", "?".
std::string chord_text(const Binding& binding);
/// The first chord of an action; "" if it has none.
std::string shortcut_of(Action action);

}  // namespace tumble
