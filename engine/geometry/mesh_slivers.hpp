#pragma once
#include "engine/geometry/triangle_mesh.hpp"

namespace tumble {

/// Height of a triangle over its longest side [m]; 0 for a corner that is repeated.
double triangle_height(const TriangleMesh& mesh, const Triangle& t);

/// Whether a corner is repeated or the height is at most `height` [m] or rounding error (1e-15 of
/// the longest side).
bool is_sliver(const TriangleMesh& mesh, const Triangle& t, double height = 0);

/// Closes T-junctions, as CAD exports have them, with slivers: where vertices m1, m2... of open
/// edges lie on an open edge a-b, no further away than `height` [m] or rounding error, triangles
/// (b, a, m1), (b, m1, m2)... are added behind the others, which split_at_slivers() then makes
/// halves of the one that has a-b. Left open where an edge would get a third triangle. Returns the
/// triangle beside each that was added. O(n log n).
std::vector<uint32_t> close_t_junctions(TriangleMesh& mesh, double height = 0);

/// Removes triangles that close a T-junction, as CAD exports have them: the corner m of a triangle
/// (a, b, m) lies on its longest side, no further away than `height` [m] or rounding error, and the
/// triangle on the other side of a-b is a whole one, (b, a, c). Dropping the first would open a
/// crack. Both are replaced by (b, m, c) and (m, a, c): an edge flip, which keeps every other edge
/// as it was, so that what was closed stays closed. Of a fan of slivers on one side the outermost
/// goes first, then the one that it covered. Left as it is where the edge m-c exists, or was
/// flipped away before, or a-b has not exactly two triangles. Triangles keep their numbers. Returns
/// how many were split.
size_t split_at_slivers(TriangleMesh& mesh, double height = 0);

}  // namespace tumble
