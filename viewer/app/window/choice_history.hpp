#pragma once
#include "viewer/app/window/scene_loader.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Numbers of a scene that a person chose anew. Each choice opens the scene once more, and so does
/// taking it back: a wish is remembered where deeds remember a moment of the world (EditHistory).
class ChoiceHistory {
 public:
  enum class Way : uint8_t { anew, back, again };
  /// A choice, and which way it is gone.
  struct Step {
    Way way = Way::anew;
    std::string what;  ///< "Change balls"
    SceneWish before{}, after{};
    uint64_t tick_before = 0, tick_after = 0;  ///< at which each was left
    uint64_t tick() const { return way == Way::back ? tick_before : tick_after; }
    /// The present moment is the one at which it is gone.
    void leave_at(uint64_t now) { (way == Way::back ? tick_after : tick_before) = now; }
    const SceneWish& wish() const { return way == Way::back ? before : after; }
  };
  /// What takes the newest choice back; nothing when there is none.
  std::optional<Step> back() const;
  /// What chooses again what was taken back last.
  std::optional<Step> again() const;
  /// The scene was opened as the step wishes it.
  void gone(Step step);
  /// Somebody did something else: what was taken back is not to be done again.
  void forget_taken_back() { undone_.clear(); }
  /// The scene was saved to `scene`, whose file was `text` before: what meant the file as it was
  /// means that text from now on.
  void saved(const std::string& scene, const std::string& text);
  /// Another scene is shown, or this one has another text.
  void forget() { *this = ChoiceHistory{}; }
  /// Nothing can be taken back.
  bool empty() const { return done_.empty(); }

 private:
  std::vector<Step> done_, undone_;
};

}  // namespace tumble
