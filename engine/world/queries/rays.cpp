#include "engine/world/queries/checks.hpp"
#include "engine/world/queries/filter_test.hpp"
#include "engine/world/queries/query_scene.hpp"

#include <algorithm>

namespace tumble {
namespace {

Status check_ray(const RayQuery& q) {
  if (Status s = require_finite("origin", q.origin); !s) return s;
  if (Status s = require_finite("direction", q.direction); !s) return s;
  return require_distance(q.max_distance);
}

/// The unit vector, or zero; scaled by the largest component first, so that no square overflows or
/// underflows.
Vec3 unit_or_zero(const Vec3& d) {
  const double largest = d.cwiseAbs().maxCoeff();
  return largest > 0 ? Vec3((d / largest).normalized()) : Vec3(Vec3::Zero());
}

bool nearer(const RayQueryHit& a, const RayQueryHit& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.target < b.target;
}

}  // namespace

/// Calls visit(hit) with every hit up to the limit; it returns the limit from then on, which may be
/// smaller.
template <class Visit>
void QueryScene::rays(const RayQuery& query, const QueryFilter& filter, const Visit& visit) const {
  const FilterTest test(filter);
  const Ray ray{query.origin, unit_or_zero(query.direction)};
  double limit = query.max_distance;
  const auto found = [&](const RayHit& hit, const QueryTarget& target, const Vec3& normal) {
    if (hit.t == 0 && !query.hit_inside) return;
    limit = visit(RayQueryHit{target, hit.t, ray.at(hit.t), normal, hit.feature});
  };
  tree_.along(ray, Vec3::Zero(), limit, [&](uint32_t i) {
    const Placed& p = placed_[i];
    if (!test.takes(p.target, p.type)) return limit;
    const auto hit = p.shape->ray_cast(p.pose.inverse_point(ray.origin),
                                       p.pose.inverse_direction(ray.direction), limit);
    if (hit) found(*hit, p.target, p.pose.direction(hit->normal));
    return limit;
  });
  if (!filter.particles || !(limit >= 0)) return;
  balls().tree.along(ray, Vec3::Zero(), limit, [&](uint32_t i) {
    const QueryTarget& target = balls().targets[i];
    const Ball b = ball(target);
    const auto hit = ray_sphere(ray, b.x, b.radius, limit);
    if (hit && test.takes(target)) found(*hit, target, hit->normal);
    return limit;
  });
}

Result<std::optional<RayQueryHit>> QueryScene::ray(const RayQuery& query,
                                                   const QueryFilter& filter) const {
  if (Status s = check_ray(query); !s) return s.error();
  std::optional<RayQueryHit> best;
  rays(query, filter, [&](const RayQueryHit& hit) {
    if (!best || nearer(hit, *best)) best = hit;
    return best->distance;
  });
  return best;
}

Result<std::vector<RayQueryHit>> QueryScene::ray_all(const RayQuery& query,
                                                     const QueryFilter& filter) const {
  if (Status s = check_ray(query); !s) return s.error();
  std::vector<RayQueryHit> hits;
  rays(query, filter, [&](const RayQueryHit& hit) {
    hits.push_back(hit);
    return query.max_distance;
  });
  std::sort(hits.begin(), hits.end(), nearer);
  return hits;
}

Result<bool> QueryScene::ray_any(const RayQuery& query, const QueryFilter& filter) const {
  if (Status s = check_ray(query); !s) return s.error();
  bool any = false;
  rays(query, filter, [&](const RayQueryHit&) {
    any = true;
    return -1.0;
  });
  return any;
}

}  // namespace tumble
