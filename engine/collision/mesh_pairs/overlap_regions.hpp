#pragma once
#include "engine/collision/mesh_pairs/overlap_contours.hpp"

namespace tumble {

/// A connected region of overlap of two solids.
///
/// The vector area of A's patch inside B, the integral of A's outward normal over it, is the
/// gradient of the overlap's volume with respect to a translation of A: its direction is the
/// direction of penetration, from A to B, and continuous up to the full thickness of both (Allard
/// et al., "Volume contact constraints at arbitrary resolution", 2010). It depends on the contour
/// alone: half the sum of p x q over its segments.
struct OverlapRegion {
  Vec3 area = Vec3::Zero();  ///< vector area of A's patch inside B, query frame [m2]
  /// Its direction; zero if the area nearly cancels, as for a part that sticks out on both sides
  /// and that no small translation frees, and if the contour is no wider than rounding makes it.
  Vec3 normal = Vec3::Zero();
  Vec3 centre = Vec3::Zero();  ///< of the contour, query frame [m]
  Aabb box;                    ///< of the contour and the vertices inside, query frame
  /// Extent of the contour and the vertices inside, along the normal [m].
  double height = 0;
  double depth = 0;  ///< length of the longest column of overlap along the normal [m]
};

/// A vertex inside the other solid.
struct InsideVertex {
  uint32_t vertex, region;
};
/// A piece of an edge inside the other solid.
struct InsidePiece {
  uint32_t edge, region;
  double from, to;  ///< as ContourNode::s
};

/// Index 0 refers to A, 1 to B.
struct OverlapRegions {
  std::vector<OverlapRegion> regions;
  std::array<std::vector<InsideVertex>, 2> vertices;  ///< ascending by region and vertex
  std::array<std::vector<InsidePiece>, 2> pieces;     ///< ascending by region and edge
  bool sound = true;                                  ///< no vertex is both inside and outside
};

/// Finds the regions that closed contours bound: from the contours, all vertices inside are reached
/// along edges, which cannot cross a contour unnoticed.
void find_regions(const PlacedSurface& A, const PlacedSurface& B, const OverlapContours& contours,
                  OverlapRegions& out);

/// Contacts of one region along its normal: active vertices inside the other solid and pairs of
/// active edges that cross each other, each with the depth of the overlap there along the normal.
/// Sets the depth of the region. A region without any of these gets one contact in the middle of
/// its contour; if the surfaces do not overlap there, they cross by rounding alone: the contact is
/// not deeper than that, but its normal still tells which features lead out. Adds nothing for a
/// region without normal.
void region_contacts(const PlacedSurface& A, const PlacedSurface& B, OverlapRegions& regions,
                     uint32_t region, std::vector<FeatureContact>& contacts);

}  // namespace tumble
