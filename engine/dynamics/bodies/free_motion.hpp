#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/math/ode/system.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// The constants of a body in free motion.
struct MotionConstants {
  double mass = 1;                       ///< [kg]
  Mat3 inertia_body = Mat3::Identity();  ///< about the centre of mass, body axes [kg m2]
  std::string name;                      ///< for messages; may be empty
  static MotionConstants of(const RigidBody& body) { return {body.mass, body.inertia_body, {}}; }
};

/// The state of one body and derived quantities; world axes.
struct MotionState {
  Pose pose;                             ///< of the centre of mass; unit quaternion
  Vec3 momentum = Vec3::Zero();          ///< P [kg m/s]
  Vec3 angular_momentum = Vec3::Zero();  ///< L, about the centre of mass [kg m2/s]
  Vec3 v = Vec3::Zero();                 ///< P / m [m/s]
  Vec3 omega = Vec3::Zero();             ///< R I^-1 R^T L [rad/s]

  Vec3 velocity_at(const Vec3& p_world) const { return v + omega.cross(p_world - pose.x); }
  double kinetic_energy() const { return 0.5 * (momentum.dot(v) + angular_momentum.dot(omega)); }
};

/// Sum of forces and torques (about the centre of mass) on a body; world axes.
struct Wrench {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< [N m]

  void add(const MotionState& body, const Vec3& force_world, const Vec3& p_world) {
    force += force_world;
    torque += (p_world - body.pose.x).cross(force_world);
  }
};

/// Arguments and results of an evaluation of the forces.
struct MotionForces {
  double t;  ///< [s]
  std::span<const MotionState> bodies;
  std::span<Wrench> wrenches;          ///< one per body; zero on entry
  std::span<double> quadrature_rates;  ///< such as the power of a force; zero on entry
};

/// Newton's and Euler's equations of rigid bodies (Coutinho 2013, 4.2) for the integrators of
/// math/ode. The state has 13 entries per body, x [m], q (w, x, y, z), P, L in world axes, followed
/// by the quadratures of all bodies:
///   x' = P/m,  q' = (0, omega) q / 2,  P' = force,  L' = torque.
/// L changes by torque only, so that free bodies keep it bitwise.
class FreeMotion final : public ode::System {
 public:
  /// False if the forces have no solution; the step is then refused.
  using Forces = std::function<bool(MotionForces&)>;
  static constexpr size_t stride = 13;

  /// Error if a mass or an inertia is not positive, with the body's name or number. Without
  /// `forces` the bodies move freely.
  static Result<FreeMotion> make(std::vector<MotionConstants> bodies, Forces forces = {},
                                 size_t quadratures = 0);

  size_t bodies() const { return constants_.size(); }
  /// Writes a body's 13 entries; velocity of the centre of mass, world axes.
  void write(size_t body, const Pose& pose, const Vec3& v, const Vec3& omega,
             std::span<double> y) const;
  MotionState read(size_t body, std::span<const double> y) const;
  std::span<double> quadratures(std::span<double> y) const { return y.subspan(first_quadrature()); }

  size_t size() const override { return first_quadrature() + quadratures_; }
  bool derivative(double t, std::span<const double> y, std::span<double> dydt) override;
  /// Does not evaluate the forces unless there are quadratures.
  bool position_derivative(double t, std::span<const double> y, std::span<double> dydt) override;
  void normalise(std::span<double> y) const override;
  std::span<const ode::EntryKind> kinds() const override { return kinds_; }
  /// Allowed errors. Position: position + relative |x|. Orientation: orientation / 2 for each entry
  /// of q. Momenta: what causes an error of that size in one second, plus relative |P|, |L|.
  /// Quadratures do not limit steps.
  void allowed_errors(const ode::Tolerance& tolerance, std::span<const double> y,
                      std::span<double> allowed) const override;
  std::string entry_name(size_t entry) const override;

 private:
  FreeMotion() = default;
  size_t first_quadrature() const { return stride * constants_.size(); }
  bool ask_forces(double t, std::span<double> dydt);

  std::vector<MotionConstants> constants_;
  std::vector<Mat3> inverse_inertia_;
  Forces forces_;
  size_t quadratures_ = 0;
  std::vector<ode::EntryKind> kinds_;
  std::vector<MotionState> states_;
  std::vector<Wrench> wrenches_;
};

}  // namespace tumble
