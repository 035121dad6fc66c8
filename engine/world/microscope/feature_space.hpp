#pragma once
#include "engine/collision/v_clip/v_clip.hpp"
#include "engine/world/microscope/microscope.hpp"

#include <optional>

namespace tumble {

/// The two polyhedra of a slide, and their features in world coordinates.
class FeatureSpace {
 public:
  explicit FeatureSpace(const MicroscopeSlide& slide);

  /// In the frame of the query, which has its origin at that of A.
  const PlacedPolyhedron& a() const { return placed_[0]; }
  const PlacedPolyhedron& b() const { return placed_[1]; }
  Vec3 from_query(const Vec3& p) const { return origin_ + p; }

  /// Corners of a feature in order: one of a vertex, two of an edge, all of a face.
  std::vector<Vec3> corners(const PolyhedronFeature& feature, size_t body) const;
  /// Nearest points of two features, regardless of the rest of the bodies.
  struct Nearest {
    Vec3 a, b;
    double distance;  ///< [m]
  };
  Nearest nearest(const ClosestFeatures& at) const;

  void draw(Sketch& out) const;
  void draw_features(Sketch& out, const ClosestFeatures& at) const;
  /// The Voronoi plane that the walk crosses when a feature of `body` is replaced by a neighbour.
  void draw_crossed_plane(Sketch& out, const PolyhedronFeature& from, const PolyhedronFeature& to,
                          size_t body) const;

 private:
  Vec3 point(size_t body, const Vec3& p) const;
  void draw_across(Sketch& out, uint32_t edge, uint32_t vertex, size_t body) const;
  void draw_upright(Sketch& out, uint32_t edge, uint32_t face, size_t body) const;

  const MicroscopeSlide& slide_;
  std::array<PlacedPolyhedron, 2> placed_;
  Vec3 origin_;
};

}  // namespace tumble
