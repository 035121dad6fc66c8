#include "engine/world/time_stepping.hpp"

#include "engine/dynamics/realtime/tick_groups.hpp"
#include "engine/world/apart.hpp"
#include "engine/world/tick_common.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace tumble {
namespace {

/// Holds all bodies that could move, except these.
void hold_others(std::span<const RigidBody> bodies, std::span<const uint32_t> moving,
                 HeldBodies& held) {
  for (uint32_t slot = 0; slot < bodies.size(); ++slot)
    if (bodies[slot].type != BodyType::fixed && !std::ranges::binary_search(moving, slot))
      held.hold(slot);
}

/// Books between the stages.
class TimeSteppingBooks final : public TickListener {
 public:
  TimeSteppingBooks(WorldState& state, const ContactSet& contacts, PressedNets& nets,
                    RealtimeBooks& books)
      : s_(state), contacts_(contacts), nets_(nets), books_(books) {}
  std::span<SolvedSpring> contacts_known(double part) override {
    return nets_.press(s_, contacts_.contacts(), part, books_.shares);
  }
  void islands_known() override {
    books_.joints = {s_.joints.joints, {}, s_.joints.energies(s_.bodies.bodies).total()};
    books_.begin_part(s_.bodies.bodies, s_.islands.involved, *s_.crew);
  }
  void solved(double part) override {
    nets_.share(s_, part, books_.shares);
    books_.joints = {s_.joints.joints, s_.workspace.solver.joint_pushes(),
                     s_.joints.energies(s_.bodies.bodies).total()};
    books_.end_part(
        {s_.bodies.bodies, contacts_, s_.islands, s_.forces, s_.settings.gravity.now(), part},
        s_.ledger, *s_.crew);
  }
  void put_back(const ContinuousStage& stage) override {
    books_.put_back(s_.bodies.bodies, stage, s_.settings.gravity.now(), s_.ledger, *s_.crew);
  }

 private:
  WorldState& s_;
  const ContactSet& contacts_;
  PressedNets& nets_;
  RealtimeBooks& books_;
};

/// Number of parts of a tick, in each of which contacts are found anew, and of sub-steps in all: a
/// group with many events in a tick moves and rotates far for its size. A group of which a body
/// crosses its surroundings in a tick, or turns more than once, gets all parts. Boxes hit by a body
/// that spins as fast overlap by .33, .17, .07 and .06 of their half side with 8, 16, 32 and 64
/// parts; with one sub-step in each part, heaps of mixed sizes are left with deeper overlaps than
/// with two. Precise islands of the realtime stepper have a quarter of the sub-steps. [-]
constexpr int most_parts = 32, most_substeps = 64;

/// The world's realtime settings, at their most accurate: contacts as stiff as the sub-steps allow.
/// Nothing sleeps.
RealtimeSettings settings_of(const WorldState& s) {
  RealtimeSettings settings = s.settings.realtime;
  settings.precise = true;
  settings.max_substeps = std::max(settings.max_substeps, most_substeps);
  settings.max_parts = std::max(settings.max_parts, most_parts);
  settings.contact_frequency = std::numeric_limits<double>::infinity();
  settings.sleeping = false;
  return settings;
}

}  // namespace

WorldTimeStepping::WorldTimeStepping(WorldState& state, const TickForces& forces)
    : state_(state), forces_(forces), settings_(settings_of(state)) {}

/// Undoes an earlier call in this tick; sets the force sums to those of the tick.
void WorldTimeStepping::start_again(std::span<const uint32_t> bodies) {
  WorldState& s = state_;
  if (!ledger_) {
    ledger_ = s.ledger;
    joints_ = s.joints.joints;
    couplings_ = s.joints.couplings;
    find_apart(s, apart_);
    s.contacts.for_each([this](const Contact& c) { known_.push_back(c); });
    std::ranges::sort(known_, {}, &Contact::key);
  }
  s.ledger = *ledger_;
  s.joints.joints = joints_;
  s.joints.couplings = couplings_;
  links_ = block_links(s);  // between the bodies that are not held now
  nets_.find_among(s, bodies);
  nets_.tie_blocks(s.bodies.bodies);
  forces_.share(bodies, books_.shares);
  std::vector<Contact> known;
  const auto moves = [bodies](uint32_t slot) { return std::ranges::binary_search(bodies, slot); };
  for (const Contact& c : known_)
    if (moves(c.key.body_a) || moves(c.key.body_b)) known.push_back(c);
  contacts_.assign(std::move(known));
  s.roster.forget();
  s.roster.refresh(s.bodies.bodies, s.crew.get());
}

Status WorldTimeStepping::run() {
  WorldState& s = state_;
  TimeSteppingBooks books(s, contacts_, nets_, books_);
  RealtimeTick tick = realtime_tick(s, {settings_, links_, apart_, contacts_, books});
  tick.close = true;
  const Status done = tick.run();
  return outcome_of_stages(s, tick.report, done);
}

Status WorldTimeStepping::advance(std::span<const uint32_t> bodies) {
  HeldBodies others(state_.bodies.bodies);
  hold_others(state_.bodies.bodies, bodies, others);
  start_again(bodies);
  Status done = run();
  state_.roster.forget();
  return done;
}

}  // namespace tumble
