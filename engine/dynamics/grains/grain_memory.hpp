#pragma once
#include "engine/core/chunks.hpp"
#include "engine/dynamics/grains/grain_pairs.hpp"
#include "engine/dynamics/grains/grain_touch.hpp"

#include <array>
#include <vector>

namespace tumble {

/// Forces of contacts that are remembered from part to part and tick to tick.
class GrainMemory {
 public:
  /// Before a part: finds the remembered forces of its pairs, and sets the impulses of rows with
  /// bodies for sub-steps of hs seconds. Of remembered contacts that are not among these, those
  /// between sleeping grains are kept; the others are lost, and sleeping grains that leaned on one
  /// must wake.
  void recall(const GrainTick& tick, const GrainField& grains, const GrainTouches& touches,
              const GrainPairList& pairs, std::span<GrainBodyRow> walls,
              std::span<GrainBodyRow> held, double hs);
  /// By pair: as recalled; to be overwritten with the new forces before store().
  std::span<GrainForces> forces() { return forces_; }
  std::span<const GrainForces> forces() const { return forces_; }
  /// Places of grains that have lost a contact.
  std::span<const uint32_t> lost() const { return lost_; }
  /// After a part: stores the contacts that press.
  void store(const GrainTick& tick, const GrainField& grains, const GrainPairList& pairs,
             std::span<const GrainBodyRow> walls, std::span<const GrainBodyRow> held, double hs,
             GrainTouches& touches);

 private:
  struct Span {
    uint32_t begin = 0, end = 0;
  };
  void find_own(const GrainTick& tick, const GrainField& grains,
                std::span<const GrainTouch> touches);
  void recall_pairs(const GrainTick& tick, const GrainField& grains,
                    std::span<const GrainTouch> touches, const GrainPairList& pairs);
  void recall_row(std::span<const GrainTouch> touches, double hs, GrainBodyRow& row);
  /// A contact that is not among the pairs of the part.
  struct Beside {
    uint32_t place;  ///< place of its grain `a`
    GrainTouch touch;
  };
  static bool in_order(const Beside& u, const Beside& v);
  /// What becomes of remembered contacts that are not among those of the part.
  struct Left {
    std::vector<Beside> kept;
    std::vector<uint32_t> lost;
  };
  static void sort_out(const GrainTick& tick, const GrainField& grains, const GrainTouch& touch,
                       Left& left);
  /// Lists contacts of the places [first, last) with bodies that press, and those that are kept, in
  /// the order in which they are stored.
  void list_beside(const GrainField& grains, std::span<const GrainBodyRow> walls,
                   std::span<const GrainBodyRow> held, double hs, size_t first, size_t last,
                   std::vector<Beside>& out) const;
  /// Calls f(touch) for all contacts of the places [first, last) that are to be stored, in order.
  template <class F>
  void each_of(const GrainField& grains, const GrainPairList& pairs, std::span<const Beside> listed,
               size_t first, size_t last, const F& f) const;

  std::vector<Span> own_;            ///< by place: range of touches with that grain as `a`
  std::vector<GrainForces> forces_;  ///< by pair
  std::vector<uint8_t> taken_;       ///< by touch: belongs to a pair or row of the part
  std::vector<Beside> kept_;
  std::array<std::vector<Beside>, chunk_count> beside_;  ///< by chunk of places
  std::vector<GrainTouch> next_;
  std::vector<uint32_t> lost_;
};

}  // namespace tumble
