#pragma once
#include "engine/geometry/decomposition/solid_piece.hpp"

#include <optional>

namespace tumble {

/// Where a solid is cut.
struct CutRequest {
  uint32_t plane = no_index;
  /// Only those connected parts of the section are cut that a face at a reflex edge borders, the
  /// edge being on the plane within this [m]; elsewhere the solid stays whole. Less than 0: all.
  double touching = -1;
  double skin = 0;              ///< what is thinner is left out [m]
  LeftOut* left_out = nullptr;  ///< that it is added to
};

/// The solids that a piece falls into; one when the cut goes round something. Faces that cross the
/// plane are divided along it, the section becomes a face of both sides, and faces that are not
/// convex are divided along the lines of their sides, whose planes are known: so every new point
/// is one of three planes. Which sides a face gets is found by counting (what runs into a point on
/// the line must leave it), so holes, several loops and parts that touch are no cases of their own.
/// Nothing only where the piece was no closed surface.
std::optional<std::vector<SolidPiece>> cut_solid(ExactSpace& space, SolidPiece piece,
                                                 const CutRequest& request);

}  // namespace tumble
