#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace tumble {

/// Whether a surface is small: hulls, boxes and simple meshes, without vertices of anything else.
inline bool is_small(const MeshSurface& s) {
  constexpr size_t most = 64;
  return s.mesh->triangles.size() <= most && s.mesh->vertices.size() <= 2 * most;
}

/// How far boxes are apart along one of their axes; negative if they overlap.
inline double gap_between(const Aabb& a, const Aabb& b) {
  return std::max((a.min - b.max).maxCoeff(), (b.min - a.max).maxCoeff());
}

/// Takes pairs of triangles with what is known of their distance [m].
struct NearPairs {
  double reach;
  double touching;                               ///< what is no farther apart may cross
  std::vector<TriangleIds>& within;              ///< reach
  std::vector<TriangleIds>* crossing = nullptr;  ///< of those, the ones that may cross
  double nearest_left_out = std::numeric_limits<double>::infinity();

  /// Whether what is at least this far apart is out of reach; notes the least such distance.
  bool apart(double distance) {
    if (distance <= reach) return false;
    nearest_left_out = std::min(nearest_left_out, distance);
    return true;
  }
  void add(const TriangleIds& pair, double distance) {
    within.push_back(pair);
    if (crossing && distance <= touching) crossing->push_back(pair);
  }
};

/// The search of near_triangles for a small surface among the triangles of any other. All of the
/// small one is turned into the frame of the other once; then one walk down the other's tree is
/// enough, and a triangle that all of the small surface is beyond is left out at once.
class SmallSurface {
 public:
  /// `is_a`: it is the pairs' A. Uses memory that other objects of the thread use too.
  SmallSurface(const PlacedSurface& small, const PlacedSurface& large, bool is_a, NearPairs& pairs);

  /// Appends pairs until there are more than `most`.
  void run(size_t most);

 private:
  struct NearFacet {
    uint32_t facet;
    double over;  ///< how far it is beyond the plane of the triangle at hand [m]
  };

  void meet(uint32_t triangle);
  std::span<const NearFacet> facets_near_plane();
  /// How far a facet is beyond the triangle's box or plane, or it beyond the facet's plane [m].
  double distance(uint32_t facet, const Aabb& box, const std::array<Vec3, 3>& triangle) const;

  const PlacedSurface &small_, &large_;
  Mat3 R_;                        ///< from the small surface's frame to the large one's
  std::vector<Vec3>& corners_;    ///< of the small surface, large one's frame
  std::vector<double>& heights_;  ///< of the corners over the triangle at hand [m]
  std::vector<NearFacet>& near_;
  Aabb box_;
  bool is_a_;
  NearPairs& pairs_;
};

}  // namespace tumble
