#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// What decides how the bodies of an island are solved, read once a tick.
struct BodyTraits {
  static constexpr uint8_t dynamic = 1, kinematic = 2;
  static constexpr uint8_t fast = 4;      ///< turns so fast, or is so slender, that arms follow it
  static constexpr uint8_t careful = 8;   ///< turns in double precision and with steps of its own
  static constexpr uint8_t precise = 16;  ///< RigidBody::precise
  uint8_t flags = 0;                      ///< 0 of fixed and sleeping bodies
  uint16_t contacts = 0;                  ///< of dynamic bodies, in its island; at most 65,535
  float mass = 0;                         ///< [kg]
  float inner_radius = 0;                 ///< [m]
  float pull = 0;                         ///< of gravity [m/s2]

  bool is(uint8_t flag) const { return (flags & flag) != 0; }
};

/// What is solved in one go by the bundles, so that what an island comes to is the same whichever
/// other islands there are: these loops ask once for all islands of a sort, not for each.
enum class WideSort : uint8_t {
  plain,             ///< contacts only, all of them in bundles
  contacts,          ///< contacts only, some of them by the scalar rows
  jointed,           ///< joints and contacts
  jointed_bouncing,  ///< joints, and contacts with restitution
  joints,            ///< joints only
};
constexpr size_t wide_sorts = 5;

/// How an island is solved: by itself and by settings, never by what else is in the world.
///
/// Ordinary islands take RealtimeSettings::substeps sub-steps, in bundles and single precision.
/// Precise ones are solved in double precision with as many sub-steps, up to max_substeps, and as
/// many sweeps over their joints as are affordable for one of that size. Precise are
/// - those for which it costs next to nothing,
/// - those that the settings, or a body of them, ask to be,
/// - without joints: where a body would sink into another, in sub-steps of the ordinary length, by
///   a noticeable share of its inner radius. A soft contact gives way by g h^2 times the masses
///   that it carries over its own, so these are small things, thin ones, and light ones below heavy
///   ones; and where nothing has weight,
/// - with joints: where a heavy body hangs on a light one, and where coordinates are coupled,
/// - with springs that are solved together with contacts: as many sub-steps as what moves and how
///   stiff the springs are ask for, whatever the size.
struct SolvePlan {
  int substeps = 1;
  int joint_sweeps = 1;  ///< before the bodies move, and after it
  bool wide = false;     ///< ordinary: solved by WideIsland
  WideSort sort = WideSort::plain;
};

/// Sub-steps for a precise island with this many contact points, a joint counted as two.
int precise_substeps(size_t work, const RealtimeSettings& settings);
/// Sweeps over the joints of a precise island, several in small ones, which is what lets chains
/// hold.
int precise_joint_sweeps(size_t joints);

/// Whether a point of the contact is not on a round surface of the body: a ball's lever arms do not
/// turn with it, its surface rolls under them.
bool turns_arms(const Contact& contact, bool of_a);

/// The plans of all islands of a tick. Memory is kept.
class SolvePlans {
 public:
  void make(const SolverContext& context, const IslandSet& islands, Crew& crew);

  std::span<const SolvePlan> plans() const { return plans_; }     ///< by island
  std::span<const BodyTraits> traits() const { return traits_; }  ///< by body slot
  /// Indices of the ordinary islands of a sort.
  std::span<const uint32_t> wide(WideSort sort) const { return wide_[size_t(sort)]; }
  /// Indices of the couplings of an island, ascending.
  std::span<const uint32_t> couplings(uint32_t island) const { return couplings_.of(island); }
  /// Indices of the springs of an island, ascending.
  std::span<const uint32_t> springs(uint32_t island) const { return springs_.of(island); }
  size_t bytes() const { return heap_bytes(traits_, plans_); }

 private:
  void read_bodies(const SolverContext& context, const IslandSet& islands, Crew& crew);
  SolvePlan plan(const SolverContext& context, const IslandSet& islands, const Island& island);
  int spring_substeps(const SolverContext& context, const IslandSet& islands,
                      const Island& island) const;
  WideSort sort(const SolverContext& context, const IslandSet& islands, const Island& island);
  bool sinks(const IslandSet& islands, const Island& island, double substep) const;
  bool hangs_heavily(const SolverContext& context, const IslandSet& islands,
                     const Island& island) const;

  std::vector<BodyTraits> traits_;
  std::vector<SolvePlan> plans_;
  std::array<std::vector<uint32_t>, wide_sorts> wide_;
  /// Numbers of things that islands share out among them.
  class ByIsland {
   public:
    /// Of `count` things; slot_of(k) is a body of the island that has thing k, or no_body.
    template <class F>
    void sort(const IslandSet& islands, size_t count, const F& slot_of);
    std::span<const uint32_t> of(uint32_t island) const;

   private:
    std::vector<uint32_t> things_, first_;  ///< empty where there are none
  };
  ByIsland couplings_, springs_;
};

}  // namespace tumble
