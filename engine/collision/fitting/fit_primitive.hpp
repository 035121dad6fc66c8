#pragma once
#include "engine/collision/fitting/solid_error.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Changes whenever the same mesh may get another primitive than before: what is kept of fits is
/// kept by it.
inline constexpr uint32_t fit_version = 1;

/// A primitive that stands for a mesh.
struct FittedPrimitive {
  ShapeDef shape;
  Pose pose;  ///< in the mesh's frame
  SolidError error;
  double volume = 0;       ///< [m^3]
  double mesh_volume = 0;  ///< [m^3]; 0 where the mesh has none
};

/// One fit of every kind of primitive, the least error first: the larger of how far it reaches
/// outside the mesh and how far the mesh stands out of it. Each surface runs nearest, in the mean
/// square, to points of the mesh's surface or of its hull's, from axes of the coordinates, of the
/// spread of the points, and of a tight box. Of fits that err alike to a hundredth the simpler one
/// comes first. Left out are those, but for the best, that reach farther outside the mesh than its
/// diagonal. Errors: the mesh is empty or flat; cancelled.
Result<std::vector<FittedPrimitive>> fit_primitives(const Hierarchy& surface);

/// The best of them.
Result<FittedPrimitive> fit_primitive(const Hierarchy& surface);

}  // namespace tumble
