#pragma once
#include "engine/scene/description.hpp"
#include "engine/scene/fault.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

struct ReadOptions {
  /// "path=value" each, applied to the file before it is read: `bodies.ball.mass=3`,
  /// `bodies.brick[3].mass=3`, `parameters.n=20`, `settings.gravity=[0,-1.6,0]`.
  std::vector<std::string> overrides;
};

/// A description and everything that is wrong with it; to be used only when ok().
struct SceneRead {
  SceneDescription scene;
  std::vector<Fault> faults;  ///< in the order of the file
  bool ok() const { return faults.empty(); }
};

/// Reads and validates a scene. `file` is named in faults, and its folder is where assets are
/// looked for first. Never fails otherwise than by faults, all of them at once.
SceneRead read_scene(std::string_view text, const std::string& file,
                     const ReadOptions& options = {});
SceneRead load_scene(const std::filesystem::path& file, const ReadOptions& options = {});

/// Ranges, references and contradictions of a description, however it was made. (read_scene
/// includes it.)
std::vector<Fault> validate(const SceneDescription& scene);

/// A fault at a JSON path of a description, with file and line when it came from a file.
Fault fault_at(const SceneDescription& scene, std::string path, std::string message);

}  // namespace tumble
