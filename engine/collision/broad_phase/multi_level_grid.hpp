#pragma once
#include "engine/collision/broad_phase/few_moving.hpp"
#include "engine/collision/broad_phase/hash_level.hpp"
#include "engine/collision/broad_phase/large_bounds.hpp"
#include "engine/collision/broad_phase/packed_tree.hpp"

namespace tumble {

/// Hash grids of several cell sizes (Coutinho §2.4.2): bounds are entered in the level of their
/// size, whose cell is at most twice as large, and are compared there and with the levels of larger
/// cells, so that the work does not grow with the ratio of sizes. A level of few bounds is merged
/// into the next coarser one; few coarse bounds, and infinite ones, are compared one by one.
///
/// With so many sizes that most lookups in coarser levels would find nothing, the nested cells are
/// used as a tree instead: the occupied cells, sorted along the Morton curve through them, form a
/// tree, and its traversal skips empty space.
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
  /// Whether members would look into more than one coarser level on average.
  bool many_lookups() const;
  void compare_nested(std::span<const BroadPhaseProxy> proxies);
  void build_levels(std::span<const BroadPhaseProxy> proxies);
  void compare_levels(std::span<const BroadPhaseProxy> proxies);

  /// Bounds whose sizes are within a factor of two; octave 0 has the largest.
  struct Octave {
    std::vector<uint32_t> members;
    double edge = 0;  ///< size of the largest [m]
  };
  std::vector<double> sizes_;
  std::vector<uint8_t> octave_of_;
  std::array<Octave, octaves> octaves_;
  std::vector<HashLevel> levels_;  ///< from coarse to fine; the first level_count_ are in use
  size_t level_count_ = 0;
  PackedTree nested_;  ///< over all levels, where they are many
  std::vector<uint32_t> nested_ids_;
  LargeBounds large_;
  PairCollector collector_;
  FewMoving few_moving_;
  Vec3 origin_ = Vec3::Zero();
};

}  // namespace tumble
