#pragma once
#include "viewer/app/window/scene_loader.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Undo history of changes to the numbers of a scene. Each change opens the scene anew, and so does
/// undoing it; so this history stores requests (OpenRequest), where EditHistory stores moments of
/// the world.
class ChoiceHistory {
 public:
  enum class Way : uint8_t { anew, back, again };
  /// A change, and the direction in which it is done.
  struct Step {
    Way way = Way::anew;
    std::string what;  ///< "Change balls"
    OpenRequest before{}, after{};
    uint64_t tick_before = 0, tick_after = 0;  ///< present tick when each was left
    uint64_t tick() const { return way == Way::back ? tick_before : tick_after; }
    /// Records the present tick at which the step is taken.
    void leave_at(uint64_t now) { (way == Way::back ? tick_after : tick_before) = now; }
    const OpenRequest& request() const { return way == Way::back ? before : after; }
  };
  /// The step that undoes the newest change; empty if there is none.
  std::optional<Step> back() const;
  /// The step that redoes the change undone last.
  std::optional<Step> again() const;
  /// To be called when the scene was opened as the step asks.
  void gone(Step step);
  /// Another action was taken: nothing can be redone any more.
  void forget_taken_back() { undone_.clear(); }
  /// The scene was saved to `scene`, whose file was `text` before: what meant the file as it was
  /// means that text from now on.
  void saved(const std::string& scene, const std::string& text);
  /// Another scene is shown, or this one has another text.
  void forget() { *this = ChoiceHistory{}; }
  /// Whether there is nothing to undo.
  bool empty() const { return done_.empty(); }

 private:
  std::vector<Step> done_, undone_;
};

}  // namespace tumble
