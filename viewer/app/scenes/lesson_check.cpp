#include "viewer/app/scenes/lesson_check.hpp"

#include "engine/world/world.hpp"

#include <algorithm>

namespace tumble {
namespace {

using Checks = std::vector<SceneLesson::Check>;

/// Answers the questions asked under these choices of settings.
Status run_part(SceneRequest request, const std::vector<std::string>& choose, Checks& out) {
  request.overrides.insert(request.overrides.end(), choose.begin(), choose.end());
  const auto scene = load_scene_and_world(request);
  if (!scene) return scene.error();
  World& world = *scene->built.world;
  const auto lesson = SceneLesson::make(scene->built, 1);
  double last = 0;
  for (const SceneLesson::Check& c : lesson->checks())
    if (c.choose == choose) last = std::max(last, c.at);
  lesson->see(*world.frame());
  while (world.time() < last - 0.5 * world.settings().tick.tick()) {
    if (const auto report = world.step(); !report) return report.error();
    lesson->see(*world.frame());
  }
  for (SceneLesson::Check& c : lesson->checks())
    if (c.choose == choose) out.push_back(std::move(c));
  return {};
}

}  // namespace

Result<Checks> check_lesson(const SceneRequest& request) {
  const auto scene = load_scene_and_world(request);
  if (!scene) return scene.error();
  Checks out;
  const auto lesson = SceneLesson::make(scene->built, 1);
  if (!lesson) return out;
  std::vector<std::vector<std::string>> choices;
  for (const SceneLesson::Check& c : lesson->checks())
    if (std::ranges::find(choices, c.choose) == choices.end()) choices.push_back(c.choose);
  for (const auto& choose : choices)
    if (const Status ran = run_part(request, choose, out); !ran) return ran.error();
  std::ranges::stable_sort(out, {}, &SceneLesson::Check::step);
  return out;
}

}  // namespace tumble
