#pragma once
#include "engine/collision/manifold.hpp"

#include <new>
#include <span>
#include <type_traits>

namespace tumble {

/// Collects candidate points of one manifold without allocating, and reduces them to four.
class ManifoldBuilder {
 public:
  static constexpr int capacity = 128;

  ManifoldBuilder() {}
  ManifoldBuilder(const ManifoldBuilder&) = delete;
  ManifoldBuilder& operator=(const ManifoldBuilder&) = delete;

  void add(const Vec3& x, double gap, uint64_t feature) {
    if (count_ < capacity) ::new (&points_[count_++]) ManifoldPoint{x, gap, feature};
  }
  int count() const { return count_; }
  std::span<ManifoldPoint> points() { return {points_, size_t(count_)}; }

  /// Fills `out` from the candidates; `normal` is unit. See reduce_points for `kept`.
  void finish(const Vec3& normal, uint64_t part, std::span<const uint64_t> kept,
              Manifold& out) const;

 private:
  static_assert(std::is_trivially_destructible_v<ManifoldPoint>);
  union {  // uninitialised: clearing it would take longer than finding the contacts
    ManifoldPoint points_[capacity];
  };
  int count_ = 0;
};

/// Fills `out` with at most four of the points: the deepest, the one farthest from it, and the two
/// that span the largest areas on either side of the line through these. The weight of a point
/// decreases with its gap: outermost points that are far from touching will not carry load next,
/// and without the lowest points a body rocks on the others. A point replaces one whose feature is
/// among `kept` only if it is clearly better, so that the choice persists from tick to tick, and
/// with it the impulses stored with the points.
void reduce_points(std::span<const ManifoldPoint> points, const Vec3& normal,
                   std::span<const uint64_t> kept, Manifold& out);

}  // namespace tumble
