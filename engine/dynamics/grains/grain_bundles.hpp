#pragma once
#include "engine/dynamics/grains/grain_field.hpp"
#include "engine/dynamics/grains/grain_pairs.hpp"
#include "engine/dynamics/grains/grain_touch.hpp"

#include <array>
#include <vector>

namespace tumble {

constexpr size_t grain_lanes = 16;      ///< of every bundle, on every machine
constexpr uint32_t grain_block = 1024;  ///< grains of a block, consecutive along the curve

/// A number of each of the contacts of a bundle.
struct alignas(64) GrainFloats {
  std::array<float, grain_lanes> v{};
  float& operator[](size_t lane) { return v[lane]; }
  float operator[](size_t lane) const { return v[lane]; }
};

/// Sixteen contacts of two grains each, no two of which share a grain that moves. Impulses are on
/// b, of the present sub-step: kept in single precision, which is all that the next sub-step's
/// start needs of them; what acts on the grains is worked out and applied in double. Lanes without
/// a contact have the first lane's `a` on both sides, which nothing then moves.
struct alignas(64) GrainBundle {
  std::array<uint32_t, grain_lanes> a{}, b{};          ///< places of the grains
  std::array<std::array<double, grain_lanes>, 3> way;  ///< from centre to centre [m]
  GrainFloats gap;                                     ///< negative where they overlap [m]
  GrainFloats share;               ///< of the way that is a's: where along it the contact is [-]
  GrainFloats friction;            ///< [-]
  GrainFloats push;                ///< normal impulse [N s]
  std::array<GrainFloats, 3> rub;  ///< friction [N s]
  uint32_t lanes = 0;              ///< contacts in it, the first lanes
  uint16_t writes_a = 0, writes_b = 0;  ///< bit k: the grain of lane k is awake
  bool bounces = false;                 ///< some lane has a restitution speed
};
static_assert(sizeof(GrainBundle) == grain_lanes * 64);

/// What contacts that resist turning have besides.
struct GrainTurning {
  GrainFloats rolling, twisting;    ///< lever arms of torques [m]
  std::array<GrainFloats, 3> turn;  ///< torque times time [N m s]
};

/// What those have that part faster than they met.
struct GrainBounce {
  std::array<double, grain_lanes> speed{};  ///< at which they part if they press at all [m/s]
  GrainFloats most;                         ///< greatest push of the part [N s]
};

/// Bundles [begin, end).
struct GrainRange {
  uint32_t begin = 0, end = 0;
};

/// All contacts of two grains in bundles. Those inside of a block come block by block, and the
/// bundles of a block one colour after the other: a thread works through a block's in turn, and
/// blocks share nothing. Those between blocks follow, colour by colour; bundles of a colour share
/// nothing. What finds no colour among 64 has a bundle, and between blocks a colour, of its own.
class GrainBundles {
 public:
  /// Decides what goes where; greedy colours in the order of the pairs. Pure function of the pairs
  /// and of who is awake.
  void lay_out(const GrainPairList& pairs, const GrainField& grains, Crew* crew);
  /// Contacts, and the forces that they begin with, by pair; `hs` is the sub-step [s].
  void fill(const GrainTick& tick, const GrainPairList& pairs, const GrainField& grains,
            std::span<const GrainForces> forces, double hs);
  /// Their forces in the last sub-step; gives the greatest overlap [m].
  double read(std::span<GrainForces> forces, double hs, Crew* crew) const;

  std::vector<GrainBundle>& all() { return bundles_; }
  std::span<const GrainBundle> all() const { return bundles_; }
  std::vector<GrainTurning>& turnings() { return turnings_; }  ///< by bundle, or empty
  std::vector<GrainBounce>& bounces() { return bounces_; }     ///< by bundle, or empty
  size_t blocks() const { return blocks_.size(); }
  GrainRange block(size_t k) const { return blocks_[k]; }
  std::span<const GrainRange> between() const { return between_; }  ///< by colour

 private:
  static constexpr uint32_t colours = 64;
  static constexpr uint8_t crosses = 255;  ///< in place of a colour: between blocks
  struct Counts {
    std::array<uint32_t, colours + 1> of{};  ///< pairs by colour; the last have none
    uint32_t bundles() const;
  };
  /// Gives out slots of consecutive bundles, colour by colour.
  class Slots {
   public:
    Slots(const Counts& counts, uint32_t first_bundle);
    uint32_t take(uint32_t colour);
    uint32_t first_of(uint32_t colour) const { return begin_[colour]; }

   private:
    std::array<uint32_t, colours + 2> begin_{};  ///< bundles
    std::array<uint32_t, colours + 1> taken_{};
  };
  void colour_block(const GrainPairList& pairs, const GrainField& grains, size_t block);
  void colour_between(const GrainPairList& pairs, const GrainField& grains);
  void fill_bundle(const GrainTick& tick, const GrainPairList& pairs, const GrainField& grains,
                   std::span<const GrainForces> forces, double hs, size_t k);
  void fill_lane(const GrainTick& tick, const GrainField& grains, size_t k, size_t lane);
  float read_bundle(std::span<GrainForces> forces, double hs, size_t k) const;

  std::vector<GrainBundle> bundles_;
  std::vector<GrainTurning> turnings_;
  std::vector<GrainBounce> bounces_;
  std::vector<GrainRange> blocks_, between_;
  std::vector<uint32_t> slot_;    ///< by pair: its bundle times grain_lanes and its lane
  std::vector<uint32_t> source_;  ///< by slot: its pair, or GrainPairList::none
  std::vector<uint8_t> colour_;   ///< by pair
  std::vector<Counts> counts_;    ///< by block
  std::vector<uint32_t> crossing_;
  std::vector<uint64_t> used_;  ///< by grain: colours that it has
};

}  // namespace tumble
