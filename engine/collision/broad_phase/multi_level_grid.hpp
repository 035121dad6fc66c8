#pragma once
#include "engine/collision/broad_phase/few_moving.hpp"
#include "engine/collision/broad_phase/hash_level.hpp"
#include "engine/collision/broad_phase/large_bounds.hpp"
#include "engine/collision/broad_phase/packed_tree.hpp"

namespace tumble {

/// Hash grids of several cell sizes (Coutinho §2.4.2): bounds go to the level of their size, where
/// the cell is at most twice as large, and are compared there and with the levels of larger cells,
/// so that work does not grow with the ratio of sizes. Levels of few bounds join the next coarser
/// one; few coarse ones, and infinite ones, are compared one by one.
///
/// Where sizes are so many that most lookups in coarser levels would find nothing, the levels are
/// taken as what they are, cells nested in cells: the occupied ones, in the order of the Morton
/// curve through them, are a tree, and walking it skips whatever is empty.
class MultiLevelGridBroadPhase final : public BroadPhase {
 public:
  static constexpr size_t octaves = 64;

  void find_pairs(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs) override;
  void find_pairs(std::span<const BroadPhaseProxy> proxies, const ProxyNews& news,
                  std::vector<ProxyPair>& pairs) override;
  void draw(std::span<const BroadPhaseProxy> proxies, DebugDraw& out) const override;

 private:
  void sort_by_size(std::span<const BroadPhaseProxy> proxies);
  void join_octaves(std::span<const BroadPhaseProxy> proxies);
  /// Whether members would look into more than one coarser level on the average.
  bool many_lookups() const;
  void compare_nested(std::span<const BroadPhaseProxy> proxies);
  void build_levels(std::span<const BroadPhaseProxy> proxies);
  void compare_levels(std::span<const BroadPhaseProxy> proxies);

  /// Bounds of one factor of two in size, octave 0 the largest.
  struct Octave {
    std::vector<uint32_t> members;
    double edge = 0;  ///< size of the largest [m]
  };
  std::vector<double> sizes_;
  std::vector<uint8_t> octave_of_;
  std::array<Octave, octaves> octaves_;
  std::vector<HashLevel> levels_;  ///< from coarse to fine; the first level_count_ are in use
  size_t level_count_ = 0;
  PackedTree nested_;  ///< of all levels, where they are many
  std::vector<uint32_t> nested_ids_;
  LargeBounds large_;
  PairCollector collector_;
  FewMoving few_moving_;
  Vec3 origin_ = Vec3::Zero();
};

}  // namespace tumble
