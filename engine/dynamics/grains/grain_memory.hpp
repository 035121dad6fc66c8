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
  /// After it: what presses, in the order of keys.
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
  /// What becomes of a contact that the part does not have.
  struct Left {
    std::vector<GrainTouch> kept;
    std::vector<uint32_t> lost;
  };
  static void sort_out(const GrainTick& tick, const GrainField& grains, const GrainTouch& touch,
                       Left& left);

  std::vector<Span> own_;            ///< by place: touches of which the grain is the first
  std::vector<GrainForces> forces_;  ///< by pair
  std::vector<uint8_t> taken_;       ///< by touch
  std::vector<uint32_t> begins_;     ///< by ordinal: where its touches begin; then the end
  std::vector<GrainTouch> kept_, beside_, next_;
  std::vector<uint32_t> lost_;
};

}  // namespace tumble
