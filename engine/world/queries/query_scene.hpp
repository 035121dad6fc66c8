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

/// The shapes of a frame under a tree, for questions about the world as it was then. Immutable, so
/// that any number of threads may ask at once; the same question gives the same bits. Answers do
/// not depend on the order in which the tree is searched: what is equal otherwise is ordered by
/// ids.
///
/// Questions that are not finite, or out of range, give an Error that names the value. Half-spaces
/// count as far as they reach; a half-space as the asking shape does not meet other half-spaces.
class QueryScene {
 public:
  explicit QueryScene(std::shared_ptr<const Frame> frame, Crew* crew = nullptr);
  const Frame& frame() const { return *frame_; }
  /// Whether this answers for another frame too, because nothing has moved in between.
  bool serves(const Frame& frame) const;

  /// The nearest hit.
  Result<std::optional<RayQueryHit>> ray(const RayQuery& query,
                                         const QueryFilter& filter = {}) const;
  /// Where the ray meets each shape first, nearest first.
  Result<std::vector<RayQueryHit>> ray_all(const RayQuery& query,
                                           const QueryFilter& filter = {}) const;
  /// Whether anything is hit at all: the cheapest.
  Result<bool> ray_any(const RayQuery& query, const QueryFilter& filter = {}) const;

  /// What a moving shape meets first; `shape` any type.
  Result<std::optional<CastHit>> cast(const Shape& shape, const CastQuery& query,
                                      const QueryFilter& filter = {}) const;
  /// Where it meets each shape first, as if alone with it; first contact first.
  Result<std::vector<CastHit>> cast_all(const Shape& shape, const CastQuery& query,
                                        const QueryFilter& filter = {}) const;

  /// All that touches or overlaps the shape at a pose (see overlap() in collision/query.hpp), by
  /// ids.
  Result<std::vector<QueryTarget>> overlaps(const Shape& shape, const Pose& pose,
                                            const QueryFilter& filter = {}) const;
  Result<bool> overlaps_any(const Shape& shape, const Pose& pose,
                            const QueryFilter& filter = {}) const;
  /// The solids that hold a point (convex shapes, half-spaces, closed meshes, particles), by ids.
  Result<std::vector<QueryTarget>> holding(const Vec3& x_world,
                                           const QueryFilter& filter = {}) const;

  /// The surfaces nearest to a point, at most one per shape and `count` in all, nearest first (what
  /// it is deepest in before that), none further than `max_distance` (>= 0) [m].
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
  /// Balls of all particle systems, made for the first question that takes notice of them.
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
