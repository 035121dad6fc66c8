#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/pair_filter.hpp"
#include "engine/dynamics/event/event_contact.hpp"
#include "engine/dynamics/event/event_pair.hpp"
#include "engine/dynamics/event/event_settings.hpp"
#include "engine/dynamics/event/event_system.hpp"
#include "engine/dynamics/event/impulses/impact_law.hpp"
#include "engine/dynamics/event/reach.hpp"
#include "engine/dynamics/event/search_trace.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <functional>

namespace tumble {

/// Bodies that may meet or are tied together within a tick, and the pairs of their shapes.
struct BodyGroup {
  std::vector<uint32_t> bodies;      ///< slots, ascending; none is fixed
  std::vector<EventPair> pairs;      ///< in order; one side may be fixed
  std::vector<uint32_t> joints;      ///< of EventContext::joints, ascending
  std::vector<uint32_t> couplings;   ///< likewise of EventContext::couplings
  Articulation* laid_out = nullptr;  ///< the joints' equations from tick to tick; null: made anew
  std::vector<std::pair<uint32_t, uint32_t>> ties;  ///< slots that joints and springs hold together
  std::vector<EventContact> contacts;  ///< of the end of the last tick, then of this one
  std::span<const BodyReach> reaches;  ///< by slot; of all bodies
  /// By place: how far the body's points were from BodyReach::start at most, at the ends of steps
  /// [m]. What goes farther than its reach may have missed somebody.
  std::vector<double> max_displacement;
  GroupBooks books;  ///< of this tick; empty without EventContext::rates
  /// The time of the tick at which the group had taken more steps than were allowed [s]; the poses
  /// of its bodies are undefined then.
  std::optional<double> given_up;
  bool scattered = false;     ///< goes through the tick in windows: see GroupWindows
  bool time_stepped = false;  ///< goes through the whole tick by TimeStepping
  bool crushed = false;       ///< its error is proved: there is no motion at all
};

/// Another way through a tick, for groups in which events crowd or have no solution.
class TimeStepping {
 public:
  virtual ~TimeStepping() = default;
  /// Moves these bodies (slots, ascending), which are where they were at the start of the tick,
  /// over the whole of it, while all others stand still where they are. The last call of a tick
  /// counts: what an earlier one did has not happened.
  virtual Status advance(std::span<const uint32_t> bodies) = 0;
};

struct EventStats {
  uint64_t events = 0;        ///< at which a step ended early
  uint64_t work = 0;          ///< in the unit of WorkMeter, against EventContext::allowed_work()
  uint64_t time_stepped = 0;  ///< groups that TimeStepping moved
  uint64_t impacts = 0;       ///< moments at which impulses acted
  uint64_t steps = 0;         ///< of the integrator
  uint64_t fallbacks = 0;     ///< impacts resolved point after point for want of better
  uint64_t jams = 0;          ///< sliding points that only an impulse could stop
  uint64_t substituted = 0;   ///< steps in which another solver answered than the one asked for
  uint64_t groups = 0;        ///< of bodies that might meet
  uint64_t windows = 0;       ///< in which clusters of groups moved by themselves
  uint64_t pairs = 0;         ///< of shapes that might meet
  double residual = 0;        ///< greatest of all complementarity problems [-]
  double deepest = 0;         ///< beyond the accepted offset [m]
  double impact_work = 0;     ///< what collisions took, <= 0 [J]
  void include(const EventStats& s);
};

/// What a group needs to know besides its bodies.
struct EventContext {
  EventSettings settings;
  ImpactLaw law = nullptr;             ///< of settings.impulses
  ContactForceMethod forces;           ///< of settings.contact_solver and friction_cone
  std::span<Joint> joints;             ///< those that links name hold; their forces are told there
  std::span<JointCoupling> couplings;  ///< of these joints; likewise
  PairFilter apart;                    ///< bodies that do not collide
  std::span<const CourseMotion> courses;  ///< of kinematic bodies, by slot
  double gravity = 0;                     ///< magnitude, for the end of series of bounces [m/s2]
  NarrowPhase narrow_phase = &collide;
  const HierarchyKind* hierarchy = nullptr;
  std::function<std::string(uint32_t)> name_of;  ///< of a body by its slot, for errors
  const ForceRates* rates = nullptr;             ///< for books of what each cause does
  /// How many bodies may move with others, as finely as these, that nothing ties them to.
  size_t max_untied_bodies = tolerances::untied_bodies;
  EventSearchTrace* search = nullptr;     ///< null: nobody looks
  TimeStepping* time_stepping = nullptr;  ///< null: a group without events' solution is an error
  double budget_share = 1;                ///< of the budget, which a group may spend [-]

  /// By slot: the greatest rate at which springs make a body swing or creep; none behind the end
  /// [1/s].
  std::span<const double> spring_rates;

  double spring_rate(uint32_t slot) const {
    return slot < spring_rates.size() ? spring_rates[slot] : 0;
  }
  /// What a tick of so many seconds of a group of these bodies may cost, in the unit of WorkMeter.
  uint64_t allowed_work(std::span<const RigidBody> bodies, std::span<const uint32_t> slots,
                        double tick) const;
  std::string name(uint32_t slot) const;
};

/// A part of a tick of `tick` seconds; times since its start [s].
struct TickPart {
  double begin = 0, end = 0, tick = 0;
};

}  // namespace tumble
