#pragma once
#include "engine/scene/outline/outline.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tumble {

/// A change of what the scene's file says, at one place of it.
struct EditDescription {
  enum class How : uint8_t {
    set,      ///< `value` is JSON
    add,      ///< a key, or one more item or name, with a value to begin with
    remove,   ///< with what cannot do without it
    rename,   ///< to `value`, wherever it is named
    move,     ///< an item, `value` places down ("-1": up)
    declare,  ///< the number becomes one that the scene declares
  };
  ScenePath path;
  How how = How::set;
  std::string value = {};
};

/// What the scene's file says, as far as a panel shows it.
struct DescriptionView {
  std::shared_ptr<const Outline> outline;  ///< of the place that is shown
  /// Changes that do not make a scene yet, and what is wrong with them; the world is as before.
  std::vector<std::string> draft, faults;
  bool opening = false;  ///< the scene with the changes is being opened
};

/// "Change radius of bodies.ball.shape", as undo names it.
std::string undo_step_of(const EditDescription& edit);

}  // namespace tumble
