#pragma once
#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"

#include <span>

namespace tumble {

/// Which particles of a liquid are near each other: those within `reach` spacings.
class LiquidNeighbours {
 public:
  static constexpr double reach = 2;

  /// `x` are places [m], and stay where they are; `spacing` is that of particles at rest [m].
  LiquidNeighbours(std::span<const Vec3> x, double spacing) : x_(x), spacing_(spacing) {
    known_ = spacing > 0 && lists_.update(x, {.reach = reach * spacing}, nullptr).ok();
  }
  /// Not where a particle is nowhere, or there is none.
  bool known() const { return known_ && !x_.empty(); }
  double spacing() const { return spacing_; }
  std::span<const Vec3> x() const { return x_; }
  size_t size() const { return x_.size(); }
  /// By place, an order in which what is near is near in memory.
  uint32_t particle(size_t place) const { return lists_.order()[place]; }
  uint32_t count(size_t place) const { return lists_.count(place); }

  /// Calls f(j, distance over that of the farthest neighbours) for those of a particle that are not
  /// at its own place.
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
