#include "engine/collision/shape_near.hpp"
#include "engine/world/queries/checks.hpp"
#include "engine/world/queries/filter_test.hpp"
#include "engine/world/queries/query_scene.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// The `count` nearest hits so far, nearest first.
class BestNear {
 public:
  BestNear(size_t count, double reach) : count_(count), reach_(reach) {}

  void add(const NearHit& hit) {
    const auto better = [](const NearHit& a, const NearHit& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.target < b.target;
    };
    hits_.insert(std::upper_bound(hits_.begin(), hits_.end(), hit, better), hit);
    if (hits_.size() > count_) hits_.pop_back();
  }
  /// Distance up to which others can still be among them: at least 0, since a shape that contains
  /// the point may be deeper than any found.
  double reach() const {
    return hits_.size() < count_ ? reach_ : std::clamp(hits_.back().distance, 0.0, reach_);
  }
  std::vector<NearHit> take() { return std::move(hits_); }

 private:
  size_t count_;
  double reach_;
  std::vector<NearHit> hits_;
};

}  // namespace

Result<std::vector<NearHit>> QueryScene::nearest(const Vec3& x, size_t count, double max_distance,
                                                 const QueryFilter& filter) const {
  if (Status s = require_finite("point", x); !s) return s.error();
  if (Status s = require_distance(max_distance); !s) return s.error();
  if (count == 0) return std::vector<NearHit>{};
  const FilterTest test(filter);
  BestNear best(count, max_distance);
  tree_.around(x, max_distance, [&](uint32_t i) {
    const Placed& p = placed_[i];
    if (!test.takes(p.target, p.type)) return best.reach();
    const auto near = near_shape(*p.shape, p.pose, x, best.reach());
    if (near) best.add({p.target, near->distance, near->x_world, near->normal, near->triangle});
    return best.reach();
  });
  if (!filter.particles) return best.take();
  balls().tree.around(x, best.reach(), [&](uint32_t i) {
    const QueryTarget& target = balls().targets[i];
    const Ball b = ball(target);
    const Vec3 out = x - b.x;
    const double length = out.norm(), distance = length - b.radius;
    if (distance > best.reach() || !test.takes(target)) return best.reach();
    const Vec3 normal = length > 0 ? Vec3(out / length) : Vec3(Vec3::UnitY());
    best.add({target, distance, b.x + b.radius * normal, normal, 0});
    return best.reach();
  });
  return best.take();
}

}  // namespace tumble
