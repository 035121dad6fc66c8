#include "engine/dynamics/bodies/free_motion.hpp"

#include "engine/dynamics/bodies/tolerances.hpp"
#include "engine/math/rotation_rates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {

namespace {

Vec3 three_of(std::span<const double> y, size_t at) {
  return {y[at], y[at + 1], y[at + 2]};
}

void put_three(const Vec3& v, std::span<double> y, size_t at) {
  for (size_t k = 0; k < 3; ++k) y[at + k] = v[int(k)];
}

Status check_constants(const MotionConstants& c, size_t index) {
  const std::string place = c.name.empty() ? fmt::format("body {}", index) : c.name;
  if (!(c.mass > 0 && std::isfinite(c.mass))) {
    return Error{
        ErrorCode::invalid_argument, fmt::format("mass must be > 0, got {} kg", c.mass), place, {}};
  }
  // Positive definite: all leading minors are positive.
  const Mat3& I = c.inertia_body;
  const double scale = I.cwiseAbs().maxCoeff();
  const bool positive = I.allFinite() && I(0, 0) > 0 && I(0, 0) * I(1, 1) - I(0, 1) * I(1, 0) > 0 &&
                        I.determinant() > 0 && I.inverse().allFinite();
  if (!positive ||
      !((I - I.transpose()).cwiseAbs().maxCoeff() <= tolerances::inertia_entries * scale)) {
    return Error{ErrorCode::invalid_argument,
                 fmt::format("inertia must be symmetric and positive, got the diagonal {}, {}, {} "
                             "kg m2",
                             I(0, 0), I(1, 1), I(2, 2)),
                 place,
                 {}};
  }
  return {};
}

}  // namespace

Result<FreeMotion> FreeMotion::make(std::vector<MotionConstants> bodies, Forces forces,
                                    size_t quadratures) {
  FreeMotion m;
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (Status s = check_constants(bodies[i], i); !s) return s.error();
    m.inverse_inertia_.push_back(bodies[i].inertia_body.inverse());
    m.kinds_.insert(m.kinds_.end(), 7, ode::EntryKind::position);
    m.kinds_.insert(m.kinds_.end(), 6, ode::EntryKind::momentum);
  }
  m.kinds_.insert(m.kinds_.end(), quadratures, ode::EntryKind::quadrature);
  m.states_.resize(bodies.size());
  m.wrenches_.resize(bodies.size());
  m.constants_ = std::move(bodies);
  m.forces_ = std::move(forces);
  m.quadratures_ = quadratures;
  return m;
}

void FreeMotion::write(size_t body, const Pose& pose, const Vec3& v, const Vec3& omega,
                       std::span<double> y) const {
  const size_t at = body * stride;
  const Quat q = pose.q.normalized();
  const Mat3 R = q.toRotationMatrix();
  put_three(pose.x, y, at);
  y[at + 3] = q.w();
  put_three(q.vec(), y, at + 4);
  put_three(constants_[body].mass * v, y, at + 7);
  const Vec3 momentum_body = constants_[body].inertia_body * (R.transpose() * omega);
  put_three(R * momentum_body, y, at + 10);
}

MotionState FreeMotion::read(size_t body, std::span<const double> y) const {
  const size_t at = body * stride;
  MotionState s;
  s.pose.x = three_of(y, at);
  // Quaternions at stages of a step are not quite of unit length.
  std::array<double, 4> q{y[at + 3], y[at + 4], y[at + 5], y[at + 6]};
  ode::normalise_quaternion(q);
  s.pose.q = Quat(q[0], q[1], q[2], q[3]);
  s.momentum = three_of(y, at + 7);
  s.angular_momentum = three_of(y, at + 10);
  s.v = s.momentum / constants_[body].mass;
  const Mat3 R = s.pose.q.toRotationMatrix();
  const Vec3 omega_body = inverse_inertia_[body] * (R.transpose() * s.angular_momentum);
  s.omega = R * omega_body;
  return s;
}

bool FreeMotion::ask_forces(double t, std::span<double> dydt) {
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench{});
  const std::span<double> rates = quadratures(dydt);
  std::fill(rates.begin(), rates.end(), 0.0);
  if (!forces_) return true;
  MotionForces seen{t, states_, wrenches_, rates};
  return forces_(seen);
}

bool FreeMotion::derivative(double t, std::span<const double> y, std::span<double> dydt) {
  for (size_t i = 0; i < bodies(); ++i) {
    const size_t at = i * stride;
    states_[i] = read(i, y);
    put_three(states_[i].v, dydt, at);
    const Quat q(y[at + 3], y[at + 4], y[at + 5], y[at + 6]);
    const Quat rate = quaternion_rate(q, states_[i].omega);
    dydt[at + 3] = rate.w();
    put_three(rate.vec(), dydt, at + 4);
  }
  if (!ask_forces(t, dydt)) return false;
  for (size_t i = 0; i < bodies(); ++i) {
    put_three(wrenches_[i].force, dydt, i * stride + 7);
    put_three(wrenches_[i].torque, dydt, i * stride + 10);
  }
  return true;
}

bool FreeMotion::position_derivative(double t, std::span<const double> y, std::span<double> dydt) {
  if (quadratures_ > 0) return derivative(t, y, dydt);
  for (size_t i = 0; i < bodies(); ++i) {
    const size_t at = i * stride;
    const MotionState s = read(i, y);
    put_three(s.v, dydt, at);
    const Quat rate = quaternion_rate(Quat(y[at + 3], y[at + 4], y[at + 5], y[at + 6]), s.omega);
    dydt[at + 3] = rate.w();
    put_three(rate.vec(), dydt, at + 4);
  }
  return true;
}

void FreeMotion::normalise(std::span<double> y) const {
  for (size_t i = 0; i < bodies(); ++i) {
    ode::normalise_quaternion(y.subspan(i * stride + 3).first<4>());
  }
}

void FreeMotion::allowed_errors(const ode::Tolerance& tolerance, std::span<const double> y,
                                std::span<double> allowed) const {
  constexpr double second = 1;
  for (size_t i = 0; i < bodies(); ++i) {
    const size_t at = i * stride;
    const double mass = constants_[i].mass;
    // A lower bound of the least moment of inertia.
    const double least = 1 / (inverse_inertia_[i].cwiseAbs() * Vec3::Ones()).maxCoeff();
    const double position = tolerance.position + tolerance.relative * three_of(y, at).norm();
    const double linear =
        mass * tolerance.position / second + tolerance.relative * three_of(y, at + 7).norm();
    const double angular =
        least * tolerance.orientation / second + tolerance.relative * three_of(y, at + 10).norm();
    for (size_t k = 0; k < 3; ++k) {
      allowed[at + k] = position;
      allowed[at + 7 + k] = linear;
      allowed[at + 10 + k] = angular;
    }
    for (size_t k = 3; k < 7; ++k) allowed[at + k] = 0.5 * tolerance.orientation;
  }
  for (size_t i = first_quadrature(); i < size(); ++i) {
    allowed[i] = std::numeric_limits<double>::infinity();
  }
}

std::string FreeMotion::entry_name(size_t entry) const {
  if (entry >= first_quadrature()) return fmt::format("quadrature {}", entry - first_quadrature());
  static constexpr std::array<const char*, stride> parts{
      "x.x", "x.y", "x.z", "q.w", "q.x", "q.y", "q.z", "P.x", "P.y", "P.z", "L.x", "L.y", "L.z"};
  const size_t body = entry / stride;
  const std::string& name = constants_[body].name;
  return fmt::format("{} of {}", parts[entry % stride],
                     name.empty() ? fmt::format("body {}", body) : name);
}

}  // namespace tumble
