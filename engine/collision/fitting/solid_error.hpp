#pragma once
#include "engine/collision/shape.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"

#include <memory>
#include <span>

namespace tumble {

/// A shape at its place in the frame of a mesh.
struct PlacedShape {
  std::shared_ptr<const Shape> shape;
  Pose pose;
};

/// Hausdorff distance of two solids, both ways [m].
struct SolidError {
  double added = 0;    ///< how far the shapes reach outside the mesh
  double missing = 0;  ///< how far the mesh stands out of the shapes
  double larger() const { return added > missing ? added : missing; }
};

/// Of the union of convex shapes against a mesh, as sampled by `samples` random lines through each
/// shape and as many points of the mesh's surface, its corners among them (at least those of the
/// whole size). Points of the shapes' insides count too, so that a filled hollow shows. With
/// `closed` the mesh is a solid; else it is a surface, and only the shapes' surfaces count.
/// Low-discrepancy sequences (Halton 1960): the same on every machine.
SolidError solid_error(std::span<const PlacedShape> shapes, const Hierarchy& surface, bool closed,
                       size_t samples);

}  // namespace tumble
