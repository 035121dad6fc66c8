#pragma once
#include "engine/geometry/wrap/enclosed_mesh.hpp"

#include <limits>

namespace tumble {

/// By how much a wrap may be changed.
struct WrapError {
  double tolerance = 0;  ///< [m]
  double cell = 0;       ///< side of a square whose area counts as one [m]
  /// No edge becomes longer, and none that is longer than half of it is contracted [m].
  double longest_edge = std::numeric_limits<double>::infinity();
};

/// Contracts edges of a wrap, those first that change it least, while it stays a closed 2-manifold
/// without self-intersections about all of the mesh (Garland and Heckbert, "Surface simplification
/// using quadric error metrics", 1997; the constraint that keeps the mesh inside is that of
/// progressive hulls, Sander et al., "Silhouette clipping", 2000, but tested against the mesh and
/// not against planes).
///
/// The error of a vertex is the sum over all triangles that it stands for of their squared distance
/// from it, each times its area over that of a square of side `cell` [m]; it stays below
/// `tolerance` [m] squared. So where as much as a cell's area of the wrap was, the new one is no
/// farther from its plane than the tolerance, and smaller parts weigh less.
///
/// An edge whose ends lie in the same planes is contracted along them, which changes nothing but
/// the triangles. Any other is contracted only if the triangles about it keep the clearance of
/// `mesh`, meet no other triangle and pass over no witness. Stopped, it leaves the wrap in between.
void simplify_wrap(TriangleMesh& wrap, const EnclosedMesh& mesh, const WrapError& error);

/// The same for short edges, in the order in which they stand: a quick way to triangles of about
/// one size.
void even_out_wrap(TriangleMesh& wrap, const EnclosedMesh& mesh, const WrapError& error);

}  // namespace tumble
