#pragma once
#include "engine/dynamics/grains/grain_field.hpp"
#include "engine/dynamics/grains/grain_pairs.hpp"
#include "engine/dynamics/grains/grain_touch.hpp"

#include <array>
#include <vector>

namespace tumble {

constexpr size_t grain_lanes = 16;  ///< lanes of every bundle, on every machine
/// Number of grains of a block, consecutive along the space-filling curve.
constexpr uint32_t grain_block = 1024;

/// One value of each of the contacts of a bundle.
struct alignas(64) GrainFloats {
  std::array<float, grain_lanes> v{};
  float& operator[](size_t lane) { return v[lane]; }
  float operator[](size_t lane) const { return v[lane]; }
};

/// Sixteen contacts of two grains each, no two of which share a movable grain. Impulses are on b,
/// of the present sub-step, and relative to the unit of mass. In lanes without a contact, both
/// sides are the first lane's `a`, which they do not move.
struct alignas(64) GrainBundle {
  std::array<uint32_t, grain_lanes> a{}, b{};  ///< places of the grains
  /// From the centre of a to that of b: at the beginning of the part; at the last sweep that
  /// followed the grains [m]
  std::array<GrainFloats, 3> from, way;
  GrainFloats reach;                    ///< sum of the radii [m]
  GrainFloats gap;                      ///< negative where they overlap [m]
  GrainFloats share;                    ///< position of the contact along `way`, from a [-]
  GrainFloats friction;                 ///< [-]
  GrainFloats push;                     ///< normal impulse [m/s]
  std::array<GrainFloats, 3> rub;       ///< friction impulse [m/s]
  uint32_t lanes = 0;                   ///< number of contacts, in the first lanes
  uint16_t writes_a = 0, writes_b = 0;  ///< bit k: the grain of lane k is awake
  bool bounces = false;                 ///< some lane has a restitution speed
};
static_assert(sizeof(GrainBundle) == 17 * 64);

/// What contacts with rolling or torsional friction have besides.
struct GrainTurning {
  GrainFloats rolling, twisting;    ///< lever arms of rolling and torsional friction [m]
  std::array<GrainFloats, 3> turn;  ///< angular impulse, relative to the unit of mass [m2/s]
};

/// What contacts with restitution have besides.
struct GrainBounce {
  GrainFloats speed;  ///< separation speed if they press at all [m/s]
  GrainFloats most;   ///< greatest normal impulse in the part [m/s]
};

/// Bundles [begin, end).
struct GrainRange {
  uint32_t begin = 0, end = 0;
};

/// All contacts of two grains in bundles. Contacts inside a block of grains come first, block by
/// block, and within a block colour by colour: one thread works through the bundles of a block in
/// order, and blocks share no grain. Contacts between blocks follow, colour by colour; bundles of a
/// colour share no grain. A contact for which none of 64 colours is free gets a bundle of its own,
/// and between blocks a colour of its own.
class GrainBundles {
 public:
  /// Assigns the contacts to bundles, by greedy colouring in the order of the pairs. Depends only
  /// on the pairs and on which grains are awake.
  void lay_out(const GrainPairList& pairs, const GrainField& grains, Crew* crew);
  /// Fills in contacts and their initial forces, by pair; `hs` is the sub-step [s].
  void fill(const GrainTick& tick, const GrainPairList& pairs, const GrainField& grains,
            std::span<GrainForces> forces, double hs);
  /// Reads the forces of the last sub-step; returns the greatest overlap [m].
  double read(const GrainField& grains, std::span<GrainForces> forces, double hs, Crew* crew);

  std::vector<GrainBundle>& all() { return bundles_; }
  std::span<const GrainBundle> all() const { return bundles_; }
  std::vector<GrainTurning>& turnings() { return turnings_; }  ///< by bundle, or empty
  std::vector<GrainBounce>& bounces() { return bounces_; }     ///< by bundle, or empty
  size_t blocks() const { return blocks_.size(); }
  GrainRange block(size_t k) const { return blocks_[k]; }
  std::span<const GrainRange> between() const { return between_; }  ///< by colour

 private:
  static constexpr uint32_t colours = 64;
  static constexpr uint8_t crosses = 255;  ///< stands for a colour: the contact is between blocks
  struct Counts {
    /// Number of pairs by colour; the last entry is of those without.
    std::array<uint32_t, colours + 1> of{};
    /// Number of pairs with grains of other blocks; then the sum of those of the blocks before.
    uint32_t crossing = 0;
    uint32_t bundles() const;
  };
  /// Assigns slots (lanes) of consecutive bundles, colour by colour.
  class Slots {
   public:
    Slots(const Counts& counts, uint32_t first_bundle);
    uint32_t take(uint32_t colour);
    uint32_t first_of(uint32_t colour) const { return begin_[colour]; }

   private:
    std::array<uint32_t, colours + 2> begin_{};  ///< first bundle by colour
    std::array<uint32_t, colours + 1> taken_{};
  };
  void colour_block(const GrainPairList& pairs, const GrainField& grains, size_t block);
  /// Assigns the pairs within a block to slots, and lists the others from `crossing` on.
  void fill_block(const GrainPairList& pairs, const GrainField& grains, size_t block,
                  uint32_t* crossing);
  void colour_between(const GrainPairList& pairs, const GrainField& grains);
  /// What contacts of grains of two systems have in common.
  struct PairMaterial {
    uint32_t a = ~uint32_t{0}, b = ~uint32_t{0};  ///< slots of the systems
    float friction = 0;                           ///< [-]
    double rolling = 0, twisting = 0;             ///< [-]
    double restitution = 0;                       ///< [-]
  };
  static PairMaterial material(const GrainTick& tick, uint32_t a, uint32_t b);
  /// `of`: material of the last contact that was filled in.
  void fill_bundle(const GrainTick& tick, const GrainPairList& pairs, const GrainField& grains,
                   std::span<GrainForces> forces, double hs, PairMaterial& of, size_t k);
  void fill_lane(const GrainTick& tick, const GrainField& grains, const PairMaterial& of, size_t k,
                 size_t lane);
  float read_bundle(std::span<GrainForces> forces, double unit, size_t k);

  std::vector<GrainBundle> bundles_;
  std::vector<GrainTurning> turnings_;
  std::vector<GrainBounce> bounces_;
  std::vector<GrainRange> blocks_, between_;
  std::vector<uint32_t> slot_;      ///< by pair: its bundle times grain_lanes plus its lane
  std::vector<uint32_t> source_;    ///< by slot: its pair, or GrainPairList::none
  std::vector<uint8_t> colour_;     ///< by pair
  std::vector<Counts> counts_;      ///< by block
  std::vector<uint32_t> crossing_;  ///< pairs between blocks
  std::vector<uint64_t> used_;      ///< by grain: a bit for each colour of its contacts
};

}  // namespace tumble
