#pragma once
#include "engine/collision/fitting/solid_error.hpp"
#include "engine/scene/build/mesh_parts.hpp"

namespace tumble {

/// A collision mode of a mesh, with measurements.
struct RepresentationFacts {
  MeshMode mode = MeshMode::triangle_mesh;
  std::string refusal;  ///< why it is not possible; "": it is
  MeshParts parts;
  std::string words;  ///< a description
  size_t bytes = 0;   ///< of its geometry: triangles and tree, corners and faces, field, numbers
  /// How far it extends beyond the mesh, and the mesh beyond it, as sampled.
  SolidError error;
  /// Sum of the volumes of its shapes over that of the mesh; 0 if the mesh has none.
  double volume_ratio = 0;
  double query_ns = 0;  ///< mean time for contacts with a small ball near the surface [ns]
  double seconds = 0;   ///< time to compute it, or to read it from a cache [s]
};

/// All modes of a mesh, in the order of MeshMode. `base` has the parameters of pieces and field, if
/// they differ from the defaults. The times depend on the machine and its load.
std::vector<RepresentationFacts> measure_representations(
    const std::shared_ptr<const TriangleMesh>& mesh, const MeshRepresentation& base = {});

/// As a table: a heading, and a line for each.
std::string representations_text(const std::vector<RepresentationFacts>& all);

}  // namespace tumble
