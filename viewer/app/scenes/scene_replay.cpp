#include "viewer/app/scenes/scene_replay.hpp"

#include "engine/scene/pack/pack.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/options.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <filesystem>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace tumble {

std::filesystem::path replay_in_pack(const SceneRequest& request, const LoadedScene& scene) {
  const std::filesystem::path file = scene.file.parent_path() / pack_replay_name;
  std::error_code none;
  return is_pack_file(request.scene) && std::filesystem::exists(file, none)
             ? file
             : std::filesystem::path();
}

Status ReplayPlayer::follow(World& world, bool anew) {
  if (world.tick() > replay_.last_tick()) return {};  // the replay has ended
  const auto done = [&] { return world.replay_log().entries().size(); };
  if (!anew && seen_tick_ == world.tick() && seen_done_ == done()) return {};
  const size_t before = done();
  const auto course = replay_.follow(world);
  if (!course) return course.error();
  if (done() != before) ++undo_steps_;
  seen_tick_ = world.tick();
  seen_done_ = done();
  course_ = *course;
  return {};
}

std::optional<ReplayPlayer::Course> ReplayPlayer::take_news() {
  const Course now = course();
  return now == std::exchange(told_, now) ? std::nullopt : std::optional(now);
}

Status ReplayPlayer::verdict() const {
  if (course() != Course::ended_otherwise) return {};
  return Error{ErrorCode::internal, "the replay ends in another state than it was recorded with",
               source_, "record it anew with this version of Tumble"};
}

void declare_replay(Options& options, ReplayRequest& wanted) {
  const Option file = options.value(
      "--play", wanted.file,
      "a replay of this scene, as `tumble simulate --replay` writes them, is played; a pack's own "
      "is played without being asked for, unless another is given here");
  file.not_empty();
  options.flag("--no-replay", wanted.none, "the replay of a pack is not played").excludes(file);
}

Result<std::shared_ptr<ReplayPlayer>> replay_of(const SceneRequest& request,
                                                const LoadedScene& scene) {
  if (request.replay.none) return std::shared_ptr<ReplayPlayer>();
  const bool given = !request.replay.file.empty();
  const std::filesystem::path file =
      given ? std::filesystem::path(request.replay.file) : replay_in_pack(request, scene);
  if (file.empty()) return std::shared_ptr<ReplayPlayer>();
  const std::string named = given ? request.replay.file : request.scene;
  const auto at_place = [&](Error error) {
    error.place = named;
    return error;
  };
  const auto bytes = read_file(file);
  if (!bytes) return at_place(bytes.error());
  auto replay = Replay::read(std::as_bytes(std::span(*bytes)));
  if (!replay) return at_place(replay.error());
  if (!replay->begins_as(*scene.built.world)) {
    const bool changed = !request.overrides.empty() || !request.stepper.empty() || request.text;
    return Error{ErrorCode::invalid_argument, "the replay begins otherwise than the scene", named,
                 std::string(changed ? "leave the scene's values as they are"
                                     : "record it from this scene") +
                     (given ? ", or leave out --play" : ", or give --no-replay")};
  }
  auto player = std::make_shared<ReplayPlayer>(*std::move(replay), named);
  if (Status begun = player->follow(*scene.built.world); !begun) return at_place(begun.error());
  return player;
}

std::string replay_words(const SceneRequest& request, const LoadedScene& scene,
                         const ReplayPlayer& player) {
  const double seconds = double(player.last_tick()) * scene.built.world->settings().tick.tick();
  const bool given = !request.replay.file.empty();
  return fmt::format(
      "{}{} is played, {} ticks, {:.4g} s{}", given ? "the replay " : "the replay in ",
      player.source(), player.last_tick(), seconds,
      given && !replay_in_pack(request, scene).empty() ? "; the one in the pack is not" : "");
}

}  // namespace tumble
