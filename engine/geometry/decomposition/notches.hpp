#pragma once
#include "engine/geometry/decomposition/solid_piece.hpp"

namespace tumble {

/// A side of a piece on a reflex edge of the mesh, around which the solid fills more than half of
/// the space. Cuts create none, so that all come from the mesh.
struct Notch {
  uint32_t edge;                   ///< of the mesh
  std::array<uint32_t, 2> points;  ///< ends of the side
};

/// The notches of a piece that are deeper than a tolerance [m]: each face has a corner that is
/// above the other face's plane by more than that. With 0: all of them, decided exactly.
std::vector<Notch> find_notches(const ExactSpace& space, const SolidPiece& piece, double tolerance);

}  // namespace tumble
