#pragma once
#include "assets/generate/mesh.hpp"

namespace tumble::assets {

/// Twice the signed area of a loop, positive when counter-clockwise [m^2].
double twice_area(const Loop2& loop);

/// Triangles of a simple polygon with holes, by ear clipping (Meisters 1975; holes are joined by
/// bridges as in Eberly 2002). Among the ears the best shaped is cut
/// first, and afterwards diagonals are swapped while that improves the worse of two neighbours.
/// `loops` holds the outer loop counter-clockwise, then the holes clockwise; indices run through
/// all loops in turn.
std::vector<std::array<int, 3>> triangulate(const std::vector<Loop2>& loops);

}  // namespace tumble::assets
