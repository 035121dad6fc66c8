#pragma once
#include "engine/geometry/decomposition/solid_piece.hpp"

namespace tumble {

/// A reflex edge: the solid takes up more than half of the space around it (Joe's and Chazelle's
/// notch).
struct Notch {
  std::array<uint32_t, 2> vertices;
  std::array<uint32_t, 2> planes;  ///< of its faces
};

/// The notches of a solid between faces that bend by more than makes `tolerance` [m] over the size
/// of the solid, in the order of its triangles.
std::vector<Notch> find_notches(const SolidPiece& piece, std::span<const Plane> planes,
                                double tolerance);

/// The faces of a mesh: planes, and which of them each triangle is in. A face grows from its
/// largest triangle over neighbours whose corners are within `tolerance` [m] of its plane.
struct FlatFaces {
  std::vector<Plane> planes;
  std::vector<uint32_t> of_triangle;
};
FlatFaces find_faces(const TriangleMesh& mesh, std::span<const TriangleSide> mates,
                     double tolerance);

}  // namespace tumble
