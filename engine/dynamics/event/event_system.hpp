#pragma once
#include "engine/dynamics/event/cause_effects.hpp"
#include "engine/dynamics/event/contact_forces.hpp"
#include "engine/dynamics/event/event_contact.hpp"
#include "engine/dynamics/event/event_drives.hpp"
#include "engine/dynamics/event/event_turning.hpp"
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/math/ode/system.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// Sets force and torque of the given bodies to the sum of the smooth forces on them (all but those
/// of contacts, of constraints of joints and of EventDrives), from their poses and velocities, at
/// time t since the beginning of the tick [s].
using SmoothForces = std::function<void(double t, std::span<const uint32_t> bodies)>;

/// Kinetic energy of the rotation of a body with angular velocity `omega` in world axes [J].
inline double turning_energy(const RigidBody& b, const Vec3& omega) {
  const Vec3 own = b.pose.inverse_direction(omega);
  return 0.5 * own.dot(b.inertia_body * own);
}

/// The equations of motion of a group of bodies in one mode. The state is (x, q, P, L) of each
/// dynamic body: position, orientation, momentum and angular momentum about the centre of mass,
/// world axes. Which contacts are closed is fixed for a step. Kinematic bodies move with their
/// velocity, or along their courses. derivative() leaves the bodies in the state that was
/// evaluated; write() sets them to another.
class EventSystem final : public ode::System {
 public:
  /// `moving` are the slots of the group's bodies, none of them fixed; `block_of` is, by slot, the
  /// index in `moving`, no_block for fixed bodies.
  EventSystem(std::span<RigidBody> bodies, std::span<const uint32_t> moving,
              std::span<const uint32_t> block_of, const SmoothForces& forces,
              const ContactForceMethod& method);

  /// Sets the courses of kinematic bodies in the tick, by slot; before the first read(). Between
  /// steps the bodies have the velocity of the present time; rest_courses() restores the velocities
  /// that they had before.
  void set_courses(std::span<const CourseMotion> courses);
  void rest_courses();
  /// Magnitude of the acceleration of a body's centre on its course [m/s2].
  double course_change(uint32_t slot) const;

  /// Takes over the joint equations of an earlier system, whose memory set_joints() uses again if
  /// the joints are the same; and gives away those of this one for the next.
  void take_joints(Articulation&& used) { joints_ = std::move(used); }
  Articulation&& give_joints() { return std::move(joints_); }
  /// The joints and couplings that hold throughout; before book(). They must outlive this. Parts
  /// along their coordinates (EventDrives) are included only with Drives::held.
  void set_joints(const JointsAndCouplings& all, const JointChoice& which,
                  Articulation::Drives drives = Articulation::Drives::held);
  /// Sets the mode of the drive parts that the bodies' present state implies.
  void set_drive_modes();
  /// Integrates the effects of each cause along with the motion, as quadratures appended to the
  /// state.
  void book(const ForceRates& rates);
  /// Adds the effects of a step, from the state at its end; the state at its beginning is that of
  /// read().
  void add_books(std::span<const double> y, GroupBooks& books) const;

  /// Sets the contacts, of which the `closed` ones act, and the mode of rolling and torsional
  /// friction that the bodies' present velocities imply. The contacts must outlive the steps.
  void set_contacts(std::span<EventContact> contacts) {
    contacts_ = contacts;
    foresight_.assign(contacts.size(), 0);
    turning_.set(contacts, bodies_);
  }
  std::span<const TurningPart> turning() const { return turning_.parts(); }
  /// To be called before a step of h seconds from state `from` at time t: decides which slips are
  /// treated implicitly, see slip_foresight().
  void foresee_slip(double t, double h, std::span<const double> from);
  /// Whether the last foresee_slip() found any; then the forces depend on the length of the step.
  bool foresees() const;
  /// The present state of the bodies at time t; places kinematic bodies on courses.
  std::vector<double> read(double t);
  /// Sets the bodies to a state.
  void write(double t, std::span<const double> y);
  /// Time of the last read() or write(), or set here [s].
  double now() const { return now_; }
  void set_now(double t) { now_ = t; }

  size_t size() const override { return first_quadrature() + quadratures_; }
  bool derivative(double t, std::span<const double> y, std::span<double> dydt) override;
  void normalise(std::span<double> y) const override;
  std::span<const ode::EntryKind> kinds() const override { return kinds_; }
  void allowed_errors(const ode::Tolerance& tolerance, std::span<const double> y,
                      std::span<double> allowed) const override;
  std::string entry_name(size_t entry) const override;

  /// Whether nothing acts but joints and smooth forces whose laws do not change within a step, so
  /// that the change of kinetic energy must equal the work of the forces.
  bool only_jointed() const;
  /// Work in the last step of motors of unlimited force, and of motors and friction that do not
  /// hold, from the state at its end [J].
  double drive_work(std::span<const double> y) const;
  /// Power of the smooth forces on the bodies in their present state [W]; leaves the forces stored
  /// in the bodies unchanged.
  double power(double t);
  /// Kinetic energy of the bodies, with that of rotors (armatures) [J].
  double kinetic_energy() const;
  /// The same for a state that write() has just set.
  double kinetic_energy(std::span<const double> y) const;

  /// Report of the last derivative().
  const ContactForceReport& report() const { return report_; }
  Articulation& joints() { return joints_; }
  const Articulation& joints() const { return joints_; }
  EventDrives& drives() { return drives_; }
  const EventDrives& drives() const { return drives_; }
  /// Forces of the last derivative(), by row of the joints.
  std::span<const double> joint_forces() const { return joint_forces_; }
  /// Accelerations of the last derivative(), by block, in v and omega.
  std::span<const DofBlock> accelerations() const { return blocks_; }
  /// After a derivative() that found no forces: by contact, the acceleration of B's point relative
  /// to A's without contact forces; zero for contacts that do not act [m/s2].
  std::vector<Vec3> free_accelerations() const;

 private:
  struct Carried {
    uint32_t slot;
    Pose pose;  ///< pose and velocity at time `since`
    BodyVelocity velocity;
    double since = 0;     ///< [s]
    BodyVelocity change;  ///< rate of change of the velocity
    /// Of bodies on courses: velocity to restore, velocity at the start of the tick.
    std::optional<BodyVelocity> given, at_start;
  };
  void place_kinematic(double t);
  size_t first_quadrature() const { return 13 * dynamic_.size(); }
  void write_force_rates(double t, std::span<double> out);
  void write_contact_rates(std::span<double> out);
  void solve_forces();
  bool end_foresight();
  size_t first_joint_impulse() const {
    return size() - joint_forces_.size() - drives_.parts().size() - (drives_.empty() ? 0 : 1);
  }
  size_t first_drive_impulse() const { return first_joint_impulse() + joint_forces_.size(); }
  void write_joint_rates(std::span<double> dydt) const;
  const MovingBlocks& moving_blocks();
  void add_quadratures(size_t count);

  std::span<RigidBody> bodies_;
  const SmoothForces& forces_;
  ContactForceMethod method_;
  std::span<const uint32_t> moving_, block_of_;
  std::vector<uint32_t> dynamic_;
  std::vector<Carried> kinematic_;
  std::vector<ode::EntryKind> kinds_;
  const ForceRates* rates_ = nullptr;
  std::vector<uint32_t> causes_;
  std::vector<CauseEffect> effects_;  ///< effects of the causes, as rates
  size_t quadratures_ = 0;
  double now_ = 0;
  Articulation joints_;
  std::vector<double> joint_forces_;
  EventDrives drives_;
  std::vector<BoundedRow> rows_;  ///< rows of drive parts that hold
  std::span<EventContact> contacts_;
  std::vector<double> foresight_;  ///< by contact: SlipForesight::time [s]
  EventTurning turning_;
  ContactForceReport report_;
  std::vector<DofBlock> blocks_, free_;            ///< with and without contact forces
  std::vector<Mat3> inertias_, inverse_inertias_;  ///< by block, world axes, of the last write()
  MovingBlocks moved_;
  std::vector<std::pair<Vec3, Vec3>> kept_forces_;
  std::vector<ForcePoint> points_;
  std::vector<Vec3> point_forces_;
  std::vector<EventContact*> acting_;  ///< closed contacts, in the order of points_
};

}  // namespace tumble
