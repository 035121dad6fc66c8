#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/decomposition/exact_space.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <cmath>
#include <span>
#include <vector>

namespace tumble {

/// One side of a triangle: 3 * triangle + k, from corner k to the next.
using TriangleSide = uint32_t;

inline uint32_t side_start(const TriangleMesh& mesh, TriangleSide s) {
  return mesh.triangles[s / 3][s % 3];
}
inline uint32_t side_end(const TriangleMesh& mesh, TriangleSide s) {
  return mesh.triangles[s / 3][(s % 3 + 1) % 3];
}
/// For each side the opposite side of the same edge; no_index if an edge does not have exactly two.
std::vector<TriangleSide> side_mates(const TriangleMesh& mesh);

/// A reflex edge of a mesh: its corners, and the planes of its two faces.
struct ReflexEdge {
  std::array<uint32_t, 2> corners;
  std::array<uint32_t, 2> planes;
};

/// A part of a solid during cutting: convex faces, each with its plane and its sides, and for each
/// side its mate in the neighbouring face. The sides of a face need not be in order, and points at
/// the same place need not be the same.
struct SolidPiece {
  struct Side {
    uint32_t start, end;           ///< points; the face is on the left
    uint32_t mate;                 ///< the opposite side, in the neighbouring face
    uint32_t face;                 ///< the face that it belongs to
    std::array<uint32_t, 2> line;  ///< planes whose intersection is its line
    uint32_t edge = no_index;      ///< the reflex edge that it is a part of
  };
  struct Face {
    uint32_t plane = no_index;
    bool turned = false;  ///< the plane's normal points into the solid
    bool cavity = false;  ///< of a surface around a cavity of the mesh
    std::vector<uint32_t> sides;
  };
  std::vector<Side> sides;
  std::vector<Face> faces;
};

/// Parts that were too thin for a piece.
struct LeftOut {
  size_t count = 0;
  double volume = 0;  ///< sum of absolute volumes [m^3]
  void add(double of_one) {
    ++count;
    volume += std::fabs(of_one);
  }
};

/// The solids of a mesh, and its reflex edges. A solid is a connected outer surface with the
/// cavities in it; those with no more volume than a layer of thickness `skin` [m] are left out.
/// Every side of the mesh has a mate, and its vertices are the first points of the space. Error: a
/// side without length, or two adjacent triangles without area.
struct Solids {
  std::vector<SolidPiece> pieces;
  std::vector<ReflexEdge> edges;
  LeftOut left_out;
};
Result<Solids> make_solids(const TriangleMesh& mesh, ExactSpace& space, double skin);

/// The connected parts of `all`, as above; a surface all of whose faces are of a cavity is a
/// cavity. Faces without sides are left out.
std::vector<SolidPiece> separate_solids(const ExactSpace& space, const SolidPiece& all, double skin,
                                        LeftOut* left_out = nullptr);

/// Triangulates faces as fans, with rounded points.
TriangleMesh to_mesh(const ExactSpace& space, const SolidPiece& piece);

/// Signed volume, computed relative to a corner of the mesh [m^3].
double enclosed_volume(const TriangleMesh& mesh);

}  // namespace tumble
