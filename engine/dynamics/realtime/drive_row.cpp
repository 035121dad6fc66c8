// Force laws along coordinates of joints in the inner loops of the realtime solver.
#include "engine/dynamics/realtime/drive_row.hpp"

#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

void DriveRow::put(Cause cause, double force, double gain, double least, double most) {
  cause_of[law.add(force, gain, least, most)] = cause;
}

double DriveRow::put_step(Cause cause, double at, double least, double most) {
  const size_t part = law.add_step(at, least, most);
  cause_of[part] = cause;
  return law.step_at(part);
}

/// The implicit share s of a damper's impulse in the relaxing pass: with a its strength over half a
/// sub-step, the passes v -> v / (1 + a) and v -> (1 - (1 - s) a) / (1 + s a) v together give
/// exp(-2 a).
double DriveRow::implicit_share(double hs) const {
  double damping = drive->spring.damping;
  if (drive->motor.kind == MotorKind::position) damping += drive->motor.damping;
  if (at_lower || at_upper) damping += drive->limits.damping;
  const double a = 0.5 * hs * damping * mass / (1 + mass * drive->armature);
  if (a < tolerances::weak_damper) return 2.0 / 3.0 * a;
  const double left = (1 + a) * std::exp(-2 * a);
  return (left - 1 + a) / (a * (1 - left));
}

double DriveRow::target_rate(JointPass pass, double hs) const {
  // The bodies move with the velocity in the middle of the sub-step.
  return drive->motor.target_at(pass == JointPass::moving ? t + 0.5 * hs : t + hs);
}

void DriveRow::set_law(JointPass pass, double hs) {
  law.clear();
  const double half = 0.5 * hs;
  if (pass == JointPass::moving) {
    at_lower = at_upper = false;
    nears_limit = may_bounce(hs);
    set_moving(hs);
  } else {
    set_relaxing(hs);
  }
  const auto put_rest = [&](Cause cause, double at, double bound) {
    return put_step(cause, at, -bound - spent[cause], bound - spent[cause]);
  };
  const double most = half * drive->motor.max_force;
  if (drive->motor.kind == MotorKind::velocity)
    motor_rate = put_rest(motor, target_rate(pass, hs), most);
  if (drive->motor.kind == MotorKind::force) {
    const double force = std::clamp(half * drive->motor.target_at(t + half), -most, most);
    put(motor, force, 0, force, force);
  }
  if (drive->friction > 0) put_rest(friction, 0, half * drive->friction);
  if (drive->armature > 0) put(other, drive->armature * rate, drive->armature, -no_bound, no_bound);
  spent.fill(0);
}

void DriveRow::set_moving(double hs) {
  const double half = 0.5 * hs;
  // Adds -half (k (value + curve/2 + half v - rest) + c v), within bounds.
  const auto pull = [&](Cause cause, double k, double c, double rest, double least, double most,
                        double rest_rate = 0) {
    springs[cause] = -half * k * (value + 0.5 * curve - rest);
    put(cause, springs[cause] + half * c * rest_rate, half * (half * k + c), least, most);
  };
  const CoordinateDrive& d = *drive;
  if (d.spring.stiffness > 0 || d.spring.damping > 0)
    pull(other, d.spring.stiffness, d.spring.damping, d.spring.rest, -no_bound, no_bound);
  if (d.motor.kind == MotorKind::position) {
    const double most = half * d.motor.max_force;
    pull(motor, d.motor.stiffness, d.motor.damping, d.motor.target_at(t + half), -most, most,
         d.motor.target_rate);
  }
  const CoordinateLimits& l = d.limits;
  if (l.hard()) {
    if (!nears_limit) put_hard_limits(hs);
    return;
  }
  at_lower = value < l.lower;
  at_upper = value > l.upper;
  if (l.lower > -no_bound) pull(lower, l.stiffness, at_lower ? l.damping : 0, l.lower, 0, no_bound);
  if (l.upper < no_bound) pull(upper, l.stiffness, at_upper ? l.damping : 0, l.upper, -no_bound, 0);
}

bool DriveRow::limits_bounce() const {
  const CoordinateLimits& l = drive->limits;
  return l.hard() && l.restitution > 0 && !drive->motor.holds_rate_with_any_force();
}

/// Whether a bouncing limit lies within what twice the present speed covers in the sub-step. A
/// limit that is reached otherwise was reached by acceleration within the sub-step, which is no
/// impact.
bool DriveRow::may_bounce(double hs) const {
  if (!limits_bounce()) return false;
  const CoordinateLimits& l = drive->limits;
  const double end = value + curve + 2 * hs * rate;
  return end < l.lower || end > l.upper;
}

void DriveRow::put_hard_limits(double hs) {
  const CoordinateLimits& l = drive->limits;
  const auto speed = [&](double limit) { return (limit - value - curve) / hs; };
  // A coordinate beyond a limit returns no faster than open joints close.
  if (l.lower > -no_bound)
    put_step(lower, std::min(speed(l.lower), tolerances::max_joint_correction), 0, no_bound);
  if (l.upper < no_bound)
    put_step(upper, std::max(speed(l.upper), -tolerances::max_joint_correction), -no_bound, 0);
}

void DriveRow::put_limits(double without, double hs) {
  free = without;
  put_hard_limits(hs);
}

void DriveRow::end_moving(double hs, double kick) {
  const double half = 0.5 * hs;
  const CoordinateDrive& d = *drive;
  moved = v;
  springs[other] -= half * half * d.spring.stiffness * v;
  springs[motor] -= half * half * d.motor.stiffness * v;
  bounce_lower = bounce_upper = blow = 0;
  held_lower = shares[lower];
  held_upper = shares[upper];
  const bool held_below = held_lower > 0, held_above = held_upper < 0;
  if (!d.limits.hard()) {
    springs[lower] -= half * half * d.limits.stiffness * v;
    springs[upper] -= half * half * d.limits.stiffness * v;
    at_lower = at_lower || held_below;
    at_upper = at_upper || held_above;
    return;
  }
  at_lower = held_below;
  at_upper = held_above;
  if (!(held_below || held_above) || !nears_limit) return;
  // Impact speed for a constant acceleration from the start of the sub-step to the limit.
  const double acceleration = (free - rate) / kick;
  const double way = (held_below ? d.limits.lower : d.limits.upper) - value;
  const double speed = std::sqrt(std::max(0.0, rate * rate + 2 * acceleration * way));
  const bool approaches = held_below ? free < 0 : free > 0;
  const double rest = tolerances::limit_rest_speed + 2 * hs * std::fabs(acceleration);
  if (!approaches || !(speed > rest)) return;
  (held_below ? bounce_lower : bounce_upper) = d.limits.restitution * speed;
}

void DriveRow::set_relaxing(double hs) {
  const double half = 0.5 * hs;
  const CoordinateDrive& d = *drive;
  const double share = implicit_share(hs);
  const auto pull = [&](Cause cause, double c, double least, double most, double rest_rate = 0) {
    put(cause, springs[cause] - half * (1 - share) * c * moved + half * c * rest_rate,
        half * share * c, least, most);
  };
  if (d.spring.stiffness > 0 || d.spring.damping > 0)
    pull(other, d.spring.damping, -no_bound, no_bound);
  if (d.motor.kind == MotorKind::position) {
    const double most = half * d.motor.max_force;
    pull(motor, d.motor.damping, -most, most, d.motor.target_rate);
  }
  const CoordinateLimits& l = d.limits;
  if (l.hard()) {
    // Removes the speed with which it returned from beyond a limit: the impulses of a limit in both
    // passes together never pull.
    const bool below = at_lower || value <= l.lower, above = at_upper || value >= l.upper;
    // Between two limits that are both reached nothing can bounce.
    const double up = above ? 0 : bounce_lower, down = below ? 0 : bounce_upper;
    if (below) put_step(lower, up, -held_lower, no_bound);
    if (above) put_step(upper, -down, -no_bound, -held_upper);
    return;
  }
  if (at_lower) pull(lower, l.damping, 0, no_bound);
  if (at_upper) pull(upper, l.damping, -no_bound, 0);
}

double DriveRow::solve(double free) {
  const ForceLaw::Solution s = law.solve(free, mass);
  shares.fill(0);
  for (size_t i = 0; i < law.size(); ++i) shares[cause_of[i]] += s.parts[i];
  v = s.v;
  return s.force;
}

bool DriveRow::holds_rate() const {
  return drive->motor.kind == MotorKind::velocity && v == motor_rate;
}

double DriveRow::taken(double first, double last) const {
  double held = shares[friction] + drive->armature * (noted - v);
  if (holds_rate()) held += shares[motor];
  if (drive->limits.hard()) held += shares[lower] + shares[upper];
  return -0.5 * held * (first + last - 2 * held_rate()) -
         0.5 * drive->armature * (v - noted) * (v + noted - 2 * held_rate());
}

void DriveRow::add_hit(Cause cause, double impulse, double work) {
  spent[cause] = impulse;
  if (cause == motor) motor_impulse += impulse;
  (cause == motor ? motor_work : cause == friction ? friction_work : limit_work) += work;
}

void DriveRow::add_up(JointPass pass) {
  const double mean = 0.5 * (before + v), of_limits = shares[lower] + shares[upper];
  motor_impulse += shares[motor];
  motor_work += shares[motor] * mean;
  friction_work += shares[friction] * mean;
  if (pass == JointPass::moving) entered = before;
  if (!drive->limits.hard())
    limit_work += of_limits * mean;
  else if (pass == JointPass::relaxing)
    limit_work += (held_lower + held_upper + of_limits) * 0.5 * (entered + v);
}

}  // namespace tumble
