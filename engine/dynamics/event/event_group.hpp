#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/pair_filter.hpp"
#include "engine/dynamics/event/event_contact.hpp"
#include "engine/dynamics/event/event_settings.hpp"
#include "engine/dynamics/event/event_system.hpp"
#include "engine/dynamics/event/impulses/impact_law.hpp"
#include "engine/dynamics/event/reach.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/event/touch_watch.hpp"
#include "engine/math/ode/integrator.hpp"

#include <functional>
#include <memory>

namespace tumble {

/// Bodies that may meet or are tied together within a tick, and the pairs of their shapes.
struct BodyGroup {
  std::vector<uint32_t> bodies;                     ///< slots, ascending; none is fixed
  std::vector<EventPair> pairs;                     ///< in order; one side may be fixed
  std::vector<uint32_t> joints;                     ///< of EventContext::joints, ascending
  std::vector<std::pair<uint32_t, uint32_t>> ties;  ///< slots that joints and springs hold together
  std::vector<EventContact> contacts;  ///< of the end of the last tick, then of this one
  std::span<const BodyReach> reaches;  ///< by slot; of all bodies
  /// By place: how far the body's points were from BodyReach::start at most, at the ends of steps
  /// [m]. What goes farther than its reach may have missed somebody.
  std::vector<double> max_displacement;
  GroupBooks books;  ///< of this tick; empty without EventContext::rates
  /// When there had been more steps than were allowed [s]; the bodies are anywhere.
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
  uint64_t events = 0;  ///< at which a step ended early
  /// Steps that were computed again, up to an event or since they were taken back, each counted
  /// once for every body that took it: what counts against the budget.
  uint64_t spent = 0;
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

/// What it needs to know besides the bodies.
struct EventContext {
  EventSettings settings;
  ImpactLaw law = nullptr;    ///< of settings.impulses
  ContactForceMethod forces;  ///< of settings.contact_solver and friction_cone
  std::span<Joint> joints;    ///< those that links name hold; their forces are told there
  PairFilter apart;           ///< bodies that do not collide
  double gravity = 0;         ///< magnitude, for the end of series of bounces [m/s2]
  NarrowPhase narrow_phase = &collide;
  const HierarchyKind* hierarchy = nullptr;
  std::function<std::string(uint32_t)> name_of;  ///< of a body by its slot, for errors
  const ForceRates* rates = nullptr;             ///< for books of what each cause does
  /// How many bodies may move with others, as finely as these, that nothing ties them to.
  size_t max_untied_bodies = tolerances::untied_bodies;
  TimeStepping* time_stepping = nullptr;  ///< null: a group without events' solution is an error

  /// Whether so many bodies had more events in a tick than they may have.
  bool over_budget(size_t bodies, const EventStats& stats) const {
    return stats.spent > uint64_t(settings.budget) * bodies;
  }
  std::string name(uint32_t slot) const;
};

/// A part of a tick of `tick` seconds; times since its start [s].
struct TickPart {
  double begin = 0, end = 0, tick = 0;
};

/// One group over one tick of the event stepper, or over a part (Coutinho 2013 §1.4): integrate
/// with the contacts that are closed; where a gap closes or slip ends, go back to that moment,
/// located to 1e-12 m; resolve what collides; go on.
class EventGroup {
 public:
  static constexpr uint64_t any_number = ~uint64_t{0};

  /// `block_of`: by slot the body's place in its group, no_block for fixed bodies.
  EventGroup(std::span<RigidBody> bodies, BodyGroup& group, std::span<const uint32_t> block_of,
             const SmoothForces& forces, const EventContext& context);

  /// Moves the group's bodies on. The contacts count impacts and impulses from the beginning of the
  /// tick. An error leaves the bodies anywhere; after more than `allowed` steps it gives up: see
  /// BodyGroup::given_up.
  Status advance(const TickPart& part, EventStats& stats, uint64_t allowed = any_number);

 private:
  /// What hold_joints() put right.
  struct JointDrift {
    double open = 0;     ///< how far joints had come open [m, rad]
    double changed = 0;  ///< kinetic energy of the change of velocities [J]
  };
  struct EnergyLost {
    double energy = 0;  ///< [J]
    double doubt = 0;   ///< of it, if the forces' power jumped during the step [J]
  };
  void begin_tick();
  Status resolve(EventStats& stats);
  ImpactPoint impact_point(const EventContact& contact, const ElementGap& gap) const;
  void take_impulses(std::span<const size_t> touching, const ImpactReport& report,
                     EventStats& stats);
  /// Where there are no finite forces: impulses that stop slip. False when there are none.
  bool stop_jams(EventStats& stats);
  /// Where these do nothing either: the slowest slip that contact forces in the full cone hold
  /// comes to rest. False when they hold none.
  bool stop_slowest(EventStats& stats);
  Status collide_now(std::span<const size_t> touching, EventStats& stats);
  void close_contacts();
  /// Whether a closed contact slides, and where to.
  void find_slip(EventContact& contact, const ElementGap& gap) const;
  /// Slower than this is at rest where forces hold it [m/s]: still_speed, but where impacts and
  /// ends of slip crowd (more than 20 in a tick, and one for every four contacts) twice that with
  /// each further one, up to gravity * tick / 8. Bodies that touch at many points rattle: a hit at
  /// one opens others by nanometres, and so on (Zeno).
  double resting_speed() const;
  /// Closes contacts and stops slip that are slower than resting_speed(), where the contact forces
  /// press them and hold them within the cone: what these would stop within the tick stops at once.
  /// What opens or slips by these forces goes on. The least change of velocities does it, which
  /// takes energy: booked to restitution along the normals, then to friction.
  void rest_slow();
  /// Brings to rest what is newly marked as closed or sticking, where the contact forces keep it
  /// so. False, with velocities as they were, when they keep none of it.
  bool rest_marked(std::span<const EventContact> before);
  /// Marks what moves slower than `slow` as closed and sticking; whether there is any.
  bool mark_slow(double slow);
  /// Undoes the marks of what the forces at `before` do not hold.
  bool unmark_loose(std::span<const EventContact> before);
  void project();
  /// Velocities that closed contacts and those that stick do not have, by the least change.
  void project_velocities(ContactCause cause = ContactCause::projection);
  /// Puts the joints right by themselves; what happens then begins with bodies that they hold.
  JointDrift hold_joints();
  /// Kinetic energy of all bodies about their common centre of mass.
  double inner_energy() const;
  double energy_between(std::span<const DofBlock> after) const;
  /// The joints at the bodies' present poses.
  const Articulation& joints_now();
  /// Gives how far the contact was off that was farthest off [m].
  double project_positions(ContactCause cause = ContactCause::projection);
  /// project_positions() until nothing is off.
  void close_up(ContactCause cause = ContactCause::projection);
  void move_bodies(std::span<const DofBlock> displacements,
                   ContactCause cause = ContactCause::projection);
  Row row_at(const EventContact& contact, const ElementGap& gap, const Vec3& axis) const;
  /// Overlap that was there before is worked off; see EventSettings::recovery_speed.
  void work_off_overlap();
  void note_gone();
  Error error(std::string what, std::string cure) const;
  /// The same where that is the cause: what is crushed in the contacts that close in this tick.
  Error lost(std::string what, std::string cure);
  /// Who is crushed between whom, if there are no impulses at these contacts.
  std::optional<Error> crush_of(std::span<const size_t> which);
  std::string names_of(std::span<const uint32_t> slots) const;
  double safe_step(double most) const;
  /// Time of the first event after the start of the last step, or `step` when there is none; sets
  /// stopping_.
  double first_event(double t, double step);
  /// Positive before the contact's next event: the room that is left, or the slip along itself.
  double event_value(const EventContact& contact) const;
  /// A value that is positive before an event.
  struct ValueWatch {
    std::function<double()> value_now;
    double lo, value;                ///< until when nothing happened, and the value there
    EventContact* slides = nullptr;  ///< whose slip it is
  };
  /// What has just parted must first be away by more than `hop` before it can come back.
  void let_part(double t, double step, double hop, ValueWatch& watch);
  /// Puts the bodies where the last step had them at a time.
  void place_at(double t);
  /// How much nearer the bodies of a pair may come in a step [m].
  double reach_in(const EventPair& pair, double step) const;
  /// What may come to touch in the last step, at the bodies' places at t.
  std::vector<TouchWatch> watch_pieces(double t, double step);
  void set_motions(double t, double step, std::span<TouchWatch> watched);
  /// The first time between `lo` and `hi`, since t, at which pieces are deeper than allowed;
  /// infinite for none. All that is watched has passed `lo`.
  double first_touch(double t, double lo, double hi, std::span<TouchWatch* const> watched,
                     int depth);
  /// Of a value at the bodies' places between two times since t, positive at the first: the answer
  /// is at or behind it, where the value is no less than -enough.
  double find_root(double t, const std::function<double()>& value, double lo, double f_lo,
                   double hi, double f_hi, double enough = 0);
  /// Adaptive integrators may stop short, and a step without an answer is tried shorter: `step` is
  /// then how far it came.
  Status step_to(double t, double& step, const std::vector<double>& from, EventStats& stats);
  /// step_to(), but no farther than to the first event.
  Status step_to_event(double t, double& step, const std::vector<double>& from, EventStats& stats);
  /// Counts a step that is computed again; an error when that is over the budget.
  Status spend(EventStats& stats);
  /// Whether there are no forces where the last step began, so that none leads on from there.
  bool stuck_at(double t, const std::vector<double>& from);
  void find_contacts(bool accept_overlap);
  std::span<const EventContact> contacts_of(const EventPair& pair) const {
    return std::span(contacts_).subspan(pair.first_contact, pair.contacts);
  }
  /// How far any contact is in beyond what its pair was accepted with [m]: where two overlap, other
  /// points of theirs are the deepest ones as they slide.
  double deepest() const;
  /// Whether closed contacts under load are still where they should be, and those of edges that
  /// crossed at `crossings` under load, at the step's beginning, have not run away.
  bool kept_closed(std::span<const std::optional<Vec3>> crossings) const;
  /// By contact.
  std::vector<std::optional<Vec3>> pressed_crossings() const;
  /// Whether joints needed little to be put right, and of the group's inner energy little came or
  /// went: they do no work.
  bool kept_jointed(const JointDrift& drift, double lost, double energy_before) const;
  /// What the last step, from the bodies' states `from` at t, changed of the kinetic energy beyond
  /// the work of the forces, which Simpson's rule gives to the order of the integrator; 0 where
  /// other things than joints act. Leaves the bodies at the step's end.
  EnergyLost energy_lost(double t, double step, const std::vector<double>& from);
  std::vector<DofBlock> blocks() const;
  void set_velocities(std::span<const DofBlock> blocks);
  void book_impulses(std::span<const ImpactPoint> points, std::span<const Vec3> impulses,
                     std::span<const double> joint_impulses, std::span<const DofBlock> after);
  void book_projection(std::span<const DofBlock> after,
                       ContactCause cause = ContactCause::projection);

  std::span<RigidBody> bodies_;
  BodyGroup& group_;
  std::span<const uint32_t> block_of_;
  const EventContext& context_;
  EventSystem system_;
  std::unique_ptr<ode::Integrator> integrator_;
  std::vector<EventPair>& pairs_;
  std::vector<EventContact>& contacts_;
  std::vector<double> y_, scratch_;
  TickPart part_;
  double now_ = 0;                    ///< since the beginning of the tick [s]
  uint32_t evaluations_ = 0;          ///< of the equations of motion in the last step
  EventContact* stopping_ = nullptr;  ///< whose slip the last first_event() saw come to its end
};

}  // namespace tumble
