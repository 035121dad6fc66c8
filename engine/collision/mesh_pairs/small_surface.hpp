#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <algorithm>

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

/// The search of near_triangles for a small surface among the triangles of any other. All of the
/// small one is turned into the frame of the other once; then one walk down the other's tree is
/// enough, and a triangle that all of the small surface is beyond is left out at once.
class SmallSurface {
 public:
  /// `is_a`: it is the pairs' A. Uses memory that other objects of the thread use too.
  SmallSurface(const PlacedSurface& small, const PlacedSurface& large, bool is_a, double reach,
               std::vector<TriangleIds>& pairs);

  /// Appends pairs until there are more than `most`. The distance [m] that no triangles that were
  /// left out go below.
  double run(size_t most);

 private:
  /// A triangle of the small surface, large surface's frame.
  struct Facet {
    Aabb box;
    Vec3 normal;
    double offset;
    std::array<uint32_t, 3> corners;
  };

  bool apart(double distance);
  void meet(uint32_t triangle);

  const PlacedSurface& large_;
  std::vector<Vec3>& corners_;
  std::vector<Facet>& facets_;
  std::vector<double>& heights_;  ///< of the corners over the triangle at hand [m]
  Aabb box_;
  double reach_, rounding_;
  double nearest_left_out_;
  bool is_a_;
  std::vector<TriangleIds>& pairs_;
};

}  // namespace tumble
