#pragma once
#include "engine/geometry/decomposition/solid_piece.hpp"

#include <optional>

namespace tumble {

/// Where a solid is cut.
struct CutRequest {
  Plane plane;
  /// What the cut face beneath the plane gets in SolidPiece::plane; the one over it, which looks
  /// the other way, gets one more.
  uint32_t plane_number = 0;
  double tolerance = 0;  ///< corners this near to the plane are on it [m]
  /// Edges (pairs of vertices of the piece) that lie on the plane, whatever rounding says. Empty:
  /// the whole solid is cut. Else only those connected parts of the section that one of them
  /// borders or crosses: elsewhere the solid stays whole.
  std::vector<std::array<uint32_t, 2>> edges;
};

/// What a cut leaves.
struct CutResult {
  std::vector<SolidPiece> pieces;
  double lost = 0;  ///< volume of skins that were left out [m^3]
};

/// Cuts a solid by a plane. Triangles that cross it are cut at their sides, the same point for both
/// triangles of a side; the section, which may have several parts with holes, is triangulated once
/// and given to both sides, so that pieces fit each other vertex by vertex and their volumes add
/// up. An edge on the plane whose two faces lie on one side splits the cut face there: so a reflex
/// edge on the plane is none afterwards. Nothing when rounding leaves no consistent section, or the
/// request meets none: another plane will do.
std::optional<CutResult> cut_solid(const SolidPiece& piece, const CutRequest& request);

}  // namespace tumble
