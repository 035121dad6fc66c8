#include "engine/collision/field_pairs/convex_in_field.hpp"

#include "engine/collision/feature_key.hpp"
#include "engine/collision/query.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

SurfacePoint nearest_of(const ConvexShape& shape, const Vec3& p) {
  if (const auto exact = shape.nearest(p)) return *exact;
  const auto near = closest_point(shape, Pose{}, p);
  return near ? SurfacePoint{near->x_world, near->normal, near->distance} : SurfacePoint{};
}

namespace {

/// Search for the contacts of one convex shape and one field.
class RoundSearch {
 public:
  RoundSearch(const ConvexShape& shape, const Pose& pose, const DistanceField& field, double margin,
              std::vector<FeatureContact>& out)
      : shape_(shape),
        pose_(pose),
        R_(pose.q.toRotationMatrix()),
        field_(field),
        margin_(margin),
        size_(std::max(shape.inner_radius(), tolerances::arrived * shape.bounding_radius())),
        tolerance_(tolerances::deepest * field.cell()),
        out_(out) {}

  double run() {
    minima().clear();
    const FieldPoint middle = at(pose_.x);
    const double least = middle.least_within(shape_.bounding_radius());
    if (least > margin_) return least;
    floor_ = middle.distance - shape_.bounding_radius();
    descend(middle);  // of a ball outside the field already the deepest point, but for its error
    const Aabb box = shape_.bounds(pose_);
    const double half = 0.5 * box.extent().maxCoeff();
    start_half_ = std::min(half, std::max({tolerances::start_of_radius * size_,
                                           tolerances::least_start * field_.cell(),
                                           half / tolerances::most_starts_along}));
    cube(box.centre(), half);
    for (const FieldPoint& m : minima()) put_out(m);
    return apart_;
  }

 private:
  static std::vector<FieldPoint>& minima() {
    thread_local std::vector<FieldPoint> list;
    return list;
  }
  Vec3 local(const Vec3& x) const { return R_.transpose() * (x - pose_.x); }
  Vec3 placed(const Vec3& p) const { return pose_.x + R_ * p; }
  FieldPoint at(const Vec3& x) const { return field_point(field_, x); }

  /// The part of the solid in a cube lies in a ball about the solid's point nearest to the cube's
  /// centre.
  void cube(const Vec3& centre, double half) {
    const double corner = std::sqrt(3.0) * half;
    const SurfacePoint near = nearest_of(shape_, local(centre));
    if (near.distance > corner) return;
    const double away = std::max(near.distance, 0.0);
    const double reach = std::sqrt(corner * corner - away * away);
    const FieldPoint p = at(away > 0 ? placed(near.x) : centre);
    if (const double least = p.least_within(reach); least > margin_) {
      apart_ = std::min(apart_, least);
      return;
    }
    apart_ = std::min(apart_, margin_);
    if (half <= start_half_) {
      if (2 * half > start_half_ || p.distance < deepest_) descend(p);
      const double wanted = std::min(margin_, deepest_ - tolerance_);
      if (reach < tolerance_ || wanted < floor_ || none_below(wanted, p, reach)) return;
    }
    for (int k = 0; k < 8; ++k)
      cube(centre + 0.5 * half * Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1), 0.5 * half);
  }

  /// Whether no point of the solid within `reach` of p is deeper than `depth`. From p itself the
  /// distance decreases by `reach` at most. From the point `up` above p, where the distance is `up`
  /// greater, it decreases by the distance to that point: the solid's points are at most `under`
  /// below p, so that they lie in the ball of radius sqrt(up^2 + 2 up under + reach^2) about that
  /// point.
  bool none_below(double depth, const FieldPoint& p, double reach) const {
    if (p.distance - reach > depth) return true;
    if (!p.has_direction()) return false;
    const Vec3 n = p.normal();
    const double under = n.dot(p.x - farthest(n));
    if (p.distance - under < depth) return false;
    const double up = std::clamp(field_.band() - p.distance, 0.0, 4 * reach);
    const double ball = std::sqrt(up * (up + 2 * under) + reach * reach);
    return field_.value(p.x + up * n) - ball > depth;
  }

  /// The support point of the solid along -n.
  Vec3 farthest(const Vec3& n) const {
    const Vec3 down = -(R_.transpose() * n);
    return placed(shape_.support(down) + shape_.rounding() * down);
  }

  bool is_known(const Vec3& x) const {
    const double near = tolerances::same_place * size_;
    return std::ranges::any_of(
        minima(), [&](const FieldPoint& m) { return (m.x - x).squaredNorm() < near * near; });
  }

  /// Descends to a local minimum, unless that is known already.
  void descend(FieldPoint p) {
    if (!p.has_direction()) return;
    const double arrived = tolerances::arrived * size_;
    double step = std::numeric_limits<double>::infinity();
    for (int i = 0; i < tolerances::most_descents; ++i) {
      const Vec3 n = p.normal();
      const Vec3 to = std::isinf(step) ? farthest(n) : nearest_in(p.x - step * n);
      if (is_known(to)) return;
      if ((to - p.x).norm() <= arrived) break;
      const FieldPoint next = at(to);
      if (next.distance < p.distance && next.has_direction()) {
        p = next;
      } else {
        step = tolerances::shorter_step *
               (std::isinf(step) ? shape_.bounding_radius() / tolerances::shorter_step : step);
        if (step < arrived) break;
      }
    }
    if (p.distance > margin_ || is_known(p.x)) return;
    deepest_ = std::min(deepest_, p.distance);
    minima().push_back(p);
  }

  Vec3 nearest_in(const Vec3& x) const {
    const SurfacePoint near = nearest_of(shape_, local(x));
    return near.distance > 0 ? placed(near.x) : x;
  }

  void add(const FieldPoint& p, FeaturePair kind, uint64_t id) {
    const Vec3 n = p.normal();
    out_.push_back({p.x - 0.5 * p.distance * n, n, p.distance, feature_key(kind, id, 0)});
  }

  /// Adds the corners of the face that lies on the field there, and the minimum itself if it is
  /// lower than all of them.
  void put_out(const FieldPoint& m) {
    const Vec3 n = m.normal();
    SupportingFace face;
    shape_.supporting_face(-(R_.transpose() * n), face);
    double least = std::numeric_limits<double>::infinity();
    if (face.count > 1)
      for (int i = 0; i < face.count; ++i) {
        const FieldPoint p = at(placed(face.points[size_t(i)]) - shape_.rounding() * n);
        if (p.distance > margin_ || !p.has_direction()) continue;
        least = std::min(least, p.distance);
        add(p, FeaturePair::vertex_face, face.ids[size_t(i)]);
      }
    if (m.distance < least - tolerances::clearly_lower * field_.cell())
      add(m, FeaturePair::closest, uint64_t(&m - minima().data()));
  }

  const ConvexShape& shape_;
  const Pose& pose_;
  Mat3 R_;
  const DistanceField& field_;
  double margin_, size_, tolerance_;
  double start_half_ = 0;  ///< half side of the cubes in which descents start [m]
  /// Lower bound of the depth of any point, by the field at the solid's centre [m].
  double floor_ = 0;
  double deepest_ = std::numeric_limits<double>::infinity();  ///< of the minima found [m]
  std::vector<FeatureContact>& out_;
  double apart_ = std::numeric_limits<double>::infinity();
};

}  // namespace

double convex_in_field(const ConvexShape& shape, const Pose& pose, const DistanceField& field,
                       double margin, std::vector<FeatureContact>& contacts) {
  return RoundSearch(shape, pose, field, margin, contacts).run();
}

}  // namespace tumble
