#pragma once
#include "engine/collision/contact_query.hpp"
#include "engine/collision/manifold_builder.hpp"
#include "engine/collision/shape.hpp"

#include <algorithm>
#include <vector>

namespace tumble {

/// Two shapes to be tested, in a frame with world axes and its origin at A, so that contacts lose
/// no accuracy far from the world's origin.
struct ShapePair {
  const Shape& a;
  const Shape& b;
  Pose pose_a, pose_b;             ///< pair frame
  Vec3 origin;                     ///< of the pair frame in the world [m]
  double margin;                   ///< points with a larger gap are left out [m]
  const HierarchyKind* hierarchy;  ///< for mesh against mesh; null for the boxes of every mesh
  std::span<const uint64_t> kept;  ///< ContactQuery::kept
  const ClosestFeatures* start;    ///< ContactQuery::start
  double* apart;                   ///< ContactQuery::apart

  ShapePair(const Shape& sa, const Pose& pa, const Shape& sb, const Pose& pb,
            const ContactQuery& query)
      : a(sa),
        b(sb),
        pose_a{Vec3::Zero(), pa.q},
        pose_b{pb.x - pa.x, pb.q},
        origin(pa.x),
        margin(query.margin),
        hierarchy(query.hierarchy),
        kept(query.kept),
        start(query.start),
        apart(query.apart) {}

  /// Reports that the shapes are farther apart than the margin: `distance` is a lower bound, up to
  /// the rounding of lengths of `scale`.
  void found_apart(double distance, double scale) const {
    if (apart) *apart = std::max(*apart, distance - 1e-14 * scale);
  }
};

/// Appends the manifold of the candidates, if there are any, in world coordinates.
inline void emit(const ShapePair& pair, const ManifoldBuilder& points, const Vec3& normal,
                 uint64_t part, std::vector<Manifold>& out) {
  if (points.count() == 0) return;
  Manifold& m = out.emplace_back();
  points.finish(normal, part, pair.kept, m);
  for (int i = 0; i < m.count; ++i) m.points[size_t(i)].x_world += pair.origin;
}

/// Added to Manifold::part where one part has two manifolds.
constexpr uint64_t second_manifold = uint64_t{1} << 32;

/// Appends the candidates of a surface that need not be flat, in world coordinates: a manifold and,
/// unless its points are all nearly equally near, a second one of the points that are left out,
/// which a rocking body touches next. Empties `points`.
void emit_nearest(const ShapePair& pair, std::vector<ManifoldPoint>& points, const Vec3& normal,
                  uint64_t part, std::vector<Manifold>& out);

/// A routine that finds the contacts of a pair of shape types.
using CollidePair = void (*)(const ShapePair& pair, std::vector<Manifold>& out);

}  // namespace tumble
