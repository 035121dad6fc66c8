#pragma once
#include "engine/scene/saving/json_text_edit.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Something that was removed from a scene's file because it depended on something removed.
struct TakenAlong {
  std::string list;  ///< "joints", "cameras", "lesson"
  std::string name;  ///< of what stands there; "" where nothing has names
  std::string rest;  ///< what of it, where it stays: "follow", "events[1]"

  /// "the spring rope", "follow of the camera main".
  std::string words() const;
};

/// Removes from the text everything that refers to a removed thing: a body, a joint, a particle
/// system, an emitter or another part of this name in this list, and recursively what depends on
/// that. A joint, force, sensor or emitter is removed as a whole, also a force or sensor whose
/// targets are all removed (without names it would act on everything); in lists, cameras and
/// lessons only the reference is removed. Optional references are not a reason to remove anything
/// else.
std::vector<TakenAlong> drop_dependents(JsonTextEdit& text, std::string_view list,
                                        const std::string& name);

/// The description that creates this copy of a body by `count`, and so cannot omit it:
/// "joints.link"; "" if there is none.
std::string held_by_count(const JsonTextEdit& text, const std::string& body);

}  // namespace tumble
