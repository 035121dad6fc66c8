#pragma once
#include "engine/world/settings.hpp"
#include "viewer/app/session/session.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// The world's settings as panels show and change them. A change is shown at once; if the world
/// rejects it, it is undone and reported once.
class ShownSettings {
 public:
  /// Takes the settings of a scene that was opened.
  void open(const WorldSettings& of_scene);
  WorldSettings value() const;
  void change(Session& session, const WorldSettings& wanted);
  /// Takes over the world's present settings, e.g. after going back in time. `of_replay`: a replay
  /// made them, so they do not count as the user's choice.
  void fetch(Session& session, bool of_replay);
  /// Restarts the world with the present settings, or (`as_scene`) with those of the scene. Returns
  /// the names of settings in which the two differ. Settings changed only by a replay are reset,
  /// since the replay will change them again. `begin` is applied to the world at its first tick.
  std::vector<std::string> restart(Session& session, bool as_scene,
                                   std::function<void(World&)> begin = {});
  const WorldSettings& of_scene() const { return of_scene_; }
  /// Why the newest change was rejected, once.
  std::optional<Error> take_refusal();

 private:
  /// State that jobs on the simulation thread also write.
  struct Shared;
  std::shared_ptr<Shared> shared_;
  WorldSettings of_scene_;
};

}  // namespace tumble
