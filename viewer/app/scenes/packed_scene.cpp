#include "viewer/app/scenes/packed_scene.hpp"

#include "engine/core/stop.hpp"
#include "engine/world/replay.hpp"
#include "engine/world/world.hpp"

#include <span>

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

}  // namespace

Result<std::vector<PackFile>> packed_scene(const SceneRequest& request, const NamedReplay* replay) {
  auto scene = load_scene_and_world(request);
  if (!scene) return scene.error();
  if (replay)
    if (const Status holds = holds_in(*scene->built.world, *replay); !holds) {
      Error error = holds.error();
      error.place = replay->place;
      return error;
    }
  auto files = pack_files(request.scene, request.text);
  if (files && replay) files->push_back({pack_replay_name, replay->bytes});
  return files;
}

}  // namespace tumble
