#pragma once
#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"

#include <span>

namespace tumble {

/// Neighbour lists of the particles of a liquid: pairs within `reach` spacings.
class LiquidNeighbours {
 public:
  static constexpr double reach = 2;

  /// `x` are positions [m], which must outlive this object unchanged; `spacing` is that of
  /// particles at rest [m].
  LiquidNeighbours(std::span<const Vec3> x, double spacing) : x_(x), spacing_(spacing) {
    known_ = spacing > 0 && lists_.update(x, {.reach = reach * spacing}, nullptr).ok();
  }
  /// False if a position is not finite or there are no particles.
  bool known() const { return known_ && !x_.empty(); }
  double spacing() const { return spacing_; }
  std::span<const Vec3> x() const { return x_; }
  size_t size() const { return x_.size(); }
  /// The particle at a rank of a spatial order, in which near particles are near in memory.
  uint32_t particle(size_t place) const { return lists_.order()[place]; }
  uint32_t count(size_t place) const { return lists_.count(place); }

  /// Calls f(j, distance / reach) for the neighbours of the particle at a rank, except those at
  /// exactly the same position.
  template <class F>
  void over(size_t place, const F& f) const {
    const Vec3& x = x_[particle(place)];
    for (const uint32_t other : lists_.of(place).first(lists_.count(place))) {
      const uint32_t j = particle(other);
      const double u = (x - x_[j]).norm() / (reach * spacing_);
      if (u < 1 && u > 0) f(j, u);
    }
  }

 private:
  std::span<const Vec3> x_;
  double spacing_;
  NeighbourLists lists_;
  bool known_ = false;
};

}  // namespace tumble
