#pragma once
#include "engine/dynamics/event/first_event.hpp"
#include "engine/dynamics/event/group_impacts.hpp"

#include <memory>

namespace tumble {

/// One group over one tick of the event stepper, or over a part (Coutinho 2013 §1.4): integrate
/// with the contacts that are closed; where a gap closes or slip ends, go back to that moment,
/// located to 1e-12 m; resolve what collides; go on.
class EventGroup {
 public:
  static constexpr uint64_t any_number = ~uint64_t{0};

  /// `block_of`: by slot the body's place in its group, no_block for fixed bodies.
  EventGroup(std::span<RigidBody> bodies, BodyGroup& group, std::span<const uint32_t> block_of,
             const SmoothForces& forces, const EventContext& context);
  ~EventGroup();
  EventGroup(const EventGroup&) = delete;
  EventGroup& operator=(const EventGroup&) = delete;

  /// Moves the group's bodies on. The contacts count impacts and impulses from the beginning of the
  /// tick. An error leaves the bodies anywhere; after more than `allowed` steps it gives up: see
  /// BodyGroup::given_up.
  Status advance(const TickPart& part, EventStats& stats, uint64_t allowed = any_number);

 private:
  struct EnergyLost {
    double energy = 0;  ///< [J]
    double doubt = 0;   ///< of it, if the forces' power jumped during the step [J]
  };
  /// Where the present step began.
  struct StepStart {
    double t = 0;
    std::vector<double> y;
    std::vector<EventContact> contacts;
    std::vector<EventPair> pairs;
  };
  Status go_through(const TickPart& part, EventStats& stats, uint64_t allowed);
  /// The fastest that springs make any body go [1/s]; 0 where the integrator need not follow it.
  double spring_rate() const;
  /// Whether springs alone ask for more steps than the budget has.
  bool foresees_too_much(const TickPart& part, uint64_t allowed) const;
  /// The error of a tick that cost more than it may: who is crushed where that is the cause.
  Status too_much(uint64_t budget);
  void begin_tick();
  void begin_step(double t);
  void go_back();
  void note_gone();
  /// Books by how much angles of joints have changed since the last call; no step turns a body so
  /// far that full turns would be missed.
  void count_turns();
  double safe_step(double most) const;
  double passing_speed(const EventPair& p, double step) const;
  /// No step that ends earlier is tried.
  bool is_shortest(double step) const;
  /// Adaptive integrators may stop short, and a step without an answer is tried shorter: `step` is
  /// then how far it came.
  Status step_to(double t, double& step);
  /// step_to(), but no farther than to the first event.
  Status step_to_event(double t, double& step, EventStats& stats);
  /// Whether there are no forces where the last step began, so that none leads on from there.
  bool stuck_at(double t);
  /// Whether closed contacts and limits under load are still where they should be, and those of
  /// edges that crossed at `crossings` under load, at the step's beginning, have not run away.
  bool kept_closed(std::span<const std::optional<Vec3>> crossings) const;
  /// By contact.
  std::vector<std::optional<Vec3>> pressed_crossings() const;
  /// Whether joints needed little to be put right, and of the group's inner energy little came or
  /// went: they do no work.
  bool kept_jointed(const JointDrift& drift, double lost, double energy_before) const;
  /// What the last step, from t on, changed of the kinetic energy beyond
  /// the work of the forces, which Simpson's rule gives to the order of the integrator; 0 where
  /// other things than joints act. Leaves the bodies at the step's end.
  EnergyLost energy_lost(double t, double step);

  GroupState state_;
  GroupProjection projection_;
  GroupImpacts impacts_;
  GroupDrives drives_;
  std::unique_ptr<ode::Integrator> integrator_;
  FirstEvent first_event_;
  std::vector<double> y_, scratch_;
  StepStart start_;
  std::vector<std::array<double, most_coordinates>> angles_;  ///< by joint, of the last count
};

}  // namespace tumble
