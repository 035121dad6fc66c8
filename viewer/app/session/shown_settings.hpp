#pragma once
#include "engine/world/settings.hpp"
#include "viewer/app/session/session.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// The settings of the world as panels show and change them. A change is shown at once; what the
/// world refuses is taken back, and said once.
class ShownSettings {
 public:
  /// Of a scene that has been opened.
  void open(const WorldSettings& of_scene);
  WorldSettings value() const;
  void change(Session& session, const WorldSettings& wanted);
  /// Takes over what the world has by now: it has gone back, say. `of_replay`: as a replay that is
  /// followed has made them, which is nobody's choice.
  void fetch(Session& session, bool of_replay);
  /// Restarts the world with the settings that hold now, or with those of the scene: history does
  /// not know which of them a person wants to keep. Names those in which the two differ. What only
  /// a replay has changed it will change again. `begin` does to the world at its first tick what
  /// belongs to its beginning besides.
  std::vector<std::string> restart(Session& session, bool as_scene,
                                   std::function<void(World&)> begin = {});
  const WorldSettings& of_scene() const { return of_scene_; }
  /// Why the newest change was refused, once.
  std::optional<Error> take_refusal();

 private:
  /// What jobs on the simulation thread write too.
  struct Shared;
  std::shared_ptr<Shared> shared_;
  WorldSettings of_scene_;
};

}  // namespace tumble
