#include "engine/collision/query.hpp"
#include "engine/collision/shape_near.hpp"
#include "engine/world/queries/checks.hpp"
#include "engine/world/queries/filter_test.hpp"
#include "engine/world/queries/query_scene.hpp"
#include "engine/world/queries/tolerances.hpp"

#include <algorithm>

namespace tumble {

/// Calls visit(target) for all that overlaps, until it returns false.
template <class Visit>
void QueryScene::overlapping(const Shape& shape, const Pose& pose, const QueryFilter& filter,
                             const Visit& visit) const {
  const FilterTest test(filter);
  const Aabb exact = shape.bounds(pose);
  const double size = exact.min.cwiseAbs().cwiseMax(exact.max.cwiseAbs()).maxCoeff();
  const Aabb bounds =
      std::isfinite(size) ? exact.inflated(tolerances::query_rounding * size) : exact;
  bool more = true;
  tree_.overlapping(bounds, [&](uint32_t i) {
    const Placed& p = placed_[i];
    if (test.takes(p.target, p.type) && overlap(shape, pose, *p.shape, p.pose))
      more = visit(p.target);
    return more;
  });
  if (!filter.particles || !more) return;
  balls().tree.overlapping(bounds, [&](uint32_t i) {
    const QueryTarget& target = balls().targets[i];
    const Ball b = ball(target);
    if (near_shape(shape, pose, b.x, b.radius) && test.takes(target)) more = visit(target);
    return more;
  });
}

Result<std::vector<QueryTarget>> QueryScene::overlaps(const Shape& shape, const Pose& pose,
                                                      const QueryFilter& filter) const {
  const auto at = require_pose(pose);
  if (!at) return at.error();
  std::vector<QueryTarget> found;
  overlapping(shape, *at, filter, [&](const QueryTarget& target) {
    found.push_back(target);
    return true;
  });
  std::sort(found.begin(), found.end());
  return found;
}

Result<bool> QueryScene::overlaps_any(const Shape& shape, const Pose& pose,
                                      const QueryFilter& filter) const {
  const auto at = require_pose(pose);
  if (!at) return at.error();
  bool any = false;
  overlapping(shape, *at, filter, [&](const QueryTarget&) {
    any = true;
    return false;
  });
  return any;
}

Result<std::vector<QueryTarget>> QueryScene::holding(const Vec3& x,
                                                     const QueryFilter& filter) const {
  if (Status s = require_finite("point", x); !s) return s.error();
  const FilterTest test(filter);
  std::vector<QueryTarget> found;
  const Aabb here = Aabb{x, x}.inflated(tolerances::query_rounding * x.cwiseAbs().maxCoeff());
  tree_.overlapping(here, [&](uint32_t i) {
    const Placed& p = placed_[i];
    if (test.takes(p.target, p.type) && holds_point(*p.shape, p.pose, x)) found.push_back(p.target);
    return true;
  });
  if (filter.particles) {
    balls().tree.overlapping(here, [&](uint32_t i) {
      const QueryTarget& target = balls().targets[i];
      const Ball b = ball(target);
      if ((b.x - x).norm() <= b.radius && test.takes(target)) found.push_back(target);
      return true;
    });
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace tumble
