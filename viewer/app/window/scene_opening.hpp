#pragma once
#include "viewer/app/window/choice_history.hpp"
#include "viewer/app/window/scene_loader.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace tumble {

/// The scene that is being opened beside the one that is shown, and why.
class SceneOpening {
 public:
  struct Cause {
    std::optional<ChoiceHistory::Step> choice{};  ///< of a person; nothing: to be looked at
    std::vector<ChoiceHistory::Step> deeds{};     ///< done to the scene before that
    bool reloads = false;     ///< it is the scene that is shown, written anew by somebody else
    uint64_t tick = 0;        ///< the moment to be shown, where it is still the same scene
    bool deeds_lost = false;  ///< some of them are no choices any more
  };
  struct Opened {
    SceneWish asked;
    Result<OpenedScene> scene;
    Cause cause;
  };

  /// In the place of what is being opened.
  void start(SceneOpener open, SceneWish wish, Cause cause) {
    cause_ = std::move(cause);
    loader_.start(std::move(open), std::move(wish));
  }
  /// What has been opened, once.
  std::optional<Opened> take() {
    auto loaded = loader_.take();
    if (!loaded) return std::nullopt;
    return Opened{std::move(loaded->asked), std::move(loaded->scene), std::exchange(cause_, {})};
  }
  bool busy() const { return loader_.busy(); }
  /// "": nothing.
  const std::string& asked() const { return loader_.asked(); }
  double seconds() const { return loader_.seconds(); }

 private:
  SceneLoader loader_;
  Cause cause_;
};

}  // namespace tumble
