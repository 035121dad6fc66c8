#pragma once
#include "engine/scene/description.hpp"
#include "engine/scene/visitors/object_validator.hpp"

#include <map>
#include <memory>

namespace tumble {

/// The mesh files of a scene, each read once.
class SceneMeshes {
 public:
  /// Reads every mesh of the scene; what fails goes to `sink`, what was changed to `warnings`.
  SceneMeshes(const SceneDescription& scene, const FaultSink& sink,
              std::vector<std::string>& warnings);
  /// Null for one that could not be read, about which a fault has been given.
  std::shared_ptr<const TriangleMesh> find(const std::string& name) const;

 private:
  std::map<std::string, std::shared_ptr<const TriangleMesh>, std::less<>> meshes_;
};

}  // namespace tumble
