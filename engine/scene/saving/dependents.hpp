#pragma once
#include "engine/core/result.hpp"
#include "engine/scene/saving/json_text_edit.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Something that was removed from a scene's file because it depended on something removed.
struct TakenAlong {
  std::string list;  ///< "joints", "cameras", "lesson"
  std::string name;  ///< name of the object; "" if it has none
  std::string rest;  ///< the part of it that was removed, if the rest stays: "follow", "events[1]"

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

/// The text of a scene in which a thing of a list is called `to`, wherever it is named: copies and
/// expressions included. What a robot is made of keeps its names. Error: it is not in the file, or
/// `to` is taken or no name.
Result<std::string> renamed(const std::string& scene, const std::string& list,
                            const std::string& name, const std::string& to);

/// What refers to this copy of a body by a description that makes several (`count`) and cannot
/// leave one out: "joints.link"; "": nothing.
std::string held_by_count(const JsonTextEdit& text, const std::string& body);

}  // namespace tumble
