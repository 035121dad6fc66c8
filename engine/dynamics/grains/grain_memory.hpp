#pragma once
#include "engine/dynamics/grains/grain_pairs.hpp"
#include "engine/dynamics/grains/grain_touch.hpp"

#include <vector>

namespace tumble {

/// What contacts remember from part to part and tick to tick.
class GrainMemory {
 public:
  /// Before a part: finds the forces of its pairs, puts those of rows with bodies into them, for
  /// sub-steps of hs seconds, and tells apart what is left: contacts of grains that sleep stay,
  /// grains that sleep wake where they leaned on what is gone.
  void recall(const GrainTick& tick, const GrainField& grains, const GrainTouches& touches,
              const GrainPairList& pairs, std::span<GrainBodyRow> walls,
              std::span<GrainBodyRow> held, double hs);
  /// Of each pair: as recalled, and to be put in their place before they are stored.
  std::span<GrainForces> forces() { return forces_; }
  std::span<const GrainForces> forces() const { return forces_; }
  /// Grains whose hold has gone, by place.
  std::span<const uint32_t> lost() const { return lost_; }
  /// After it: what presses.
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
  /// A contact that is none of a pair of the part.
  struct Beside {
    uint32_t place;  ///< of its grain `a`
    GrainTouch touch;
  };
  /// What becomes of contacts that the part does not have.
  struct Left {
    std::vector<Beside> kept;
    std::vector<uint32_t> lost;
  };
  static void sort_out(const GrainTick& tick, const GrainField& grains, const GrainTouch& touch,
                       Left& left);
  void list_beside(const GrainField& grains, std::span<const GrainBodyRow> walls,
                   std::span<const GrainBodyRow> held, double hs);
  /// Calls f(touch) for all of the places [first, last) that are to be stored, in their order.
  template <class F>
  void each_of(const GrainField& grains, const GrainPairList& pairs, size_t first, size_t last,
               const F& f) const;

  std::vector<Span> own_;            ///< by place: touches of which the grain is the first
  std::vector<GrainForces> forces_;  ///< by pair
  std::vector<uint8_t> taken_;       ///< by touch
  std::vector<Beside> kept_, beside_;
  std::vector<GrainTouch> next_;
  std::vector<uint32_t> lost_;
};

}  // namespace tumble
