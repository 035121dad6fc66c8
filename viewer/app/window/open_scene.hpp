#pragma once
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/window/scene_loader.hpp"

namespace tumble {

/// Text of a new scene: a floor with nothing on it.
std::string new_scene_file();
/// A scene ready for the window: its world at the first tick and everything shown around it.
Result<OpenedScene> open_scene(const SceneRequest& request, double aspect);

}  // namespace tumble
