#pragma once
#include "engine/core/stop.hpp"
#include "engine/scene/saving/scene_edits.hpp"
#include "viewer/app/scenes/packed_scene.hpp"
#include "viewer/app/session/session.hpp"

#include <cstdint>
#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Saves the user's commands up to the moment shown as a replay: alone, as `tumble simulate
/// --replay` does, or in a pack with its scene, as `tumble pack --replay` does.
class ReplaySaver {
 public:
  ReplaySaver() = default;
  ~ReplaySaver() { stop_.request(); }
  ReplaySaver(const ReplaySaver&) = delete;
  ReplaySaver& operator=(const ReplaySaver&) = delete;

  /// The start of the run whose commands are saved.
  struct Beginning {
    SceneRequest scene;
    std::vector<SceneEdit> numbers;  ///< parameters whose values differ from the file's
  };
  /// Another world is shown from now on; a save under way continues.
  void open(Beginning beginning) { beginning_ = std::move(beginning); }

  struct Request {
    std::filesystem::path folder;
    std::string name;     ///< of the scene, from which the file's name is made
    bool packed = false;  ///< in a pack with the scene
    bool beside = true;   ///< on another thread
  };
  struct Saved {
    std::filesystem::path file;
    uint64_t ticks = 0;
    double seconds = 0;
    /// Parameter values ("path=value") that the scene must be given for this replay.
    std::vector<std::string> needs;
  };
  void save(Session& session, Request request);
  /// Whether a save is under way.
  bool busy() const { return said_.valid() || job_.valid(); }
  /// The outcome of a save, once.
  std::optional<Result<Saved>> take();
  /// Completes saves that need no test run; a pack that is still being tested is dropped.
  void finish(Session& session);

 private:
  /// The world's answer: the log of its commands and its hash.
  struct Said {
    Bytes replay;
    uint64_t ticks = 0;
    double seconds = 0;
  };
  static Result<Saved> write(const Request& request, const Beginning& beginning, const Said& said);
  void begin_job();

  StopFlag stop_;
  Beginning beginning_, of_job_;
  Request request_;
  std::future<Said> said_;
  std::future<Result<Saved>> job_;
};

}  // namespace tumble
