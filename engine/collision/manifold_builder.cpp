#include "engine/collision/manifold_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// A later point replaces an earlier one only if it is better by this factor.
constexpr double clearly = 1.02;

/// Factor for points that were kept so far.
constexpr double kept_bonus = 1.2;

/// Points count as equally deep up to this share of the extent of all points, and a point that was
/// kept so far up to `nearly_deep`: the first of them is chosen, so that bodies that lie flat keep
/// their points.
constexpr double equally_deep = 1e-4, nearly_deep = 1e-3;

/// Gap at which a point has half weight, in extents of all points.
constexpr double near_share = 0.01;

/// The candidates of one manifold, and their weights.
class Candidates {
 public:
  Candidates(std::span<const ManifoldPoint> points, std::span<const uint64_t> kept)
      : points_(points), kept_(kept) {
    double reach2 = 0;
    for (const ManifoldPoint& p : points)
      reach2 = std::max(reach2, (p.x_world - points[0].x_world).squaredNorm());
    reach_ = std::sqrt(reach2);
    if (reach_ > 0) fading_ = 1 / (near_share * reach_);
    for (size_t i = 0; i < std::min(points.size(), noted); ++i) {
      if (!kept.empty()) kept_first_ |= uint64_t{look_up(i)} << i;
      weights_[i] = weigh(i);
    }
  }

  /// The deepest point; one that was kept so far stays if it is nearly as deep.
  size_t deepest() const {
    const double equal = equally_deep * reach_, nearly = nearly_deep * reach_;
    const auto key = [&](size_t i) { return points_[i].gap - (is_kept(i) ? nearly : 0); };
    size_t best = 0;
    double least = key(0);
    for (size_t i = 1; i < points_.size(); ++i)
      if (const double k = key(i); k < least - equal) least = k, best = i;
    return best;
  }

  /// The farthest from one of them, among those no less deep than `gap`.
  size_t farthest_from(size_t from, double gap) const {
    size_t best = from;
    double far2 = 0;
    for (size_t i = 0; i < points_.size(); ++i) {
      if (points_[i].gap > gap) continue;
      const double w = weight(i);
      const double d2 = w * w * (points_[i].x_world - points_[from].x_world).squaredNorm();
      if (d2 > clearly * far2) far2 = d2, best = i;
    }
    return best;
  }

  /// Weight of a point.
  double weight(size_t i) const { return i < noted ? weights_[i] : weigh(i); }

  double reach() const { return reach_; }  ///< from the first to the farthest from it [m]

 private:
  static constexpr size_t noted = 64;

  double weigh(size_t i) const {
    const double bonus = is_kept(i) ? kept_bonus : 1;
    return fading_ == 0 ? bonus : bonus / (1 + fading_ * std::max(points_[i].gap, 0.0));
  }
  bool is_kept(size_t i) const { return i < noted ? kept_first_ >> i & 1 : look_up(i); }
  bool look_up(size_t i) const {
    bool found = false;
    for (const uint64_t k : kept_) found |= k == points_[i].feature;
    return found;
  }

  std::span<const ManifoldPoint> points_;
  std::span<const uint64_t> kept_;
  uint64_t kept_first_ = 0;  ///< bit i: point i is among those kept
  double reach_ = 0;
  double fading_ = 0;  ///< decrease of weight with the gap; 0 if all have equal weight [1/m]
  std::array<double, noted> weights_;
};

}  // namespace

void reduce_points(std::span<const ManifoldPoint> points, const Vec3& normal,
                   std::span<const uint64_t> kept, Manifold& out) {
  out.normal = normal;
  out.count = 0;
  if (points.size() <= 2) {
    for (const ManifoldPoint& p : points) out.points[size_t(out.count++)] = p;
    return;
  }
  const Candidates candidates(points, kept);
  size_t deepest = candidates.deepest();
  const size_t farthest =
      candidates.farthest_from(deepest, std::numeric_limits<double>::infinity());
  // Once more from the far end, so that equally deep points inside a line or face are replaced by
  // its ends.
  deepest =
      candidates.farthest_from(farthest, points[deepest].gap + equally_deep * candidates.reach());
  const Vec3 p0 = points[deepest].x_world;
  const double far2 = (points[farthest].x_world - p0).squaredNorm();
  out.points[size_t(out.count++)] = points[deepest];
  if (farthest == deepest) return;
  out.points[size_t(out.count++)] = points[farthest];

  const Vec3 across = normal.cross(points[farthest].x_world - p0);
  size_t left = deepest, right = deepest;
  double most_left = 1e-4 * far2, most_right = most_left;
  for (size_t i = 0; i < points.size(); ++i) {
    const double area = candidates.weight(i) * across.dot(points[i].x_world - p0);
    if (area > clearly * most_left) most_left = area, left = i;
    if (-area > clearly * most_right) most_right = -area, right = i;
  }
  if (left != deepest) out.points[size_t(out.count++)] = points[left];
  if (right != deepest) out.points[size_t(out.count++)] = points[right];
}

void ManifoldBuilder::finish(const Vec3& normal, uint64_t part, std::span<const uint64_t> kept,
                             Manifold& out) const {
  reduce_points({points_, size_t(count_)}, normal, kept, out);
  out.part = part;
}

}  // namespace tumble
