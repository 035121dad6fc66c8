#pragma once
#include "engine/geometry/debug_draw.hpp"
#include "engine/math/types.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

enum class BoundForm : uint8_t { box, sphere, hull };

/// The bounding volume of one node of any hierarchy, in the mesh's frame: all points within
/// `radius` of the convex hull of `points`.
struct NodeBound {
  BoundForm form = BoundForm::box;
  /// A box's eight corners (bit k of the number tells the side of its axis k, radius 0), a sphere's
  /// centre, or points that span a rounded hull.
  std::vector<Vec3> points;
  double radius = 0;                    ///< [m]
  int level = 0;                        ///< below the root
  bool leaf = false;                    ///< no nodes below it
  std::span<const uint32_t> triangles;  ///< of the mesh, that it holds; of the hierarchy's memory
};

/// Makes `out` a box of centre and half-axis vectors (columns).
void set_box(NodeBound& out, const Vec3& centre, const Mat3& half_axes);

/// Volume [m^3] and surface [m^2] of a convex body, and its integral of mean curvature [m].
struct ConvexMeasure {
  double volume = 0, surface = 0, curvature = 0;
};

/// Measures of a bound. Rounded hulls by Steiner's formula: with V, S and M of the hull of the
/// points, M being half the sum over edges of length times exterior angle, a radius r gives
/// V + S r + M r^2 + 4/3 pi r^3. A flat hull counts both its sides.
ConvexMeasure measure(const NodeBound& bound);

/// Draws the volume as wires on its surface: the edges of a box, three great circles of a sphere,
/// the edges of a hull, their ends moved out to the rounded corners.
void draw_bound(const NodeBound& bound, const Pose& pose, const Vec4f& colour, DebugDraw& out);

}  // namespace tumble
