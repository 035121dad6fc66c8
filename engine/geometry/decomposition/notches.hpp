#pragma once
#include "engine/geometry/decomposition/solid_piece.hpp"

namespace tumble {

/// A side of a piece that lies on a reflex edge of the mesh: the solid fills more than half of the
/// space around it. Cuts make none, so there are no others.
struct Notch {
  uint32_t edge;                   ///< of the mesh
  std::array<uint32_t, 2> points;  ///< ends of the side
};

/// The notches of a piece that are deeper than a tolerance [m]: of either face some corner is over
/// the other's plane by that much. Of 0: all of them, in exact numbers.
std::vector<Notch> find_notches(const ExactSpace& space, const SolidPiece& piece, double tolerance);

}  // namespace tumble
