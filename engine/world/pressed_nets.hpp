#pragma once
#include "engine/core/disjoint_sets.hpp"
#include "engine/dynamics/forces/force.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/realtime/spring_row.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

struct WorldState;

/// Nets of springs with particles that collide. One that touches nothing is pulled once a tick
/// (pull_springs). In a tick in which it meets anything its springs are solved with its contacts in
/// the sub-steps instead (SpringRow): what a contact stops within the tick springs would else go on
/// to press together as if it flew on, and a stiff net gains a thousand times its energy. So are
/// the springs of a net that turns or is crossed too fast for a tick.
class PressedNets {
 public:
  /// The nets of a tick, blocks of particles being there; marks who looks far for contacts.
  void find(WorldState& state);
  /// Between all that springs of these nets tie.
  std::span<const BodyLink> links() const { return links_; }
  /// Now that contacts are known for `part` seconds: the springs of nets that are pressed, in the
  /// order of the forces. What was pulled by them for the tick is taken out of the force sums.
  std::span<SolvedSpring> press(WorldState& state, double part);
  /// Notes what these springs did in `part` seconds as what their forces do.
  void share(WorldState& state, double part) const;
  void clear();

 private:
  /// A spring of a net.
  struct Tied {
    uint32_t force = 0;  ///< its slot
    SolvedSpring spring;
    bool pressed = false;
  };
  bool add_end(const WorldState& state, const ForceContext& context, const Anchor& anchor,
               double weight, SolvedSpring& spring);
  void take(const WorldState& state, const SolvedSpring& spring, uint32_t force);
  void take_spring(const WorldState& state, const ForceContext& context, const SpringDef& def,
                   uint32_t force);
  void take_mesh(const WorldState& state, const ForceContext& context, const SpringMesh& mesh,
                 uint32_t force);
  bool in_net(uint32_t slot) const;
  uint32_t any_end(const SolvedSpring& spring) const;
  bool is_outrun(const WorldState& state, const SolvedSpring& spring, double part) const;

  std::vector<Tied> tied_;
  std::vector<BodyLink> links_;
  bool astray_ = false;           ///< an end of what is under way is a particle and no body
  DisjointSets sets_;             ///< of body slots
  std::vector<uint8_t> of_;       ///< by slot: kinds of what its net ties
  std::vector<uint8_t> pressed_;  ///< by the slot that stands for a net
  std::vector<SolvedSpring> springs_;
  std::vector<uint32_t> forces_;  ///< by spring: slot of its force
};

}  // namespace tumble
