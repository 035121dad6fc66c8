#pragma once
#include "engine/collision/broad_phase.hpp"

#include <array>

namespace tumble {

/// Bounds are entered into the cells of one grid, whose cell is about twice the median size, and
/// compared within each cell (Coutinho §2.4.1). Bounds that would fill many cells, infinite ones
/// among them, are kept in a list of their own and compared with everything. The grid is a sorted
/// list of (cell, proxy), so that it costs memory only where something is.
class UniformGridBroadPhase final : public BroadPhase {
 public:
  void find_pairs(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs) override;

 private:
  struct Entry {
    uint64_t cell;
    uint32_t proxy;
  };
  using Cell = std::array<int32_t, 3>;

  void choose_cell_size(std::span<const BroadPhaseProxy> proxies);
  void enter(std::span<const BroadPhaseProxy> proxies);
  void compare_cells(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs);
  void compare_large(std::span<const BroadPhaseProxy> proxies, std::vector<ProxyPair>& pairs);
  Cell cell_of(const Vec3& x) const;
  static uint64_t pack(const Cell& c);

  double cell_ = 1;  ///< edge of a cell [m]
  std::vector<Entry> entries_;
  std::vector<uint32_t> large_;
  std::vector<uint8_t> is_large_;
  std::vector<double> sizes_;
};

}  // namespace tumble
