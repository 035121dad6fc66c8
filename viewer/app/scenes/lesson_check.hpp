#pragma once
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/scenes/scene_lesson.hpp"

#include <vector>

namespace tumble {

/// Runs the scene of a lesson, once for each of its choices of settings, up to the last time at
/// which the world decides a question asked under that choice, and returns the measured answers in
/// the order of the pages. Errors: those of loading, a step that fails. Empty if the scene has no
/// lesson.
Result<std::vector<SceneLesson::Check>> check_lesson(const SceneRequest& request);

}  // namespace tumble
