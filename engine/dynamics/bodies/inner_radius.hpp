#pragma once
#include "engine/dynamics/bodies/body.hpp"

#include <span>

namespace tumble {

/// The thickness of a body where it is thinnest [m], however it is divided into shapes.
///
/// In the middle of each convex shape stands the largest ball inside the union of all shapes. The
/// thickness of a shape is the radius of the largest of these balls that meets its own ball (after
/// the local thickness of Hildebrand and Ruegsegger 1997, the largest ball inside that contains a
/// point); the least of all shapes counts.
/// of the shapes counts. A ring of twelve pieces is as thick as its tube, not as its pieces are
/// long, and the corner of a block that is cut into cubes as the block.
///
/// From there each shape is followed outwards, up to two inner radii from its farthest points along
/// and across its axes, to places outside of all balls that are at least as thick as the least so
/// far. The thickness at such a place is that of the ball to which a ball there grows, by moving
/// its centre away from the walls that it touches as long as that leads to a larger one: along the
/// shortest vector of the convex hull of the directions from these walls (the flow of the distance
/// function, Lieutier 2004; walls are collected on the way as in Wolfe's method, 1975). A ball in
/// the corner of a block grows to that of the block; one in a disc, a fin or an axle through a
/// thick part has walls on both sides and stays.
///
/// Distances to walls are exact (BareSurface). A single shape, and one that is not convex, count by
/// themselves (Shape::inner_radius), and no shape counts less than that. Results are cached by
/// content and arrangement of the shapes, for all worlds and threads.
double inner_radius_of(std::span<const BodyShape> shapes);

}  // namespace tumble
