#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Properties of a body that decide how its island is solved, read once per tick.
struct BodyTraits {
  static constexpr uint8_t dynamic = 1, kinematic = 2;
  /// Turns so fast, or is so slender, that lever arms must follow it.
  static constexpr uint8_t fast = 4;
  static constexpr uint8_t careful = 8;  ///< is integrated in double precision, in steps of its own
  static constexpr uint8_t precise = 16;  ///< RigidBody::precise
  uint8_t flags = 0;                      ///< 0 for fixed and sleeping bodies
  uint16_t contacts = 0;   ///< contacts of a dynamic body in its island, at most 65,535
  float mass = 0;          ///< [kg]
  float inner_radius = 0;  ///< [m]
  float pull = 0;          ///< acceleration by gravity [m/s2]

  bool is(uint8_t flag) const { return (flags & flag) != 0; }
};

/// Islands that WideIsland solves together are all of one sort. Decisions that are made once for
/// all of them depend only on the sort, so that the result of an island does not depend on which
/// others there are.
enum class WideSort : uint8_t {
  plain,             ///< contacts only, all in bundles
  contacts,          ///< contacts only, some solved by the scalar rows
  jointed,           ///< joints and contacts
  jointed_bouncing,  ///< joints, and contacts with restitution
  joints,            ///< joints only
};
constexpr size_t wide_sorts = 5;

/// How an island is solved. Depends on the island and on settings, never on what else is in the
/// world.
///
/// Ordinary islands take RealtimeSettings::substeps sub-steps, in bundles and single precision.
/// Precise ones are solved in double precision with as many sub-steps, up to max_substeps, and as
/// many sweeps over their joints as their size allows. An island is precise if
/// - it is small, so that this costs next to nothing;
/// - the settings, or one of its bodies, ask for it;
/// - it has no joints, and in sub-steps of the ordinary length a body would sink into another by a
///   noticeable share of its inner radius. A soft contact yields by g h^2 times the ratio of the
///   carried mass to the body's own, so these are small or thin bodies, or light ones below heavy
///   ones; or there is no weight;
/// - it has joints, and a heavy body hangs on a light one, or coordinates are coupled;
/// - it has springs that are solved together with contacts: then it takes as many sub-steps as its
///   motion and the stiffness of the springs demand, whatever its size.
struct SolvePlan {
  int substeps = 1;
  int joint_sweeps = 1;  ///< in each pass, before the bodies move and after it
  bool wide = false;     ///< ordinary: solved by WideIsland
  WideSort sort = WideSort::plain;
};

/// Sub-steps for a precise island of this size: its contact points plus twice its joints.
int precise_substeps(size_t work, const RealtimeSettings& settings);
/// Sweeps over the joints of a precise island; several in small ones, so that chains do not
/// stretch.
int precise_joint_sweeps(size_t joints);

/// Whether the lever arms of a contact turn with body A (or B). Those on a round surface do not:
/// the surface rolls under the contact.
bool turns_arms(const Contact& contact, bool of_a);

/// The plans of all islands of a tick. Memory is reused.
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
  /// Indices of things (couplings, springs), each of which belongs to one island.
  class ByIsland {
   public:
    /// Sorts `count` things by island; slot_of(k) is a body of the island that has thing k, or
    /// no_body.
    template <class F>
    void sort(const IslandSet& islands, size_t count, const F& slot_of);
    std::span<const uint32_t> of(uint32_t island) const;

   private:
    std::vector<uint32_t> things_, first_;  ///< empty if there are none
  };
  ByIsland couplings_, springs_;
};

}  // namespace tumble
