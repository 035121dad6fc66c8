#include "viewer/app/scenes/packed_scene.hpp"

#include "engine/core/stop.hpp"
#include "engine/world/replay.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <optional>
#include <span>
#include <utility>

namespace tumble {
namespace {

/// Plays a replay in this world, which is at its first tick; an error if it does not fit or ends
/// differently.
Status holds_in(World& world, const NamedReplay& named) {
  const auto replay = Replay::read(std::as_bytes(std::span(named.bytes)));
  if (!replay) return replay.error();
  if (!replay->begins_as(world))
    return Error{ErrorCode::invalid_argument, "the replay begins otherwise than the scene",
                 named.place, "record it from this scene, with the values that its file has"};
  while (true) {
    const auto course = replay->follow(world);
    if (!course) return course.error();
    if (*course == Replay::Course::ended_same) return {};
    if (*course != Replay::Course::goes_on)
      return Error{ErrorCode::internal,
                   "the replay ends in another state than it was recorded with", named.place,
                   "record it anew with this version of Tumble"};
    if (const auto report = world.step(); !report) return report.error();
    if (stop_requested()) return stopped_error();
  }
}

/// The replay of the pack that the request names, unless it is not wanted or the scene's text is
/// another; nothing if there is none.
Result<std::optional<NamedReplay>> own_replay(const SceneRequest& request,
                                              const LoadedScene& scene) {
  const auto file = request.replay.none || request.text ? std::filesystem::path()
                                                        : replay_in_pack(request, scene);
  if (file.empty()) return std::optional<NamedReplay>();
  auto bytes = read_file(file);
  if (!bytes) return bytes.error();
  return std::optional(NamedReplay{*std::move(bytes), request.scene});
}

}  // namespace

Result<std::vector<PackFile>> packed_scene(const SceneRequest& request, const NamedReplay* replay) {
  auto scene = load_scene_and_world(request);
  if (!scene) return scene.error();
  const auto own =
      replay ? Result<std::optional<NamedReplay>>(std::nullopt) : own_replay(request, *scene);
  if (!own) return own.error();
  if (*own) replay = &**own;
  if (replay)
    if (const Status holds = holds_in(*scene->built.world, *replay); !holds) {
      Error error = holds.error();
      error.place = replay->place;
      if (*own) error.cure += (error.cure.empty() ? "" : ", or ") + std::string("give --no-replay");
      return error;
    }
  auto files = pack_files(request.scene, request.text);
  if (files && replay) files->push_back({pack_replay_name, replay->bytes});
  return files;
}

}  // namespace tumble
