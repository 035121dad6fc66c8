#include "viewer/app/window/replay_controller.hpp"

#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/app/window/scene_loader.hpp"

#include <utility>

namespace tumble {

void ReplayController::open(const OpenedScene& scene, int threads) {
  undo_steps_ = scene.replay ? scene.replay->undo_steps() : 0;
  SceneRequest began;
  began.scene = scene.request.scene;
  began.overrides = scene.request.overrides;
  if (!scene.file.text.empty()) began.text = scene.file.text;
  began.threads = threads;
  saver_.open({std::move(began), chosen_numbers(scene)});
}

bool ReplayController::has_done_more(const ReplayPlayer& played) {
  const uint64_t undo_steps = played.undo_steps();
  return undo_steps != std::exchange(undo_steps_, undo_steps);
}

}  // namespace tumble
