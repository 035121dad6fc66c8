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

/// Nets of springs with colliding particles. The springs of a net that touches nothing act as
/// forces that are computed once a tick (pull_springs). In a tick in which a net touches anything,
/// its springs are instead solved together with its contacts in the sub-steps (SpringRow): forces
/// computed for the whole tick would go on to compress springs after a contact has stopped their
/// ends, and a stiff net would gain a thousand times its energy. The same is done for springs that
/// rotate, or whose ends pass each other, too fast for a tick.
class PressedNets {
 public:
  /// Finds the nets before the blocks of particles are appended, and those of them that contacts
  /// pressed in the last tick.
  void find(const WorldState& state);
  /// Finds the nets among `moving`, which is sorted and includes the blocks of particles: the
  /// bodies of a tick of the event stepper that are time-stepped. All of these nets count as
  /// pressed.
  void find_among(const WorldState& state, std::span<const uint32_t> moving);
  /// Whether a force is to be evaluated as a pull for the whole tick: not if its net is known to be
  /// solved in sub-steps.
  bool pulls(size_t force) const {
    return force >= pulled_apart_.size() || pulled_apart_[force] == 0;
  }
  /// After the blocks of particles are appended: fills links(), and makes the particles of nets
  /// look for contacts along their whole path.
  void tie_blocks(std::vector<RigidBody>& bodies);
  /// Links between all bodies and blocks that springs of these nets connect.
  std::span<const BodyLink> links() const { return links_; }
  /// To be called when the contacts of a part of a tick are known, with its length `part` [s].
  /// Returns the springs of the pressed nets, in the order of the forces. The pulls of those
  /// springs for the whole tick are subtracted from the force sums, and their shares are cleared.
  std::span<SolvedSpring> press(WorldState& state, std::span<const Contact> contacts, double part,
                                std::span<ForceShare> shares);
  /// Stores the mean forces of these springs over `part` seconds as the shares of their forces.
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
  uint32_t first_block_ = 0;  ///< slot of the first particle that is a block
  /// By system: slot of its first particle's block, no_body if it has none.
  std::vector<uint32_t> first_of_;
  /// By force: its net is solved in sub-steps from the start of the tick.
  std::vector<uint8_t> pulled_apart_;
  /// By body slot: 1 + index of its entry in the share being built; 0 between uses.
  std::vector<uint32_t> place_;
  /// An end of the spring being added is a particle without a block.
  bool astray_ = false;
  DisjointSets sets_;             ///< of body slots that springs connect
  std::vector<uint8_t> of_;       ///< by slot: what kinds of ends its net has
  std::vector<uint8_t> pressed_;  ///< by the slot that is the root of a net
  std::vector<SolvedSpring> springs_;
  std::vector<uint32_t> forces_;  ///< by spring: slot of its force
};

}  // namespace tumble
