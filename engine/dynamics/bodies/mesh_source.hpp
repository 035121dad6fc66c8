#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <cstdint>
#include <memory>

namespace tumble {

/// How a mesh collides; the numbers are those in snapshots.
enum class MeshMode : uint8_t {
  triangle_mesh,  ///< its triangles
  convex_hull,    ///< its convex hull
  decomposition,  ///< convex pieces that cover it
  field,          ///< its signed distance field
  fit,            ///< the primitive that fits it best
};
inline constexpr size_t mesh_mode_count = 5;

/// A way in which a mesh collides, with the parameters of its accuracy; zeros stand for defaults,
/// which depend on the mesh.
struct MeshRepresentation {
  MeshMode mode = MeshMode::triangle_mesh;
  double concavity = 0;  ///< decomposition: how far pieces may reach beyond the mesh [m]
  uint32_t pieces = 0;   ///< decomposition: greatest number of pieces
  double cell = 0;       ///< field: side of its cells [m]
};

/// The mesh that some shapes of a body represent, and how; lets them be replaced by another
/// representation.
struct MeshSource {
  std::shared_ptr<const TriangleMesh> mesh;
  Pose pose;  ///< the mesh's frame in the body frame
  MeshRepresentation how;
};

}  // namespace tumble
