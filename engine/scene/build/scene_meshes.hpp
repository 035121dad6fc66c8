#pragma once
#include "engine/scene/build/piece_cache.hpp"
#include "engine/scene/description.hpp"
#include "engine/scene/visitors/object_validator.hpp"

#include <map>
#include <memory>
#include <span>

namespace tumble {

/// The mesh files of a scene, each read once.
class SceneMeshes {
 public:
  /// Reads every mesh of the scene; what fails goes to `sink`, what was changed to `warnings`.
  SceneMeshes(const SceneDescription& scene, const FaultSink& sink,
              std::vector<std::string>& warnings);
  /// Null for one that could not be read, about which a fault has been given.
  std::shared_ptr<const TriangleMesh> find(const std::string& name) const;
  /// A convex piece of a mesh that collides in pieces, and its share of the mesh's volume over its
  /// own.
  struct Piece {
    std::shared_ptr<const TriangleMesh> corners;  ///< vertices only
    double filled = 1;
  };
  /// The pieces of a mesh of mode decomposition; empty for another.
  std::span<const Piece> pieces(const std::string& name) const;

  /// The side of the cells of a mesh of mode field [m]; 0 for another.
  double cell(const std::string& name) const;

 private:
  void note_field(const std::string& name, const MeshDescription& m,
                  std::vector<std::string>& warnings);
  void decompose(const std::string& name, const MeshDescription& m, const FaultSink& sink,
                 std::vector<std::string>& warnings);

  std::map<std::string, std::vector<Piece>, std::less<>> pieces_;
  std::map<std::string, double, std::less<>> cells_;
  std::map<std::string, std::shared_ptr<const TriangleMesh>, std::less<>> meshes_;
};

}  // namespace tumble
