#pragma once
#include "engine/collision/broad_phase/large_bounds.hpp"

#include <array>

namespace tumble {

/// What decides the cell that bounds need [m]: their largest extent, plus room for the rounding of
/// cell numbers far from the origin.
double grid_size(const Aabb& bounds);

/// One level of a hash grid (Coutinho §2.4.1): every member is entered once, into the cell of its
/// lower corner. As no member is larger than a cell, all that it can overlap is entered at most one
/// cell away along each axis.
///
/// Cell (x, y, z) has the slot x + A y + B z modulo a power of two. Where all cells fit, A and B
/// make slots unique; else cells share them, which costs comparisons but no pair is lost or found
/// twice, because slots of cells up to two apart along each axis differ. Rows along x lie together
/// in memory, and neighbouring rows at the same distance from everywhere.
class HashLevel {
 public:
  /// Enters the members; can_be_placed() must hold for each, and no grid_size() be above
  /// `edge`. Bounds are packed
  /// relative to `origin`.
  void build(std::span<const BroadPhaseProxy> proxies, std::span<const uint32_t> members,
             double edge, const Vec3& origin, Crew* crew = nullptr);
  /// Every pair of two members.
  void pairs_within(PairCollector& out, Crew* crew = nullptr) const;
  /// Every pair of one that is no member with a member. Bounds larger than a cell are allowed.
  void pairs_with(const Aabb& bounds, const PackedBounds& packed, uint32_t id,
                  PairCollector& out) const;
  /// The members in the order of their slots.
  const PackedSet& members() const { return set_; }
  double edge() const { return edge_; }

  using Cell = std::array<int64_t, 3>;
  Cell cell_of(const Vec3& x) const;

 private:
  struct Run {
    uint32_t first, last;
  };
  void choose_slots(size_t count);
  void pairs_of_slots(size_t first, size_t last, PairCollector& out) const;
  bool near_slots_differ() const;
  int64_t slot_of(const Cell& c) const {
    return ((c[0] - low_[0]) + (c[1] - low_[1]) * stride_y_ + (c[2] - low_[2]) * stride_z_) & mask_;
  }
  /// Calls f(first, last) with the members of `count` slots in a row from `slot` on.
  template <class F>
  void for_slots(int64_t slot, int64_t count, F&& f) const;

  double edge_ = 1, inverse_edge_ = 1;
  Cell low_{}, high_{};  ///< cells of the members
  bool unique_ = true;   ///< no two cells between low and high share a slot
  int64_t stride_y_ = 5, stride_z_ = 25, mask_ = 127;
  std::vector<uint32_t> starts_;  ///< by slot, and one more
  std::vector<uint32_t> slots_;   ///< by member as given; then its place in the set
  PackedSet set_;
};

}  // namespace tumble
