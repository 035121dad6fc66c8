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
/// For each side the one that runs the same edge back; no_index where an edge has not just two.
std::vector<TriangleSide> side_mates(const TriangleMesh& mesh);

/// A reflex edge of a mesh: its corners, and the planes of its two faces.
struct ReflexEdge {
  std::array<uint32_t, 2> corners;
  std::array<uint32_t, 2> planes;
};

/// A part of a solid while it is being cut: convex faces, each with its plane and its sides, and
/// of each side the one that runs the same edge back. Nothing needs the sides of a face in their
/// order, nor points at one place to be one.
struct SolidPiece {
  struct Side {
    uint32_t start, end;           ///< points; the face is on the left
    uint32_t mate;                 ///< the side of the neighbour
    uint32_t face;                 ///< that it is of
    std::array<uint32_t, 2> line;  ///< planes that meet in the line that it lies on
    uint32_t edge = no_index;      ///< the reflex edge that it is a part of
  };
  struct Face {
    uint32_t plane = no_index;
    bool turned = false;  ///< the plane's normal points into the solid
    bool cavity = false;  ///< of the mesh's surface around a hollow
    std::vector<uint32_t> sides;
  };
  std::vector<Side> sides;
  std::vector<Face> faces;
};

/// What was too thin to be a piece.
struct LeftOut {
  size_t count = 0;
  double volume = 0;  ///< of all of it, without signs [m^3]
  void add(double of_one) {
    ++count;
    volume += std::fabs(of_one);
  }
};

/// The solids of a mesh, and its reflex edges. A solid is a connected outer surface with the
/// cavities in it; those of no more volume than a skin of thickness `skin` [m] are left out. Every
/// side of the mesh has a mate, and its vertices are the first points of the space. Error: a side
/// without length, or two triangles without area next to each other.
struct Solids {
  std::vector<SolidPiece> pieces;
  std::vector<ReflexEdge> edges;
  LeftOut left_out;
};
Result<Solids> make_solids(const TriangleMesh& mesh, ExactSpace& space, double skin);

/// What is connected in `all`, as above; a surface of which all is of a cavity is one. Faces
/// without sides are left out.
std::vector<SolidPiece> separate_solids(const ExactSpace& space, const SolidPiece& all, double skin,
                                        LeftOut* left_out = nullptr);

/// Faces as fans of triangles, rounded.
TriangleMesh to_mesh(const ExactSpace& space, const SolidPiece& piece);

/// Signed volume, summed about a corner of the mesh [m^3].
double enclosed_volume(const TriangleMesh& mesh);

}  // namespace tumble
