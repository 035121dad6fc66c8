#pragma once
#include "engine/core/log.hpp"
#include "engine/core/result.hpp"
#include "engine/scene/build.hpp"
#include "viewer/app/exit_codes.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Which replay is played with a scene (scene_replay).
struct ReplayWish {
  std::string file;   ///< this one; empty: that of the scene's pack, if any
  bool none = false;  ///< not that one either
};

/// What to load and what to change about it.
struct SceneRequest {
  std::string scene;                   ///< file, or name of a scene that comes with Tumble
  std::vector<std::string> overrides;  ///< "path=value"
  std::optional<std::string> text;     ///< in place of what the scene's file holds
  std::string stepper;                 ///< instead of the scene's; empty: the scene's
  int threads = 0;                     ///< 0: one per core
  LogSink log;
  ReplayWish replay;
};

/// A scene and its world, at tick 0 with everything created.
struct LoadedScene {
  std::string name;            ///< of the file, without folder and ending
  std::filesystem::path file;  ///< where it was read from
  BuiltScene built;
};

/// The description alone, with overrides applied. Error codes: `invalid_argument` when only the
/// overrides are wrong, else those of the scene or its files. All faults are in the message, one a
/// line, and in `faults` when given.
Result<SceneDescription> read_scene_request(const SceneRequest& request,
                                            std::vector<Fault>* faults = nullptr);
/// The description and a world made from it. A mesh or robot file in place of a scene gives what
/// read_scene_file() makes of it. Warnings of the scene go to the request's log. Error `cancelled`
/// where the work of the thread was stopped (engine/core/stop.hpp).
Result<LoadedScene> load_scene_and_world(const SceneRequest& request,
                                         std::vector<Fault>* faults = nullptr);

/// Whether a text would open as this file: read and built as it would be. All faults are in the
/// error.
Status check_scene_text(const std::string& text, const std::filesystem::path& file);

/// 2 when the command line is at fault (--set), else 3.
ExitCode exit_code_of_scene(const Error& error);

}  // namespace tumble
