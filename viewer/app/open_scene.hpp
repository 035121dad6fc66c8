#pragma once
#include "viewer/app/load_scene.hpp"
#include "viewer/app/scene_loader.hpp"

namespace tumble {

/// A scene ready for the window: the world at its first tick with all that is shown around it.
Result<OpenedScene> open_scene(const SceneRequest& request, double aspect);

}  // namespace tumble
