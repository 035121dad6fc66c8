#pragma once
#include "engine/scene/reader.hpp"

#include <string>
#include <vector>

namespace tumble {

struct SceneCheck {
  std::vector<Fault> faults;
  std::vector<std::string> warnings;  ///< approximations and what could not be done as asked
  size_t bodies = 0;
  size_t particles = 0;
};

/// Reads, validates and builds a scene (by name or path), robot or mesh file, and reports
/// everything that is wrong.
SceneCheck check_scene(const std::string& name_or_path, const ReadOptions& options = {});

}  // namespace tumble
