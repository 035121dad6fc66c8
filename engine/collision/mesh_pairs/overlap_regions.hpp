#pragma once
#include "engine/collision/mesh_pairs/overlap_contours.hpp"

namespace tumble {

/// A connected part in which two solids overlap.
///
/// The vector area of A's patch inside B, the integral of A's outward normal over it, is the rate
/// at which the overlap's volume grows as A moves: its direction is the way in, from A to B, up to
/// the full thickness of both and without jumps (Allard et al., "Volume contact constraints at
/// arbitrary resolution", 2010). It depends on the contour alone: half the sum of p x q.
struct OverlapRegion {
  Vec3 area = Vec3::Zero();  ///< vector area of A's patch inside B, query frame [m2]
  /// Its direction; zero when it all but cancels: a thing that sticks out on both sides, which no
  /// small translation frees; and where the contour is no wider than rounding makes it.
  Vec3 normal = Vec3::Zero();
  Vec3 centre = Vec3::Zero();  ///< of the contour, query frame [m]
  Aabb box;                    ///< of the contour and the vertices inside, query frame
  double height = 0;           ///< of the contour and the vertices inside, along the normal [m]
  double depth = 0;            ///< of the deepest column along the normal [m]
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

/// Index 0 is of A, 1 of B.
struct OverlapRegions {
  std::vector<OverlapRegion> regions;
  std::array<std::vector<InsideVertex>, 2> vertices;  ///< ascending by region and vertex
  std::array<std::vector<InsidePiece>, 2> pieces;     ///< ascending by region and edge
  bool sound = true;                                  ///< nothing is both inside and outside
};

/// The regions that sound contours bound. From the contours everything inside is found along
/// edges, which do not cross a contour unseen.
void find_regions(const PlacedSurface& A, const PlacedSurface& B, const OverlapContours& contours,
                  OverlapRegions& out);

/// Contacts of one region along its normal: active vertices inside the other solid and active edges
/// across each other, each as deep as the overlap is there along the normal. Sets the depth of the
/// region. A region without any of these gets one contact in the middle of its contour; where the
/// surfaces do not overlap there, it crosses by rounding alone: no deeper than a hair, but its
/// normal still says which features lead out. Nothing for a region without normal.
void region_contacts(const PlacedSurface& A, const PlacedSurface& B, OverlapRegions& regions,
                     uint32_t region, std::vector<FeatureContact>& contacts);

}  // namespace tumble
