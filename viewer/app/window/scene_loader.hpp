#pragma once
#include "engine/core/stop.hpp"
#include "engine/world/world_def.hpp"
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/scenes/scene_look.hpp"
#include "viewer/ui/ui_state.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

class LiveParts;
class ReplayPlayer;
class SceneAssertions;
class SceneLesson;

/// What is to be opened: a scene by name, or a scene or mesh file by path.
struct SceneWish {
  std::string scene;
  std::vector<std::string> overrides;  ///< "path=value", as --set has them
  std::optional<std::string> text;     ///< in place of what the file holds: unsaved work
  std::filesystem::path called{};      ///< a new scene that is gone on with; empty: by a free name
};
/// What assertions of a scene can speak of, to be plotted by name.
struct NamedQuantities {
  std::shared_ptr<const std::vector<std::string>> names;
  std::function<Quantity(const std::string& name)> find;
  /// These, and those of what is there in a frame besides.
  std::function<std::shared_ptr<const NamedQuantities>(const Frame&)> with;
};
/// A scene ready to be shown.
struct OpenedScene {
  std::unique_ptr<World> world;  ///< at its first tick
  std::string name, title, doc;
  SceneFile file;                          ///< for saving
  SceneWish wish;                          ///< that it was opened by
  std::vector<SceneParameter> parameters;  ///< numbers that it declares
  uint64_t world_hash = 0;                 ///< of all in the file that acts on bodies; 0: not known
  ViewPoint view;                          ///< where a person looks at it first
  std::function<void(RenderScene&)> look;  ///< sun, sky, ground; may be empty
  std::optional<MicroscopeSetup> microscope;
  Overlays overlays;            ///< that it wants to be on
  double trail = 0;             ///< length of the paths behind moving bodies [s]
  std::vector<BodyNote> notes;  ///< labels and hierarchies that it wants shown
  std::vector<std::string> warnings;
  std::shared_ptr<SceneAssertions> assertions;        ///< that it makes; null: none
  std::shared_ptr<ReplayPlayer> replay;               ///< that is played into it; null: none
  std::string replay_words;                           ///< about it
  std::shared_ptr<SceneLesson> lesson;                ///< that it teaches; null: none
  std::shared_ptr<const NamedQuantities> quantities;  ///< null: none
  /// Emitters, sensors, forces and particles, and what they are in the world; null: none.
  std::shared_ptr<const SceneDescription> parts;
  std::shared_ptr<LiveParts> live_parts;
};
/// Parameters that were given other values than the scene's file has.
std::vector<SceneEdit> chosen_numbers(const OpenedScene& scene);
/// Opens a scene. All faults are lines of the error. Must be callable from any thread.
using SceneOpener = std::function<Result<OpenedScene>(const SceneWish&)>;

/// Opens scenes on a thread of its own, one at a time. Of what is asked for meanwhile only the
/// newest is opened: the one under way is given up, as it is by destruction.
class SceneLoader {
 public:
  SceneLoader() = default;
  ~SceneLoader() { stop_.request(); }
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;

  struct Loaded {
    SceneWish asked;  ///< as it was given to start()
    Result<OpenedScene> scene;
  };

  void start(SceneOpener open, SceneWish wish);
  /// A scene is under way, or waits to be taken.
  bool busy() const { return under_way_.valid(); }
  /// What is being opened, "" when nothing is.
  const std::string& asked() const { return asked_.scene; }
  /// Since the newest start() [s].
  double seconds() const;
  /// The newest scene or its faults, once.
  std::optional<Loaded> take();

 private:
  void begin();

  using Clock = std::chrono::steady_clock;

  SceneOpener open_;
  SceneWish asked_;
  bool outdated_ = false;  ///< another scene was asked for since the one under way
  Clock::time_point since_;
  StopFlag stop_;  ///< of the one under way
  std::future<Result<OpenedScene>> under_way_;
};

}  // namespace tumble
