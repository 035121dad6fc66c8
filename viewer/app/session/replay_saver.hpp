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

/// What was done in the window up to the moment that is shown, saved as a replay: alone, as `tumble
/// simulate --replay` writes it, or in a pack with its scene, as `tumble pack --replay` does.
class ReplaySaver {
 public:
  ReplaySaver() = default;
  ~ReplaySaver() { stop_.request(); }
  ReplaySaver(const ReplaySaver&) = delete;
  ReplaySaver& operator=(const ReplaySaver&) = delete;

  /// Where the world that is shown began.
  struct Beginning {
    SceneRequest scene;
    std::vector<SceneEdit> numbers;  ///< parameters with other values than the file has
  };
  /// Another world is shown from now on; what is under way goes on.
  void open(Beginning beginning) { beginning_ = std::move(beginning); }

  struct Wish {
    std::filesystem::path folder;
    std::string name;     ///< of the scene, for that of the file
    bool packed = false;  ///< with the scene
    bool beside = true;   ///< on a thread of its own
  };
  struct Saved {
    std::filesystem::path file;
    uint64_t ticks = 0;
    double seconds = 0;
    std::vector<std::string> needs;  ///< values that the scene has to be given to begin so
  };
  void save(Session& session, Wish wish);
  /// One is under way.
  bool busy() const { return said_.valid() || job_.valid(); }
  /// What became of it, once.
  std::optional<Result<Saved>> take();
  /// Writes what needs no trial; a pack that is still being tried out is given up.
  void finish(Session& session);

 private:
  /// The world's word for what was done in it.
  struct Said {
    Bytes replay;
    uint64_t ticks = 0;
    double seconds = 0;
  };
  static Result<Saved> write(const Wish& wish, const Beginning& beginning, const Said& said);
  void begin_job();

  StopFlag stop_;
  Beginning beginning_, of_job_;
  Wish wish_;
  std::future<Said> said_;
  std::future<Result<Saved>> job_;
};

}  // namespace tumble
