#pragma once
#include "engine/dynamics/bodies/body.hpp"

#include <span>

namespace tumble {

/// How thick a body is where it is thinnest [m], however it is cut into shapes. In the middle of
/// each convex shape stands the largest ball inside all of the shapes together; a shape is as thick
/// as the largest of these that meets its own (after the local thickness of Hildebrand and
/// Ruegsegger 1997, that of the largest ball inside which holds a point); the least of the shapes
/// counts. A ring of twelve pieces is as thick as its tube, not as its pieces are long, and the
/// corner of a block that is cut into cubes as the block. A lone shape and one that is not convex
/// count by themselves (Shape::inner_radius), and none counts less than that.
///
/// A ball is found by rays from its centre: along the normals of all faces that may be nearest,
/// which is exact where a free face holds the foot of the perpendicular, and in even steps over the
/// sphere for what lies between.
double inner_radius_of(std::span<const BodyShape> shapes);

}  // namespace tumble
