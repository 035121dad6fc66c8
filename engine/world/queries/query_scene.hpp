#pragma once
#include "engine/collision/bounds_tree.hpp"
#include "engine/core/result.hpp"
#include "engine/world/frame.hpp"
#include "engine/world/queries/query.hpp"

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace tumble {

/// The shapes of a frame in a bounding volume tree, for queries about the world as it was then.
/// Immutable, so that any number of threads may ask at once; the same query gives the same bits.
/// Results do not depend on the order in which the tree is searched: ties are ordered by ids.
///
/// A query that is not finite, or out of range, gives an Error that names the value. Half-spaces
/// are unbounded; a half-space as the query's shape does not meet other half-spaces.
class QueryScene {
 public:
  explicit QueryScene(std::shared_ptr<const Frame> frame, Crew* crew = nullptr);
  const Frame& frame() const { return *frame_; }
  /// Whether the results hold for another frame too, because nothing moved in between.
  bool serves(const Frame& frame) const;

  /// The nearest hit.
  Result<std::optional<RayQueryHit>> ray(const RayQuery& query,
                                         const QueryFilter& filter = {}) const;
  /// The first hit of the ray with each shape, nearest first.
  Result<std::vector<RayQueryHit>> ray_all(const RayQuery& query,
                                           const QueryFilter& filter = {}) const;
  /// Whether anything is hit at all; the cheapest query.
  Result<bool> ray_any(const RayQuery& query, const QueryFilter& filter = {}) const;

  /// The first contact of a moving shape; `shape` may be of any type.
  Result<std::optional<CastHit>> cast(const Shape& shape, const CastQuery& query,
                                      const QueryFilter& filter = {}) const;
  /// The first contact of the moving shape with each shape, as if it were the only one; earliest
  /// first.
  Result<std::vector<CastHit>> cast_all(const Shape& shape, const CastQuery& query,
                                        const QueryFilter& filter = {}) const;

  /// All shapes that touch or overlap the shape at this pose (see overlap() in
  /// collision/query.hpp), ordered by ids.
  Result<std::vector<QueryTarget>> overlaps(const Shape& shape, const Pose& pose,
                                            const QueryFilter& filter = {}) const;
  Result<bool> overlaps_any(const Shape& shape, const Pose& pose,
                            const QueryFilter& filter = {}) const;
  /// The solids that contain a point (convex shapes, half-spaces, closed meshes, particles),
  /// ordered by ids.
  Result<std::vector<QueryTarget>> holding(const Vec3& x_world,
                                           const QueryFilter& filter = {}) const;

  /// The surfaces nearest to a point, at most one per shape and `count` in all, by ascending signed
  /// distance, none further than `max_distance` (>= 0) [m].
  Result<std::vector<NearHit>> nearest(
      const Vec3& x_world, size_t count = 1,
      double max_distance = std::numeric_limits<double>::infinity(),
      const QueryFilter& filter = {}) const;

 private:
  struct Placed {
    const Shape* shape;
    Pose pose;
    QueryTarget target;
    BodyType type;
  };
  /// Balls of all particle systems, built for the first query that includes particles.
  struct Balls {
    std::vector<QueryTarget> targets;
    BoundsTree tree;
  };
  struct Ball {
    Vec3 x;
    double radius;
  };
  const Balls& balls() const;
  Ball ball(const QueryTarget& target) const;

  template <class Visit>
  void rays(const RayQuery& query, const QueryFilter& filter, const Visit& visit) const;
  template <class Visit>
  void casts(const Shape& shape, const CastQuery& query, const QueryFilter& filter,
             const Visit& visit) const;
  template <class Visit>
  void overlapping(const Shape& shape, const Pose& pose, const QueryFilter& filter,
                   const Visit& visit) const;

  std::shared_ptr<const Frame> frame_;
  std::vector<Placed> placed_;
  BoundsTree tree_;
  mutable std::once_flag balls_once_;
  mutable Balls balls_;
};

}  // namespace tumble
