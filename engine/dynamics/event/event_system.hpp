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

/// Sets force and torque of the given bodies to all that acts on them but contacts, from their
/// poses and velocities, at a time [s] since the beginning of the tick.
using SmoothForces = std::function<void(double t, std::span<const uint32_t> bodies)>;

/// How a kinematic body goes through a tick in which its velocity changes evenly.
struct CourseMotion {
  uint32_t slot = 0;
  BodyVelocity at_start;  ///< of the tick
  BodyVelocity change;    ///< per second
};

/// Kinetic energy of a body that turns with an angular velocity [J].
inline double turning_energy(const RigidBody& b, const Vec3& omega) {
  const Vec3 own = b.pose.inverse_direction(omega);
  return 0.5 * own.dot(b.inertia_body * own);
}

/// The equations of motion of a group of bodies within a mode: state (x, q, P, L) of each dynamic
/// body, world axes; contacts closed or not for the whole of a step. Kinematic bodies move by their
/// velocity, or as their courses have it. Derivatives leave the bodies where they were asked for:
/// write() puts them right.
class EventSystem final : public ode::System {
 public:
  /// `moving` are the slots of the group's bodies, none of them fixed; `block_of` gives by slot the
  /// place there, no_block for fixed bodies.
  EventSystem(std::span<RigidBody> bodies, std::span<const uint32_t> moving,
              std::span<const uint32_t> block_of, const SmoothForces& forces,
              const ContactForceMethod& method);

  /// The courses of kinematic bodies in the tick, by slot; before the first read(). Between steps
  /// the bodies have the velocity of the moment; rest_courses() gives them that back which they
  /// had.
  void set_courses(std::span<const CourseMotion> courses);
  void rest_courses();
  /// How much faster a body's centre becomes by its course, at most [m/s2].
  double course_change(uint32_t slot) const;

  /// The equations of joints of an earlier system, whose memory set_joints() uses where they are
  /// laid out alike; and those of this one for the next.
  void take_joints(Articulation&& used) { joints_ = std::move(used); }
  Articulation&& give_joints() { return std::move(joints_); }
  /// Joints that hold all the time, with what couples them; before book(). They must live as long.
  /// What acts along their coordinates by more than smooth forces does so only if asked for.
  void set_joints(const JointsAndCouplings& all, const JointChoice& which,
                  Articulation::Drives drives = Articulation::Drives::held);
  /// The mode of what acts along coordinates that goes with the bodies' present state, where no
  /// step has set it.
  void set_drive_modes();
  /// Integrates what each cause does along with the motion, as quadratures behind the state.
  void book(const ForceRates& rates);
  /// Adds what a step did, from the state at its end; the step began with what read() gave.
  void add_books(std::span<const double> y, GroupBooks& books) const;

  /// Contacts whose `closed` ones act, and the mode of what resists turning there, which goes with
  /// the bodies as they are; they must live as long as steps are taken.
  void set_contacts(std::span<EventContact> contacts) {
    contacts_ = contacts;
    foresight_.assign(contacts.size(), 0);
    turning_.set(contacts, bodies_);
  }
  std::span<const TurningPart> turning() const { return turning_.parts(); }
  /// To be called before a step of h seconds from a state: see slip_foresight().
  void foresee_slip(double t, double h, std::span<const double> from);
  /// Whether the last foresee_slip() found any: what happens then depends on the length of a step.
  bool foresees() const;
  /// The state as it is in the bodies; kinematic bodies are where they are at time t.
  std::vector<double> read(double t);
  /// Puts the bodies to a state.
  void write(double t, std::span<const double> y);
  /// Of the last read() or write(), or set here [s].
  double now() const { return now_; }
  void set_now(double t) { now_ = t; }

  size_t size() const override { return first_quadrature() + quadratures_; }
  bool derivative(double t, std::span<const double> y, std::span<double> dydt) override;
  void normalise(std::span<double> y) const override;
  std::span<const ode::EntryKind> kinds() const override { return kinds_; }
  void allowed_errors(const ode::Tolerance& tolerance, std::span<const double> y,
                      std::span<double> allowed) const override;
  std::string entry_name(size_t entry) const override;

  /// Nothing but joints and forces acts, nor does any of them but within a step change its law:
  /// what a step changes of the kinetic energy is their work.
  bool only_jointed() const;
  /// Of motors of any strength, and of motors and friction that do not hold, in a step, from the
  /// state at its end [J].
  double drive_work(std::span<const double> y) const;
  /// Of the forces on the bodies as they are [W]; the forces in them stay what they were.
  double power(double t);
  /// That of rotors behind armatures included.
  double kinetic_energy() const;
  /// The same of a state to which write() has just put the bodies.
  double kinetic_energy(std::span<const double> y) const;

  /// Of the last derivative.
  const ContactForceReport& report() const { return report_; }
  Articulation& joints() { return joints_; }
  const Articulation& joints() const { return joints_; }
  EventDrives& drives() { return drives_; }
  const EventDrives& drives() const { return drives_; }
  /// Of the last derivative, by row of the joints.
  std::span<const double> joint_forces() const { return joint_forces_; }
  /// Of the last derivative, by block: v and omega hold accelerations.
  std::span<const DofBlock> accelerations() const { return blocks_; }
  /// After a derivative that found no forces: how the points of the contacts move against each
  /// other without any, B as seen from A, zero for those that do not act [m/s2].
  std::vector<Vec3> free_accelerations() const;

 private:
  struct Carried {
    uint32_t slot;
    Pose pose;  ///< and velocity, at a moment
    BodyVelocity velocity;
    double since = 0;                             ///< the moment
    BodyVelocity change;                          ///< per second
    std::optional<BodyVelocity> given, at_start;  ///< of those on a course
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
  std::vector<CauseEffect> effects_;  ///< of the causes, per second
  size_t quadratures_ = 0;
  double now_ = 0;
  Articulation joints_;
  std::vector<double> joint_forces_;
  EventDrives drives_;
  std::vector<BoundedRow> rows_;  ///< of what holds along coordinates
  std::span<EventContact> contacts_;
  std::vector<double> foresight_;  ///< by contact [s]
  EventTurning turning_;
  ContactForceReport report_;
  std::vector<DofBlock> blocks_, free_;            ///< with and without contact forces
  std::vector<Mat3> inertias_, inverse_inertias_;  ///< by block, world axes, of the last write()
  MovingBlocks moved_;
  std::vector<std::pair<Vec3, Vec3>> kept_forces_;
  std::vector<ForcePoint> points_;
  std::vector<Vec3> point_forces_;
  std::vector<EventContact*> acting_;  ///< closed contacts, by point
};

}  // namespace tumble
