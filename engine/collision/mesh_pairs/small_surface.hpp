#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace tumble {

/// Limit of the vertices and triangles of a small surface: one word has a bit for each.
inline constexpr size_t most_of_small = 64;

/// Whether a surface is small: hulls, boxes and simple meshes. Its mesh must have no unused
/// vertices.
inline bool is_small(const MeshSurface& s) {
  return s.mesh->triangles.size() <= most_of_small && s.mesh->vertices.size() <= most_of_small;
}

/// Gap between boxes along the axis where it is greatest; negative if they overlap.
inline double gap_between(const Aabb& a, const Aabb& b) {
  return std::max((a.min - b.max).maxCoeff(), (b.min - a.max).maxCoeff());
}

/// Receives pairs of triangles with a lower bound of their distance [m].
struct NearPairs {
  double reach;
  double touching;                               ///< pairs up to this distance may cross [m]
  std::vector<TriangleIds>& within;              ///< pairs within `reach`
  std::vector<TriangleIds>* crossing = nullptr;  ///< of these, the pairs that may cross
  double nearest_left_out = std::numeric_limits<double>::infinity();

  /// Whether a pair at least this far apart is out of reach; records the least such distance.
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

/// The search of near_triangles for a small surface among the triangles of any other. The small
/// surface is transformed to the frame of the other once; then one descent of the other's tree
/// suffices, and a triangle of the other whose plane has the whole small surface beyond reach is
/// rejected at once.
class SmallSurface {
 public:
  /// `is_a`: the small surface is A of the pairs. Uses thread-local memory shared by all objects.
  SmallSurface(const PlacedSurface& small, const PlacedSurface& large, bool is_a, NearPairs& pairs);

  /// Appends pairs, in the order of the other's triangles and then of the small one's, until there
  /// are more than `most`.
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
  /// The corners beyond reach on either side of a triangle's plane, a bit for each.
  struct Beyond {
    uint64_t above = 0, below = 0;
  };

  void meet(uint32_t triangle);
  /// Computes the heights of all corners over a plane; returns by how much all are on one side of
  /// it.
  double raise(const Vec3& normal, double offset, Beyond& beyond);
  /// The facets with a corner that is not among these, a bit for each.
  uint64_t facets_with_others(uint64_t corners) const;
  /// Appends the pairs of the triangle for which the heights were computed.
  void meet_facets(const Met& triangle, const Beyond& beyond);
  /// Records the distance of the facets that are beyond reach of the plane.
  void note_facets_left_out();
  double over_plane(uint32_t facet) const;
  const Facet& facet(uint32_t i);
  /// Distance of a facet from the triangle's box, or of the triangle from the facet's plane, if
  /// greater [m].
  double distance(uint32_t facet, const Met& triangle);

  const PlacedSurface &small_, &large_;
  Mat3 R_;                            ///< from the small surface's frame to the large one's
  std::vector<Vec3>& corners_;        ///< of the small surface, large one's frame
  std::vector<TwoCorners>& by_two_;   ///< in pairs, the last one twice if their number is odd
  std::vector<double>& heights_;      ///< of the corners over the plane of the current triangle [m]
  std::vector<uint64_t>& facets_at_;  ///< for each corner the bits of the facets that meet there
  std::vector<Facet>& facets_;        ///< computed on first use
  uint64_t asked_ = 0;                ///< a bit for each facet that has been computed
  Aabb box_;
  bool is_a_;
  NearPairs& pairs_;
};

}  // namespace tumble
