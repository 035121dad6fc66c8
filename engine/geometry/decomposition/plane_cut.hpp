#pragma once
#include "engine/geometry/decomposition/solid_piece.hpp"

#include <optional>

namespace tumble {

/// Parameters of a cut.
struct CutRequest {
  uint32_t plane = no_index;
  /// Only those connected parts of the section are cut that touch a face at a reflex edge which is
  /// within this distance of the plane [m]; elsewhere the solid stays whole. Negative: all parts.
  double touching = -1;
  double skin = 0;              ///< thinner parts are left out [m]
  LeftOut* left_out = nullptr;  ///< receives the sum of what is left out
};

/// The solids into which a piece is divided; one if the cut does not separate it. Faces that cross
/// the plane are divided along it, the section becomes a face of both sides, and faces that are not
/// convex are divided along the lines of their sides, whose planes are known: every new point is
/// then on three planes. The sides of a face are found by counting (each point of the line has as
/// many sides ending as starting), so that holes, several loops and touching parts are not special
/// cases. Empty only if the piece was not a closed surface.
std::optional<std::vector<SolidPiece>> cut_solid(ExactSpace& space, SolidPiece piece,
                                                 const CutRequest& request);

}  // namespace tumble
