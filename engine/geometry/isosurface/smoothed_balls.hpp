#pragma once
#include "engine/geometry/isosurface/sparse_field.hpp"

#include <span>

namespace tumble {

class Crew;

/// The field whose surface wraps balls that lie close together in one smooth skin, and a lone ball
/// exactly: distance of a point to the mean of the centres near it, less the mean of their radii
/// (Zhu and Bridson, "Animating sand as a fluid", 2005, section 5), in m. Means are weighted by (1
/// - (d/R)^2)^3 with the distance d from a centre and its reach R of four radii, twice the distance
/// of centres whose balls touch. Where two bodies of balls are less than their reach apart, skins
/// bulge towards each other (ibid.).
///
/// Balls without radius are left out. What is much smaller than `spacing` [m] may be missing. Error
/// `invalid_argument`: a value is not finite, or there would be more than most_bricks bricks.
/// Bits do not depend on the threads of `crew`.
Result<SparseField> smoothed_balls(std::span<const Vec3> centres, std::span<const double> radii,
                                   double spacing, Crew* crew = nullptr);

}  // namespace tumble
