#pragma once
#include "engine/scene/build/mesh_parts.hpp"
#include "engine/scene/description.hpp"
#include "engine/scene/visitors/object_validator.hpp"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace tumble {

/// The mesh files of a scene, each read once, and their collision shapes.
class SceneMeshes {
 public:
  /// Reads every mesh of the scene; what fails goes to `sink`, what was changed to `warnings`.
  SceneMeshes(const SceneDescription& scene, const FaultSink& sink,
              std::vector<std::string>& warnings);
  /// Null for a mesh that could not be read, for which there is a fault.
  std::shared_ptr<const TriangleMesh> find(const std::string& name) const;
  /// The collision shapes of a mesh, unless a shape chooses another mode; null as for find().
  const MeshParts* parts(const std::string& name) const;
  /// The mesh, or the wrap of it that takes its place where one is asked for: made once for all
  /// shapes that ask for the same, which `warnings` are told of then; null after a fault at `path`,
  /// or without a mesh.
  std::shared_ptr<const TriangleMesh> wrapped(const std::string& name,
                                              const std::optional<WrapDescription>& wrap,
                                              const std::string& path, const FaultSink& sink,
                                              std::vector<std::string>& warnings) const;
  /// True once for each mesh and sentence about it, however many shapes it would be said of.
  bool says_first(const TriangleMesh& mesh, const std::string& note) const;

 private:
  /// A name, and the gap, offset and cell that a wrap is asked for with.
  using WrapKey = std::tuple<std::string, double, double, double>;

  std::map<std::string, std::shared_ptr<const TriangleMesh>, std::less<>> meshes_;
  std::map<std::string, MeshParts, std::less<>> parts_;
  mutable std::map<WrapKey, std::shared_ptr<const TriangleMesh>> wraps_;  ///< that shapes ask for
  mutable std::set<std::pair<const TriangleMesh*, std::string>> said_;
};

/// What a description asks for, of a mesh with these bounds.
MeshRepresentation representation_of(const MeshModeDescription& d, const Aabb& bounds);

}  // namespace tumble
