#pragma once
#include "engine/geometry/isosurface/sparse_field.hpp"

#include <span>

namespace tumble {

class Crew;

/// A field whose zero surface encloses balls that are close together in one smooth skin, and a
/// single ball exactly: the distance of a point from the mean of the centres near it, less the mean
/// of their radii (Zhu and Bridson, "Animating sand as a fluid", 2005, section 5) [m]. Means are
/// weighted by (1 - (d/R)^2)^3 with the distance d from a centre and its reach R of four radii,
/// twice the distance of the centres of touching balls. The skins of two groups of balls that are
/// less than their reach apart bulge towards each other (ibid.).
///
/// Balls with radius 0 are left out. Features much smaller than `spacing` [m] may be missing. Error
/// `invalid_argument`: a value is not finite, or there would be more than most_bricks bricks. The
/// bits do not depend on the threads of `crew`.
Result<SparseField> smoothed_balls(std::span<const Vec3> centres, std::span<const double> radii,
                                   double spacing, Crew* crew = nullptr);

}  // namespace tumble
