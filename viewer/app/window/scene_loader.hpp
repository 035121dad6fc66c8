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

/// What to open: a scene by name, or a scene or mesh file by path.
struct OpenRequest {
  std::string scene;
  std::vector<std::string> overrides;  ///< "path=value", as for --set
  std::optional<std::string> text;     ///< instead of the file's content: unsaved work
  /// Path under which a new scene was kept; empty: an unused one is chosen.
  std::filesystem::path called{};
};
/// The quantities that assertions of a scene can use, for plotting by name.
struct NamedQuantities {
  std::shared_ptr<const std::vector<std::string>> names;
  std::function<Quantity(const std::string& name)> find;
  /// Returns these quantities together with those of things added since, from a frame.
  std::function<std::shared_ptr<const NamedQuantities>(const Frame&)> with;
};
/// A scene ready to be shown.
struct OpenedScene {
  std::unique_ptr<World> world;  ///< at its first tick
  std::string name, title, doc;
  SceneFile file;                          ///< for saving
  OpenRequest request;                     ///< that it was opened by
  std::vector<SceneParameter> parameters;  ///< numbers that it declares
  uint64_t world_hash = 0;                 ///< of all in the file that acts on bodies; 0: not known
  ViewPoint view;                          ///< where a person looks at it first
  std::function<void(RenderScene&)> look;  ///< sun, sky, ground; may be empty
  std::optional<MicroscopeSetup> microscope;
  Overlays overlays;            ///< overlays that the scene wants
  double trail = 0;             ///< length of the paths behind moving bodies [s]
  std::vector<BodyNote> notes;  ///< labels and hierarchies that the scene wants shown
  std::vector<std::string> warnings;
  std::shared_ptr<SceneAssertions> assertions;        ///< the scene's assertions; null: none
  std::shared_ptr<ReplayPlayer> replay;               ///< replay to play into the world; null: none
  std::string replay_words;                           ///< text about the replay
  std::shared_ptr<SceneLesson> lesson;                ///< the scene's lesson; null: none
  std::shared_ptr<const NamedQuantities> quantities;  ///< null: none
  /// Emitters, sensors, forces and particles as described, and their ids in the world; null: none.
  std::shared_ptr<const SceneDescription> parts;
  std::shared_ptr<LiveParts> live_parts;
};
/// Parameters whose values differ from those of the scene's file.
std::vector<SceneEdit> chosen_numbers(const OpenedScene& scene);
/// Opens a scene. The error lists all faults, one per line. Must be callable from any thread.
using SceneOpener = std::function<Result<OpenedScene>(const OpenRequest&)>;

/// Opens scenes one at a time on a thread of its own. A new request cancels the one under way, and
/// so does destruction; of several requests, only the newest is carried out.
class SceneLoader {
 public:
  SceneLoader() = default;
  ~SceneLoader() { stop_.request(); }
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;

  struct Loaded {
    OpenRequest asked;  ///< as it was given to start()
    Result<OpenedScene> scene;
  };

  void start(SceneOpener open, OpenRequest wanted);
  /// Whether a scene is being opened, or waits to be taken.
  bool busy() const { return under_way_.valid(); }
  /// The scene being opened; "": none.
  const std::string& asked() const { return asked_.scene; }
  /// Time since the newest start() [s].
  double seconds() const;
  /// The newest scene or its faults, once.
  std::optional<Loaded> take();

 private:
  void begin();

  using Clock = std::chrono::steady_clock;

  SceneOpener open_;
  OpenRequest asked_;
  bool outdated_ = false;  ///< another scene was requested since the one under way
  Clock::time_point since_;
  StopFlag stop_;  ///< of the one under way
  std::future<Result<OpenedScene>> under_way_;
};

}  // namespace tumble
