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

/// Which replay to play with a scene (scene_replay).
struct ReplayRequest {
  std::string file;   ///< this file; empty: the replay of the scene's pack, if any
  bool none = false;  ///< play none, not even that of the pack
};

/// What to load and what to change about it.
struct SceneRequest {
  std::string scene;                   ///< file, or name of a scene that comes with Tumble
  std::vector<std::string> overrides;  ///< "path=value"
  std::optional<std::string> text;     ///< instead of the content of the scene's file
  std::string stepper;                 ///< replaces the scene's stepper; empty: the scene's
  int threads = 0;                     ///< 0: one per core
  LogSink log;
  ReplayRequest replay;
};

/// A scene and its world, at tick 0 with everything created.
struct LoadedScene {
  std::string name;            ///< of the file, without folder and ending
  std::filesystem::path file;  ///< where it was read from
  BuiltScene built;
};

/// Reads the description only, with overrides applied. Error codes: `invalid_argument` if only the
/// overrides are wrong, otherwise those of the scene or its files. All faults are in the message,
/// one per line, and in `faults` if given.
Result<SceneDescription> read_scene_request(const SceneRequest& request,
                                            std::vector<Fault>* faults = nullptr);
/// Reads the description and makes a world from it. For a mesh or robot file, the scene is the one
/// that read_scene_file() makes from it. Warnings of the scene go to the request's log. Error
/// `cancelled` if the thread's work was stopped (engine/core/stop.hpp).
Result<LoadedScene> load_scene_and_world(const SceneRequest& request,
                                         std::vector<Fault>* faults = nullptr);

/// Whether a text would open if it were the content of this file: it is read and built. All faults
/// are in the error.
Status check_scene_text(const std::string& text, const std::filesystem::path& file);

/// 2 if the command line is wrong (--set), otherwise 3.
ExitCode exit_code_of_scene(const Error& error);

}  // namespace tumble
