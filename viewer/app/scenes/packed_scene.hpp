#pragma once
#include "engine/scene/pack/pack.hpp"
#include "viewer/app/scenes/load_scene.hpp"

#include <string>
#include <vector>

namespace tumble {

/// A replay, and what it is called in messages.
struct NamedReplay {
  std::string bytes;
  std::string place;
};

/// The files of a scene, ready to be packed, with a replay of it; null: with none. What `tumble
/// pack` writes, and the window. The request has no overrides: a pack has no room for them. What
/// cannot be opened is not worth being sent, and a replay that begins otherwise than the scene, or
/// ends in another state than it was recorded with, would only mislead: it is played once, and
/// refused (`internal`: for its end). Gives up where the work of the thread is stopped.
Result<std::vector<PackFile>> packed_scene(const SceneRequest& request, const NamedReplay* replay);

}  // namespace tumble
