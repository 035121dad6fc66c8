#pragma once
#include "engine/core/result.hpp"
#include "engine/scene/saving/json_text_edit.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// What was taken out of a scene's file because something else is gone.
struct TakenAlong {
  std::string list;  ///< "joints", "cameras", "lesson"
  std::string name;  ///< of what stands there; "" where nothing has names
  std::string rest;  ///< what of it, where it stays: "follow", "events[1]"

  /// "the spring rope", "follow of the camera main".
  std::string words() const;
};

/// Takes out of the text whatever names something that is not there any more: a body, a joint, a
/// particle system, an emitter or another part of this name in this list, and what needs that in
/// turn. A joint, a force, a sensor or an emitter goes as a whole, and so does a force or sensor of
/// which everything that it acts on is gone (without names it would act on all); from lists,
/// cameras and lessons goes only what names it, and nothing goes that can do without.
std::vector<TakenAlong> drop_dependents(JsonTextEdit& text, std::string_view list,
                                        const std::string& name);

/// The text of a scene in which a thing of a list is called `to`, wherever it is named: copies and
/// expressions included. Error: it is not in the file, or `to` is taken or no name.
Result<std::string> renamed(const std::string& scene, const std::string& list,
                            const std::string& name, const std::string& to);

/// What holds this copy of a body, by a description that makes several (`count`) and cannot leave
/// one out: "joints.link"; "": nothing does.
std::string held_by_count(const JsonTextEdit& text, const std::string& body);

}  // namespace tumble
