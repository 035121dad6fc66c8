#pragma once
#include "engine/geometry/wrap/enclosed_mesh.hpp"

namespace tumble {

class Crew;

struct WrapFit {
  double offset = 0;  ///< where the wrap is to stand off its mesh [m]
  double stand = 0;   ///< where it stands about now [m]
  double cell = 0;    ///< length of its edges, about [m]
  Crew* crew = nullptr;
};

/// Draws a wrap that stands off its mesh back to it.
///
/// Every triangle has a plane that it should lie in: that at the offset before the point of the
/// mesh nearest to its middle, across the way from there; where the wrap closes a gap, its own
/// plane, moved inwards by as much as the wrap's other parts. A vertex goes where the planes of its
/// triangles meet (least squares, as the vertices of dual contouring do: Ju et al., "Dual
/// contouring of Hermite data", 2002), so that edges and corners become sharp, inner ones too.
///
/// All vertices go at once, each triangle is tested, and the ways of those that do not pass are
/// halved, until all pass: they keep the clearance of `mesh`, meet no others, and leave no witness
/// outside. The wrap, which fulfils that before, therefore does so afterwards and at any stop. The
/// same bits for any crew.
///
/// Ways that all go at once are in each other's way in valleys, where some vertices then stay.
/// Those go alone at the end, straight or over the middle of their neighbours, while any gets
/// nearer.
void fit_wrap(TriangleMesh& wrap, const EnclosedMesh& mesh, const WrapFit& fit);

}  // namespace tumble
