#pragma once
#include "engine/collision/fitting/solid_error.hpp"
#include "engine/scene/build/mesh_parts.hpp"

namespace tumble {

/// One way in which a mesh may collide, measured.
struct RepresentationFacts {
  MeshMode mode = MeshMode::triangle_mesh;
  std::string refusal;  ///< why there is none; "": there is one
  MeshParts parts;
  std::string words;  ///< what it is
  size_t bytes = 0;   ///< of its geometry: triangles and tree, corners and faces, field, numbers
  /// How far it reaches outside the mesh, and how far the mesh stands out of it, as sampled.
  SolidError error;
  double volume_ratio = 0;  ///< of its shapes, summed, over the mesh's; 0 where that has none
  double query_ns = 0;      ///< contacts with a small ball near the surface, in the mean [ns]
  double seconds = 0;       ///< to make it, or to fetch it from a cache [s]
};

/// All five of a mesh, side by side, in the order of MeshMode. `base` has the numbers of pieces and
/// field where others than the usual are wanted. The costs are of this machine and this moment.
std::vector<RepresentationFacts> measure_representations(
    const std::shared_ptr<const TriangleMesh>& mesh, const MeshRepresentation& base = {});

/// As a table: a heading and a line each.
std::string representations_text(const std::vector<RepresentationFacts>& all);

}  // namespace tumble
