#pragma once
#include "engine/collision/convex_pairs/pair.hpp"

namespace tumble {

/// Nearest points of a segment and an axis-aligned box centred at the origin.
struct SegmentBoxDistance {
  double t = 0;                 ///< along the segment, 0 at p0 and 1 at p1
  Vec3 on_box = Vec3::Zero();   ///< the nearest point of the box
  Vec3 between = Vec3::Zero();  ///< from the box to the segment; zero where they overlap
};

/// Exact up to rounding: the squared distance from the box is convex along the segment, and its
/// derivative is linear between the planes of the box's faces. Of several nearest points, the first
/// along the segment.
SegmentBoxDistance nearest_segment_box(const Vec3& p0, const Vec3& p1, const Vec3& half_extents);

/// Contacts of a capsule and a box in closed form; if the capsule's axis touches the box, by the
/// routine for any two convex shapes.
void collide_capsule_box(const ShapePair& pair, std::vector<Manifold>& out);

}  // namespace tumble
