#pragma once
#include "viewer/app/window/choice_history.hpp"
#include "viewer/app/window/scene_loader.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace tumble {

/// The scene that is being opened in the background, and the reason.
class SceneOpening {
 public:
  struct Cause {
    /// The user's choice that caused it; none: the scene was chosen for viewing.
    std::optional<ChoiceHistory::Step> choice{};
    /// The user's earlier changes to the scene, to be kept in its history.
    std::vector<ChoiceHistory::Step> undo_steps{};
    bool reloads = false;  ///< it is the scene shown, whose file another program has written
    uint64_t tick = 0;     ///< the tick to show, if it is the same scene
    bool undo_steps_lost = false;  ///< some changes could not be turned into choices
  };
  struct Opened {
    OpenRequest asked;
    Result<OpenedScene> scene;
    Cause cause;
  };

  /// Starts opening a scene; one under way is dropped.
  void start(SceneOpener open, OpenRequest wanted, Cause cause) {
    cause_ = std::move(cause);
    loader_.start(std::move(open), std::move(wanted));
  }
  /// The opened scene, once.
  std::optional<Opened> take() {
    auto loaded = loader_.take();
    if (!loaded) return std::nullopt;
    return Opened{std::move(loaded->asked), std::move(loaded->scene), std::exchange(cause_, {})};
  }
  bool busy() const { return loader_.busy(); }
  /// Name of the scene being opened; "": none.
  const std::string& asked() const { return loader_.asked(); }
  double seconds() const { return loader_.seconds(); }

 private:
  SceneLoader loader_;
  Cause cause_;
};

}  // namespace tumble
