#pragma once
#include "engine/world/replay.hpp"
#include "viewer/app/scenes/load_scene.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>

namespace tumble {

class Options;

/// Plays a replay into the world of its scene.
class ReplayPlayer {
 public:
  using Course = Replay::Course;

  ReplayPlayer(Replay replay, std::string source)
      : replay_(std::move(replay)), source_(std::move(source)) {}

  /// At the first tick, after each further one and after each change, by whoever steps the world:
  /// does what was done at it. `anew`: the world has gone to another moment. Error: the world
  /// refused that.
  Status follow(World& world, bool anew = false);
  /// How far it has come; from any thread.
  Course course() const { return course_; }
  /// So often has it done something to the world; from any thread.
  uint64_t deeds() const { return deeds_; }
  /// How far it has come, where that has changed since it was asked last; for one thread.
  std::optional<Course> take_news();
  /// Where the replay ended otherwise than it was recorded.
  Status verdict() const;
  uint64_t last_tick() const { return replay_.last_tick(); }
  uint64_t last_hash() const { return replay_.last_hash(); }
  /// Its file, or that of its pack.
  const std::string& source() const { return source_; }

 private:
  Replay replay_;
  std::string source_;
  std::atomic<Course> course_ = Course::goes_on;
  std::atomic<uint64_t> deeds_ = 0;
  Course told_ = Course::goes_on;
  /// When the world was looked at last, and how much had been done to it by then: to look at that
  /// once more, shape by shape, is not for every question that somebody has.
  uint64_t seen_tick_ = UINT64_MAX;
  size_t seen_done_ = 0;
};

/// Declares --play and --no-replay.
void declare_replay(Options& options, ReplayWish& wish);

/// What is played with a scene that has been loaded: the file of the request's wish, else the
/// replay of its pack; null where there is neither, or none is wished for. What was done at the
/// first tick is done. Errors: the replay cannot be read, or begins otherwise than the scene.
Result<std::shared_ptr<ReplayPlayer>> replay_of(const SceneRequest& request,
                                                const LoadedScene& scene);
/// A line about what replay_of() found.
std::string replay_words(const SceneRequest& request, const LoadedScene& scene,
                         const ReplayPlayer& player);

}  // namespace tumble
