#pragma once
#include "engine/collision/fitting/solid_error.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Must be changed whenever the same mesh may get another primitive than before: caches of fits are
/// keyed by it.
inline constexpr uint32_t fit_version = 1;

/// A primitive that approximates a mesh.
struct FittedPrimitive {
  ShapeDef shape;
  Pose pose;  ///< in the mesh's frame
  SolidError error;
  double volume = 0;       ///< [m^3]
  double mesh_volume = 0;  ///< [m^3]; 0 where the mesh has none
};

/// One fit of every kind of primitive, in the order of their errors: the larger of how far the
/// primitive extends beyond the mesh, and the mesh beyond the primitive. Each surface minimises the
/// mean square distance from points of the mesh's surface or of its hull's, starting from the
/// coordinate axes, the principal axes of the points, and those of a tight box. If two errors
/// differ by less than a hundredth the simpler kind comes first. Fits that extend beyond the mesh
/// by more than its diagonal are left out, except for the best one. Errors: the mesh is empty or
/// flat; cancelled.
Result<std::vector<FittedPrimitive>> fit_primitives(const Hierarchy& surface);

/// The first of fit_primitives().
Result<FittedPrimitive> fit_primitive(const Hierarchy& surface);

}  // namespace tumble
