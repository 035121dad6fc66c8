#pragma once
#include "engine/geometry/constructions/projections.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <span>
#include <vector>

namespace tumble {

/// One side of a triangle: 3 * triangle + k, from corner k to the next.
using TriangleSide = uint32_t;

/// A part of a solid while it is being cut: a closed triangle mesh, of each side of a triangle the
/// one that runs the same edge back, and of each triangle the plane that it lies in. Sides tell
/// edges apart where numbers of vertices cannot: two edges of a solid may run between the same two.
/// Triangles of one plane next to each other are one face, whatever rounding makes of their own
/// normals.
struct SolidPiece {
  TriangleMesh mesh;
  std::vector<uint32_t> plane;           ///< of each triangle, into the planes of the decomposition
  std::vector<TriangleSide> mates = {};  ///< of each side
};

inline uint32_t side_start(const TriangleMesh& mesh, TriangleSide s) {
  return mesh.triangles[s / 3][s % 3];
}
inline uint32_t side_end(const TriangleMesh& mesh, TriangleSide s) {
  return mesh.triangles[s / 3][(s % 3 + 1) % 3];
}

/// For each side the one that runs the same edge back; no_index where an edge has not just two.
std::vector<TriangleSide> side_mates(const TriangleMesh& mesh);

/// Divides triangles whose sides are mated into solids: one for each connected outer surface, with
/// the cavities in it. Corners that mates do not join become vertices of their own, so that edges
/// and vertices in which parts of a surface only touch come apart. Surfaces of no more volume than
/// a skin of thickness `tolerance` [m] are left out; their volume is added to `lost`.
std::vector<SolidPiece> separate_solids(const TriangleMesh& mesh, std::span<const uint32_t> planes,
                                        std::span<const TriangleSide> mates, double tolerance,
                                        double& lost);

/// Signed volume, summed about a corner of the mesh [m^3].
double enclosed_volume(const TriangleMesh& mesh);

}  // namespace tumble
