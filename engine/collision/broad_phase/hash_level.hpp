#pragma once
#include "engine/collision/broad_phase/large_bounds.hpp"

#include <array>

namespace tumble {

/// Size that determines the cell of bounds [m]: their largest extent, plus an allowance for the
/// rounding of cell numbers far from the origin.
double grid_size(const Aabb& bounds);

/// One level of a hash grid (Coutinho §2.4.1): every member is entered once, into the cell of its
/// lower corner. As no member is larger than a cell, everything that it can overlap is entered at
/// most one cell away along each axis.
///
/// Cell (x, y, z) has the slot x + A y + B z modulo a power of two. Where the table can hold all
/// cells, A and B make slots unique; otherwise cells share slots, which costs comparisons, but no
/// pair is lost or found twice, because the slots of cells up to two apart along each axis differ.
/// Rows along x are contiguous in memory, and neighbouring rows are the same distance apart
/// everywhere.
class HashLevel {
 public:
  /// Enters the members. can_be_placed() must hold for each, and no grid_size() may exceed `edge`.
  /// Bounds are packed relative to `origin`.
  void build(std::span<const BroadPhaseProxy> proxies, std::span<const uint32_t> members,
             double edge, const Vec3& origin, Crew* crew = nullptr);
  /// Every pair of two members.
  void pairs_within(PairCollector& out, Crew* crew = nullptr) const;
  /// Every pair of a member with these bounds, which are not a member and may be larger than a
  /// cell.
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
  Cell low_{}, high_{};  ///< range of the cells of the members
  bool unique_ = true;   ///< no two cells between low and high share a slot
  int64_t stride_y_ = 5, stride_z_ = 25, mask_ = 127;
  std::vector<uint32_t> starts_;  ///< by slot, first member; one more at the end
  std::vector<uint32_t> slots_;   ///< by member as given: its slot, then its position in the set
  PackedSet set_;
};

}  // namespace tumble
