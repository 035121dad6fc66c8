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
  std::vector<uint32_t> bodies;     ///< slots, ascending; none is fixed
  std::vector<EventPair> pairs;     ///< in order; one side may be fixed
  std::vector<uint32_t> joints;     ///< of EventContext::joints, ascending
  std::vector<uint32_t> couplings;  ///< likewise of EventContext::couplings
  /// The joints' equations, kept from tick to tick; null: made anew.
  Articulation* laid_out = nullptr;
  std::vector<std::pair<uint32_t, uint32_t>> ties;  ///< slots that joints and springs hold together
  std::vector<EventContact> contacts;  ///< contacts at the end of the last tick, later of this one
  std::span<const BodyReach> reaches;  ///< by slot, for all bodies of the world
  /// By place: the greatest distance of any point of the body from where it was at
  /// BodyReach::start, at the ends of steps [m]. A body that moved farther than its reach may have
  /// met one that it was not paired with.
  std::vector<double> max_displacement;
  GroupBooks books;  ///< of this tick; empty without EventContext::rates
  /// The time of the tick at which the group had taken more steps than were allowed [s]; the poses
  /// of its bodies are undefined then.
  std::optional<double> given_up;
  bool scattered = false;     ///< goes through the tick in windows (GroupWindows)
  bool time_stepped = false;  ///< goes through the whole tick by TimeStepping
  bool crushed = false;  ///< it is proved that its bodies are crushed, so that no motion exists
};

/// Another method to move bodies through a tick, for groups with too many events or without a
/// solution.
class TimeStepping {
 public:
  virtual ~TimeStepping() = default;
  /// Moves these bodies (slots, ascending), which are where they were at the start of the tick,
  /// over the whole tick, while all others stand still where they are. May be called several times
  /// in a tick: each call replaces the effects of the calls before.
  virtual Status advance(std::span<const uint32_t> bodies) = 0;
};

struct EventStats {
  uint64_t events = 0;        ///< steps that ended early at an event
  uint64_t work = 0;          ///< in the unit of WorkMeter, against EventContext::allowed_work()
  uint64_t time_stepped = 0;  ///< groups that TimeStepping moved
  uint64_t impacts = 0;       ///< moments at which impulses acted
  uint64_t steps = 0;         ///< steps of the integrator
  /// Impacts resolved by sequential_impacts because the law of impulses found no answer.
  uint64_t fallbacks = 0;
  uint64_t jams = 0;         ///< sliding points that only an impulse could stop
  uint64_t substituted = 0;  ///< steps in which another solver answered than the chosen one
  uint64_t groups = 0;       ///< groups of bodies that might meet
  uint64_t windows = 0;      ///< windows in which clusters of a group moved independently
  uint64_t pairs = 0;        ///< pairs of shapes that might meet
  double residual = 0;       ///< greatest residual of all complementarity problems [-]
  double deepest = 0;        ///< deepest overlap beyond the accepted depth [m]
  double impact_work = 0;    ///< work of all collisions, <= 0 [J]
  void include(const EventStats& s);
};

/// What a group needs to know besides its bodies.
struct EventContext {
  EventSettings settings;
  ImpactLaw law = nullptr;    ///< the law that settings.impulses names
  ContactForceMethod forces;  ///< the method that settings.contact_solver and friction_cone name
  std::span<Joint> joints;  ///< those that BodyLinks name are held; their forces are written there
  std::span<JointCoupling> couplings;     ///< couplings of these joints; likewise
  PairFilter apart;                       ///< pairs of bodies that do not collide
  std::span<const CourseMotion> courses;  ///< of kinematic bodies, by slot
  double gravity = 0;  ///< magnitude; decides when a series of bounces ends [m/s2]
  NarrowPhase narrow_phase = &collide;
  const HierarchyKind* hierarchy = nullptr;
  std::function<std::string(uint32_t)> name_of;  ///< name of a body by its slot, for errors
  const ForceRates* rates = nullptr;  ///< for books of the effects by cause; null: none are kept
  /// Greatest number of bodies that may share the steps of others without being tied to them; more,
  /// and the window is halved.
  size_t max_untied_bodies = tolerances::untied_bodies;
  EventSearchTrace* search = nullptr;  ///< record of the search for events; null: none is kept
  /// Null: a group for which events find no solution is an error.
  TimeStepping* time_stepping = nullptr;
  double budget_share = 1;  ///< share of the budget that a group may spend [-]

  /// By slot: an upper bound on the rate at which springs make a body oscillate or relax; zero
  /// beyond the end [1/s].
  std::span<const double> spring_rates;

  double spring_rate(uint32_t slot) const {
    return slot < spring_rates.size() ? spring_rates[slot] : 0;
  }
  /// The work that a tick of `tick` seconds may cost for a group of these bodies, in the unit of
  /// WorkMeter.
  uint64_t allowed_work(std::span<const RigidBody> bodies, std::span<const uint32_t> slots,
                        double tick) const;
  std::string name(uint32_t slot) const;
};

/// A part of a tick that lasts `tick` seconds; times since the start of that tick [s].
struct TickPart {
  double begin = 0, end = 0, tick = 0;
};

}  // namespace tumble
