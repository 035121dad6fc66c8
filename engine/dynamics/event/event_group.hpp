#pragma once
#include "engine/dynamics/event/first_event.hpp"
#include "engine/dynamics/event/group_impacts.hpp"

#include <memory>

namespace tumble {

/// One group over a tick of the event stepper, or over a part of one (Coutinho 2013 §1.4):
/// integrate with the mode fixed; where a gap closes or slip ends, go back to that moment, which is
/// located to rounding error of time; resolve what collides; continue.
class EventGroup {
 public:
  static constexpr uint64_t any_number = ~uint64_t{0};

  /// `block_of`: by slot, the body's place in the group; no_block for fixed bodies.
  EventGroup(std::span<RigidBody> bodies, BodyGroup& group, std::span<const uint32_t> block_of,
             const SmoothForces& forces, const EventContext& context);
  ~EventGroup();
  EventGroup(const EventGroup&) = delete;
  EventGroup& operator=(const EventGroup&) = delete;

  /// Moves the group's bodies over the part. The contacts count impacts and impulses from the
  /// beginning of the tick. After an error the poses of the bodies are undefined. After more than
  /// `allowed` steps it gives up (BodyGroup::given_up).
  Status advance(const TickPart& part, EventStats& stats, uint64_t allowed = any_number);

 private:
  struct EnergyLost {
    double energy = 0;  ///< [J]
    /// Uncertainty of that, where the power of the forces jumped during the step [J]
    double doubt = 0;
  };
  /// The state where the present step began.
  struct StepStart {
    double t = 0;
    std::vector<double> y;
    std::vector<EventContact> contacts;
    std::vector<EventPair> pairs;
  };
  Status go_through(const TickPart& part, EventStats& stats, uint64_t allowed);
  /// Greatest EventContext::spring_rate of any body [1/s]; 0 if the integrator is stable for stiff
  /// springs.
  double spring_rate() const;
  /// Whether the steps that springs demand would by themselves exceed the budget.
  bool foresees_too_much(const TickPart& part, uint64_t allowed) const;
  /// The error of a tick that exceeded its budget: that bodies are crushed, where that is the
  /// cause.
  Status too_much(uint64_t budget);
  void begin_tick();
  void begin_step(double t);
  void go_back();
  void note_gone();
  /// Adds the change of the joints' angles since the last call to the books. Steps turn bodies so
  /// little that full turns are not missed.
  void count_turns();
  double safe_step(double most) const;
  double passing_speed(const EventPair& p, double step) const;
  /// Whether a step is so short that no shorter one is tried.
  bool is_shortest(double step) const;
  /// Takes a step from t. Adaptive integrators may stop short, and a step that finds no forces is
  /// tried again with half its length; on return `step` is the length that was taken.
  Status step_to(double t, double& step);
  /// step_to(), then again up to the first event in the step, if there is one.
  Status step_to_event(double t, double& step, EventStats& stats);
  /// Whether no contact forces exist at the beginning of the step, so that no shorter step can
  /// succeed.
  bool stuck_at(double t);
  /// Whether closed contacts and limits that carry a force are still where they should be, and
  /// crossings of edges under load have not moved far from `crossings`, where they were at the
  /// beginning of the step.
  bool kept_closed(std::span<const std::optional<Vec3>> crossings) const;
  /// By contact: where edges cross under load.
  std::vector<std::optional<Vec3>> pressed_crossings() const;
  /// Whether the step kept the joints: they opened little, and the group's energy about its centre
  /// of mass changed by no more than the work of the forces, since joints do no work.
  bool kept_jointed(const JointDrift& drift, double lost, double energy_before) const;
  /// By how much the last step, from t on, changed the kinetic energy other than by the work of the
  /// forces, which Simpson's rule gives to the order of the integrator; 0 unless only joints and
  /// smooth forces act. Leaves the bodies at the end of the step.
  EnergyLost energy_lost(double t, double step);

  GroupState state_;
  GroupProjection projection_;
  GroupImpacts impacts_;
  GroupDrives drives_;
  std::unique_ptr<ode::Integrator> integrator_;
  FirstEvent first_event_;
  std::vector<double> y_, scratch_;
  StepStart start_;
  /// By joint, at the last count_turns().
  std::vector<std::array<double, most_coordinates>> angles_;
};

}  // namespace tumble
