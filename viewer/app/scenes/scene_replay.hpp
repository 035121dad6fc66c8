#pragma once
#include "engine/world/replay.hpp"
#include "viewer/app/scenes/load_scene.hpp"

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace tumble {

class Options;

/// Plays the commands of a replay into the world of its scene.
class ReplayPlayer {
 public:
  using Course = Replay::Course;

  ReplayPlayer(Replay replay, std::string source)
      : replay_(std::move(replay)), source_(std::move(source)) {}

  /// To be called at the first tick, after each further one and after each other change, on the
  /// thread that steps the world: executes the replay's commands for that tick. `anew`: the world
  /// has gone to another moment. Error: the world rejected a command.
  Status follow(World& world, bool anew = false);
  /// Progress of the replay; callable from any thread.
  Course course() const { return course_; }
  /// Number of commands executed; callable from any thread.
  uint64_t undo_steps() const { return undo_steps_; }
  /// The progress, if it has changed since the last call; for one thread only.
  std::optional<Course> take_news();
  /// An error if the replay ended in a state other than the recorded one.
  Status verdict() const;
  uint64_t last_tick() const { return replay_.last_tick(); }
  uint64_t last_hash() const { return replay_.last_hash(); }
  /// The path of its file, or of its pack.
  const std::string& source() const { return source_; }

 private:
  Replay replay_;
  std::string source_;
  std::atomic<Course> course_ = Course::goes_on;
  std::atomic<uint64_t> undo_steps_ = 0;
  Course told_ = Course::goes_on;
  /// Tick and number of commands at the last check whether the world is still the replay's, so that
  /// the expensive comparison of all shapes is not repeated for every query.
  uint64_t seen_tick_ = UINT64_MAX;
  size_t seen_done_ = 0;
};

/// Declares --play and --no-replay.
void declare_replay(Options& options, ReplayRequest& wanted);

/// Path of the replay in the scene's pack; empty if there is none.
std::filesystem::path replay_in_pack(const SceneRequest& request, const LoadedScene& scene);
/// The replay to play with a loaded scene: the file that the request names, otherwise the replay of
/// its pack; null if there is none, or none is wanted. The commands of the first tick have been
/// executed. Errors: the replay cannot be read, or begins differently from the scene.
Result<std::shared_ptr<ReplayPlayer>> replay_of(const SceneRequest& request,
                                                const LoadedScene& scene);
/// A line of text about the replay that replay_of() found.
std::string replay_words(const SceneRequest& request, const LoadedScene& scene,
                         const ReplayPlayer& player);

}  // namespace tumble
