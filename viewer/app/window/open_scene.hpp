#pragma once
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/window/scene_loader.hpp"

namespace tumble {

/// What a new scene begins as: a floor, and nothing on it. It is saved to a name of its own.
std::string new_scene_file();
/// A scene ready for the window: the world at its first tick with all that is shown around it.
Result<OpenedScene> open_scene(const SceneRequest& request, double aspect);

}  // namespace tumble
