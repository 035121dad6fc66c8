#pragma once
#include "engine/collision/shape.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <memory>
#include <span>

namespace tumble {

/// A shape with its pose in the frame of a mesh.
struct PlacedShape {
  std::shared_ptr<const Shape> shape;
  Pose pose;
};

/// Hausdorff distance of two solids, in both directions [m].
struct SolidError {
  double added = 0;    ///< how far the shapes extend beyond the mesh
  double missing = 0;  ///< how far the mesh extends beyond the shapes
  double larger() const { return added > missing ? added : missing; }
};

/// Error of a union of convex shapes against a mesh, sampled by `samples` random lines through each
/// shape and as many points of the mesh's surface, its corners included (at least those of the
/// whole size). Points inside the shapes count too, so that a filled cavity is seen. With `closed`
/// the mesh is a solid; otherwise it is a surface, and only the shapes' surfaces count. The samples
/// are low-discrepancy sequences (Halton 1960), the same on every machine.
SolidError solid_error(std::span<const PlacedShape> shapes, const Hierarchy& surface, bool closed,
                       size_t samples);

}  // namespace tumble
