#pragma once
#include "engine/geometry/mesh_topology.hpp"
#include "engine/geometry/solid/solid_report.hpp"

namespace tumble {

/// How the closed shells of a mesh lie within each other.
struct ShellNesting {
  /// Of each shell: how often the others wind around it, summed.
  std::vector<int> winding;
  /// Of each shell: how many of the others wind around it at all.
  std::vector<uint32_t> depth;
  /// Touching pairs of two shells that lie partly within each other: they cross along edges.
  std::vector<TriangleIds> crossings;
};

/// Volume, closedness and size of each connected part of `mesh`; `part` from connected_parts().
/// Shells whose edges do not all have two opposite triangles are open.
std::vector<SolidShell> measure_shells(const TriangleMesh& mesh, const MeshTopology& topology,
                                       const std::vector<uint32_t>& part, size_t count);

/// Exact winding numbers at corners of the triangles (point_in_object's rays), of all closed shells
/// against each other. Where all corners of a shell lie upon others, midpoints of its sides and
/// triangles decide, when they are off the others by 1e-9 of the mesh's size. `crossed`: shells
/// known to cross another, which are left out, having no one answer. `touching`: pairs of triangles
/// of two shells that do not cross properly.
ShellNesting nest_shells(const TriangleMesh& mesh, const std::vector<uint32_t>& part,
                         const std::vector<SolidShell>& shells, const std::vector<uint8_t>& crossed,
                         const std::vector<TriangleIds>& touching);

}  // namespace tumble
