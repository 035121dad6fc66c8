#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <span>

namespace tumble {

/// Cuts a simple polygon, planar or nearly so, into corners - 2 triangles of the same orientation
/// by clipping ears (Meisters 1975), best shaped first for small ones. `corners` are indices into
/// `vertices`; the triangles are appended to `out`.
///
/// Any input gives corners - 2 triangles: a polygon that crosses itself or has no area is cut as
/// far as it has ears and then anyhow. Fewer than three corners give none. Decisions are exact in
/// the coordinate plane that the polygon faces most. Quadratic in corners; above 10,000 a fan.
void triangulate_polygon(std::span<const Vec3> vertices, std::span<const uint32_t> corners,
                         std::vector<Triangle>& out);

}  // namespace tumble
