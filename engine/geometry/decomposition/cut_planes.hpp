#pragma once
#include "engine/geometry/decomposition/notches.hpp"

namespace tumble {

/// A plane given by three points on it; `near` is the same, rounded.
struct CutPlane {
  Plane near;
  std::array<Vec3, 3> through;
};

/// Candidate planes that resolve notches of a solid, the best first: those that leave the fewest
/// notches (a notch on the plane is resolved, one that crosses it becomes two), and among equals
/// those with the shortest section. Every plane contains a notch: it extends one of its faces,
/// halves its angle, or contains another notch as well, so that several are resolved at once (Joe
/// 1994 chooses one edge and weighs the angles of its planes). Points within the tolerance count as
/// on a plane [m].
std::vector<CutPlane> cut_planes(const ExactSpace& space, const SolidPiece& piece,
                                 std::span<const Notch> notches, std::span<const ReflexEdge> edges,
                                 double tolerance);

}  // namespace tumble
