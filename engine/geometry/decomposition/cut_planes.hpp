#pragma once
#include "engine/geometry/decomposition/notches.hpp"

namespace tumble {

/// A plane by three points that it goes through; `near` is the same, rounded.
struct CutPlane {
  Plane near;
  std::array<Vec3, 3> through;
};

/// Planes that resolve notches of a solid, the most promising first: those that leave the fewest
/// notches, each that lies on the plane being resolved and each that crosses it becoming two; among
/// equals those with the shortest section. Every plane goes through a notch: it extends one of its
/// faces, halves its angle, or goes through another notch as well, so that several are resolved at
/// once (Joe 1994 chooses one edge and weighs the angles that its planes make). What is within the
/// tolerance counts as on a plane [m].
std::vector<CutPlane> cut_planes(const ExactSpace& space, const SolidPiece& piece,
                                 std::span<const Notch> notches, std::span<const ReflexEdge> edges,
                                 double tolerance);

}  // namespace tumble
