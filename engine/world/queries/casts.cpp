#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/query.hpp"
#include "engine/collision/shapes/validation.hpp"
#include "engine/world/queries/checks.hpp"
#include "engine/world/queries/filter_test.hpp"
#include "engine/world/queries/query_scene.hpp"
#include "engine/world/queries/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// The query with a unit quaternion, or the error in it.
Result<CastQuery> check_cast(CastQuery q) {
  const auto start = require_pose(q.start);
  if (!start) return start.error();
  q.start = *start;
  if (Status s = require_finite("translation", q.translation); !s) return s.error();
  if (Status s = require_finite("rotation", q.rotation); !s) return s.error();
  if (!(q.tolerance > 0 && std::isfinite(q.tolerance)))
    return bad_query(fmt::format("tolerance must be > 0, got {} m", q.tolerance));
  return q;
}

bool sooner(const CastHit& a, const CastHit& b) {
  return a.fraction != b.fraction ? a.fraction < b.fraction : a.target < b.target;
}

/// The hit of a shape that touches at the start: the deepest contact point, if the surfaces meet at
/// all.
CastHit start_hit(const Shape& shape, const Pose& start, const Shape& other, const Pose& pose) {
  CastHit hit;
  hit.x_world = start.x;
  hit.status = TimeOfContactStatus::initially_overlapping;
  std::vector<Manifold> contacts;
  collide(shape, start, other, pose, 0, contacts);
  double least = std::numeric_limits<double>::infinity();
  for (const Manifold& m : contacts) {
    for (int k = 0; k < m.count; ++k) {
      const ManifoldPoint& p = m.points[size_t(k)];
      if (!(p.gap < least)) continue;
      least = p.gap;
      hit.normal = -m.normal;
      hit.x_world = p.x_world + 0.5 * p.gap * m.normal;
    }
  }
  return hit;
}

/// The first contact with one shape at a fraction up to `limit`.
std::optional<CastHit> cast_at(const Shape& shape, const CastQuery& q, double limit,
                               const Shape& other, const Pose& pose) {
  if (q.hit_at_start && overlap(shape, q.start, other, pose))
    return start_hit(shape, q.start, other, pose);
  if (!(limit > 0)) return std::nullopt;
  const Motion moving{q.start, q.translation, q.rotation, 0, limit, {}};
  const TimeOfContact toc =
      time_of_contact(shape, moving, other, Motion::at_rest(pose, 0, limit), q.tolerance);
  if (toc.status == TimeOfContactStatus::separated || toc.status == TimeOfContactStatus::invalid)
    return std::nullopt;
  const bool at_start = toc.status == TimeOfContactStatus::initially_overlapping;
  if (at_start && !q.hit_at_start) return std::nullopt;
  CastHit hit;
  hit.fraction = at_start ? 0 : toc.time;
  hit.x_world = toc.on_b;
  hit.normal = -toc.normal;
  hit.status = toc.status;
  return hit;
}

}  // namespace

/// Calls visit(hit) with the first contact of each shape at a fraction up to the limit; it returns
/// the limit from then on, which may be smaller.
template <class Visit>
void QueryScene::casts(const Shape& shape, const CastQuery& q, const QueryFilter& filter,
                       const Visit& visit) const {
  const FilterTest test(filter);
  // For a rotating shape, a box about the sphere that contains it in every orientation.
  const bool turns = !q.rotation.isZero(0);
  const Aabb bounds =
      turns ? Aabb{q.start.x, q.start.x}.inflated(shape.bounding_radius()) : shape.bounds(q.start);
  const bool endless = !bounds.min.allFinite() || !bounds.max.allFinite();
  const Ray way{endless ? Vec3(Vec3::Zero()) : bounds.centre(), q.translation};
  const Vec3 half = endless ? Vec3(Vec3::Constant(tolerances::endless_half_size))
                            : Vec3(0.5 * bounds.extent().array() + q.tolerance);
  double limit = 1;
  const auto meet = [&](const QueryTarget& target, const Shape& other, const Pose& pose) {
    auto hit = cast_at(shape, q, limit, other, pose);
    if (!hit) return;
    hit->target = target;
    limit = visit(*hit);
  };
  tree_.along(way, half, limit, [&](uint32_t i) {
    const Placed& p = placed_[i];
    if (test.takes(p.target, p.type)) meet(p.target, *p.shape, p.pose);
    return limit;
  });
  if (!filter.particles) return;
  balls().tree.along(way, half, limit, [&](uint32_t i) {
    const QueryTarget& target = balls().targets[i];
    if (!test.takes(target)) return limit;
    const Ball b = ball(target);
    const auto sphere = make_shape(ball_def(std::clamp(b.radius, min_shape_size, max_shape_size)));
    if (sphere) meet(target, **sphere, {b.x, Quat::Identity()});
    return limit;
  });
}

Result<std::optional<CastHit>> QueryScene::cast(const Shape& shape, const CastQuery& query,
                                                const QueryFilter& filter) const {
  const auto q = check_cast(query);
  if (!q) return q.error();
  std::optional<CastHit> best;
  casts(shape, *q, filter, [&](const CastHit& hit) {
    if (!best || sooner(hit, *best)) best = hit;
    return best->fraction;
  });
  return best;
}

Result<std::vector<CastHit>> QueryScene::cast_all(const Shape& shape, const CastQuery& query,
                                                  const QueryFilter& filter) const {
  const auto q = check_cast(query);
  if (!q) return q.error();
  std::vector<CastHit> hits;
  casts(shape, *q, filter, [&](const CastHit& hit) {
    hits.push_back(hit);
    return 1.0;
  });
  std::sort(hits.begin(), hits.end(), sooner);
  return hits;
}

}  // namespace tumble
