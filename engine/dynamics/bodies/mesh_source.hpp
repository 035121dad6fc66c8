#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <cstdint>
#include <memory>

namespace tumble {

/// How a mesh collides; by number as snapshots hold it.
enum class MeshMode : uint8_t {
  triangle_mesh,  ///< as it is
  convex_hull,    ///< as its convex hull
  decomposition,  ///< as convex pieces that cover it
  field,          ///< by its signed distance field
  fit,            ///< as the primitive that fits it best
};
inline constexpr size_t mesh_mode_count = 5;

/// One way in which a mesh may collide, with what decides how near to it that is; zeros are the
/// usual values, which depend on the mesh.
struct MeshRepresentation {
  MeshMode mode = MeshMode::triangle_mesh;
  double concavity = 0;  ///< decomposition: how far pieces may reach outside [m]
  uint32_t pieces = 0;   ///< decomposition: no more than these
  double cell = 0;       ///< field: side of its cells [m]
};

/// A mesh for which some shapes of a body stand, and how they do: what else may take their place.
struct MeshSource {
  std::shared_ptr<const TriangleMesh> mesh;
  Pose pose;  ///< the mesh's frame in the body frame
  MeshRepresentation how;
};

}  // namespace tumble
