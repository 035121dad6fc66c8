#pragma once
#include "engine/dynamics/bodies/body.hpp"

#include <span>

namespace tumble {

/// How thick a body is where it is thinnest [m], however it is cut into shapes.
///
/// In the middle of each convex shape stands the largest ball inside all of the shapes together; a
/// shape is as thick as the largest of these that meets its own (after the local thickness of
/// Hildebrand and Ruegsegger 1997, that of the largest ball inside which holds a point); the least
/// of the shapes counts. A ring of twelve pieces is as thick as its tube, not as its pieces are
/// long, and the corner of a block that is cut into cubes as the block.
///
/// From there shapes are followed outwards, to two inner radii from their farthest points along and
/// across their axes, wherever they leave all balls that are as thick as the least so far. What is
/// bare of such balls is as thick as the ball that a ball there grows to, away from the walls that
/// it touches for as long as that leads to a larger one: by the shortest vector among the hull of
/// the ways to these walls (the flow of the distance, Lieutier 2004; found as Wolfe does, 1975, by
/// walls met on the way). A ball in the corner of a block grows to that of the block; one in a
/// disc, a fin or an axle through a thick part has walls on both sides and stays.
///
/// Distances to walls are exact (BareSurface). A lone shape and one that is not convex count by
/// themselves (Shape::inner_radius), and none counts less than that. What has been found of shapes
/// of one content in one arrangement is remembered, for all worlds and threads.
double inner_radius_of(std::span<const BodyShape> shapes);

}  // namespace tumble
