#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace tumble {

/// Vertices and triangles of a small surface: one word has a bit for each of them.
inline constexpr size_t most_of_small = 64;

/// Whether a surface is small: hulls, boxes and simple meshes, without vertices of anything else.
inline bool is_small(const MeshSurface& s) {
  return s.mesh->triangles.size() <= most_of_small && s.mesh->vertices.size() <= most_of_small;
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

  /// Appends pairs until there are more than `most`, in the order of the other's triangles, and of
  /// each of them in that of the small one's.
  void run(size_t most);

 private:
  /// A triangle of the small surface, in the large one's frame.
  struct Facet {
    Aabb box;
    Vec3 normal;
    double offset;
  };
  /// A triangle of the large surface.
  struct Met {
    uint32_t id;
    std::array<Vec3, 3> corners;
    Aabb box;
  };
  struct TwoCorners {
    std::array<double, 2> x, y, z;
  };
  /// The corners that are beyond reach on either side of a triangle's plane, a bit for each.
  struct Beyond {
    uint64_t above = 0, below = 0;
  };

  void meet(uint32_t triangle);
  /// Sets the heights over a plane; how far all corners are from it on one side.
  double raise(const Vec3& normal, double offset, Beyond& beyond);
  /// Appends the pairs of the triangle that the heights are of.
  void meet_facets(const Met& triangle, const Beyond& beyond);
  /// Notes how far the facets are that are wholly beyond reach of the plane.
  void note_facets_left_out();
  double over_plane(uint32_t facet) const;
  const Facet& facet(uint32_t i);
  /// How far a facet is beyond the triangle's box, or the triangle beyond the facet's plane [m].
  double distance(uint32_t facet, const Met& triangle);

  const PlacedSurface &small_, &large_;
  Mat3 R_;                           ///< from the small surface's frame to the large one's
  std::vector<Vec3>& corners_;       ///< of the small surface, large one's frame
  std::vector<TwoCorners>& by_two_;  ///< the last one twice where their number is odd
  std::vector<double>& heights_;     ///< of the corners over the triangle at hand [m]
  std::vector<uint64_t>& masks_;     ///< of each facet the bits of its corners
  std::vector<Facet>& facets_;       ///< those that were asked for
  uint64_t asked_ = 0;               ///< a bit for each of them
  Aabb box_;
  bool is_a_;
  NearPairs& pairs_;
};

}  // namespace tumble
