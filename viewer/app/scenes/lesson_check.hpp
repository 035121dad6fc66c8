#pragma once
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/scenes/scene_lesson.hpp"

#include <vector>

namespace tumble {

/// Runs the scene of a lesson, once for each of its choices, to the last moment at which the world
/// decides a question asked under them, and gives what it says to each, in the order of the pages.
/// Errors: those of loading, a step that fails. Empty where the scene teaches nothing.
Result<std::vector<SceneLesson::Check>> check_lesson(const SceneRequest& request);

}  // namespace tumble
