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

struct ForceShare;
struct WorldState;

/// Nets of springs with particles that collide. One that touches nothing is pulled once a tick
/// (pull_springs). In a tick in which it meets anything its springs are solved with its contacts in
/// the sub-steps instead (SpringRow): what a contact stops within the tick springs would else go on
/// to press together as if it flew on, and a stiff net gains a thousand times its energy. So are
/// the springs of a net that turns or is crossed too fast for a tick.
class PressedNets {
 public:
  /// The nets of a tick whose blocks of particles are still to come, and which were pressed in the
  /// one before.
  void find(const WorldState& state);
  /// Those among `moving`, which are sorted and have the blocks of particles with them: bodies that
  /// meet so much in a tick of events that time-stepping moves them. All count as pressed.
  void find_among(const WorldState& state, std::span<const uint32_t> moving);
  /// Whether a force is to be asked for its pull: not where it is known to take sub-steps.
  bool pulls(size_t force) const {
    return force >= pulled_apart_.size() || pulled_apart_[force] == 0;
  }
  /// After the blocks of particles are appended: makes links(), and marks the particles that look
  /// for contacts along their whole way.
  void tie_blocks(std::vector<RigidBody>& bodies);
  /// Between all that springs of these nets tie.
  std::span<const BodyLink> links() const { return links_; }
  /// Now that contacts are known for `part` seconds: the springs of nets that are pressed, in the
  /// order of the forces. What was pulled by them for the tick is taken out of the force sums, and
  /// of the shares by force.
  std::span<SolvedSpring> press(WorldState& state, std::span<const Contact> contacts, double part,
                                std::span<ForceShare> shares);
  /// Notes what these springs did in `part` seconds as what their forces do.
  void share(const WorldState& state, double part, std::span<ForceShare> shares);
  void clear();

 private:
  /// A spring of a net.
  struct Tied {
    uint32_t force = 0;  ///< its slot
    SolvedSpring spring;
    bool pressed = false;
  };
  void number_particles(const WorldState& state);
  void begin_sets(size_t slots);
  void find_nets(const WorldState& state);
  uint32_t slot_of(const WorldState& state, ParticleSystemId system, uint64_t id) const;
  bool moves(const WorldState& state, uint32_t slot) const;
  bool add_end(const WorldState& state, const Anchor& anchor, double weight, SolvedSpring& spring);
  void take(const WorldState& state, const SolvedSpring& spring, uint32_t force);
  void take_spring(const WorldState& state, const SpringDef& def, uint32_t force);
  void take_mesh(const WorldState& state, const SpringMesh& mesh, uint32_t force);
  void take_pressed_before(const WorldState& state);
  void share_force(const WorldState& state, std::span<const SolvedSpring> springs, double part,
                   ForceShare& share);
  bool in_net(uint32_t slot) const;
  uint32_t any_end(const SolvedSpring& spring) const;
  bool is_outrun(const WorldState& state, const SolvedSpring& spring, double part) const;

  std::vector<Tied> tied_;
  std::vector<BodyLink> links_;
  uint32_t first_block_ = 0;           ///< slot of the first particle that is a block
  std::vector<uint32_t> first_of_;     ///< by system: slot of its first, no_body of those without
  std::vector<uint8_t> pulled_apart_;  ///< by force: it takes sub-steps, as is known from the start
  std::vector<uint32_t> place_;   ///< by slot: of its entry in the share under way + 1, 0 between
  bool astray_ = false;           ///< an end of what is under way is a particle and no body
  DisjointSets sets_;             ///< of body slots
  std::vector<uint8_t> of_;       ///< by slot: kinds of what its net ties
  std::vector<uint8_t> pressed_;  ///< by the slot that stands for a net
  std::vector<SolvedSpring> springs_;
  std::vector<uint32_t> forces_;  ///< by spring: slot of its force
};

}  // namespace tumble
