#pragma once
#include "engine/scene/pack/pack.hpp"
#include "viewer/app/scenes/load_scene.hpp"

#include <string>
#include <vector>

namespace tumble {

/// A replay, and its name in messages.
struct NamedReplay {
  std::string bytes;
  std::string place;
};

/// The files of a scene for a pack, with a replay of it, as `tumble pack` and the window write
/// them. Null: that of the pack which the request names, if it has one and the request wants it.
/// The request must have no overrides, since a pack cannot hold them. The scene must open, and the
/// replay is played once: one that begins differently from the scene is rejected, and so is one
/// that ends in another state than recorded (`internal`). Cancelled if the thread's work is
/// stopped.
Result<std::vector<PackFile>> packed_scene(const SceneRequest& request, const NamedReplay* replay);

}  // namespace tumble
