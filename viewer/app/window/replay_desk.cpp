#include "viewer/app/window/replay_desk.hpp"

#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/app/window/scene_loader.hpp"

#include <utility>

namespace tumble {

void ReplayDesk::open(const OpenedScene& scene, int threads) {
  deeds_ = scene.replay ? scene.replay->deeds() : 0;
  SceneRequest began;
  began.scene = scene.wish.scene;
  began.overrides = scene.wish.overrides;
  if (!scene.file.text.empty()) began.text = scene.file.text;
  began.threads = threads;
  saver_.open({std::move(began), chosen_numbers(scene)});
}

bool ReplayDesk::has_done_more(const ReplayPlayer& played) {
  const uint64_t deeds = played.deeds();
  return deeds != std::exchange(deeds_, deeds);
}

}  // namespace tumble
