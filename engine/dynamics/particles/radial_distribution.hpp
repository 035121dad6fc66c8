#pragma once
#include "engine/dynamics/particles/neighbours/periodic_box.hpp"
#include "engine/dynamics/particles/tolerances.hpp"

#include <span>
#include <vector>

namespace tumble {

/// The radial distribution g(r) of points: how many there are at a distance of another one, over
/// how many there would be if they were anywhere (Allen and Tildesley 2017, section 8.2). Shells of
/// equal thickness up to `range` [m], which is at most half of any edge of a periodic box. In a box
/// that is periodic along all axes the density is that of the box; elsewhere it is the mean one
/// within `range` about a point, so that the mean of g over that ball is 1. Where there are more
/// than about `most_pairs` pairs to look at, distances are taken from every k-th point only.
std::vector<double> radial_distribution(std::span<const Vec3> points, const PeriodicBox& box,
                                        double range, size_t shells,
                                        double most_pairs = tolerances::most_radial_pairs);

}  // namespace tumble
