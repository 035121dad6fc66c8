#pragma once
#include "engine/geometry/decomposition/notches.hpp"

namespace tumble {

/// Planes that resolve notches of a solid, the most promising first: those that leave the fewest
/// notches, each that lies on the plane being resolved and each that crosses it becoming two; among
/// equals those with the shortest section. Every plane goes through a notch: it extends one of its
/// faces, halves its angle, or goes through another notch as well, so that several are resolved at
/// once (Joe 1994 chooses one edge and weighs the angles that its planes make).
std::vector<Plane> cut_planes(const SolidPiece& piece, std::span<const Notch> notches,
                              std::span<const Plane> planes, double tolerance);

/// The notches that lie on a plane, as pairs of vertices.
std::vector<std::array<uint32_t, 2>> notches_on(const Plane& plane, const SolidPiece& piece,
                                                std::span<const Notch> notches, double tolerance);

}  // namespace tumble
