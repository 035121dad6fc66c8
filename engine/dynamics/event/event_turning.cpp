#include "engine/dynamics/event/event_turning.hpp"

#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace tumble {
namespace {

/// Lever arm combined of two materials; 0 unless at least one of them names it.
double combined_arm(std::optional<double> a, std::optional<double> b) {
  if (!a && !b) return 0;
  return std::sqrt(a.value_or(default_turning_friction) * b.value_or(default_turning_friction));
}

bool turns_by_torques(const RigidBody& b) {
  return b.dynamic() && !is_particle(b) && !b.inverse_inertia_world().isZero(0);
}

/// Whether a torque between the two bodies turns any of them.
bool answers(const EventContact& c, std::span<const RigidBody> bodies) {
  const RigidBody &a = bodies[c.key.body_a], &b = bodies[c.key.body_b];
  return !is_particle(a) && !is_particle(b) && (turns_by_torques(a) || turns_by_torques(b));
}

void set_arms(TurningPart& p, const EventContact& c, std::span<const RigidBody> bodies) {
  const Material& a = bodies[c.key.body_a].shapes[c.key.shape_a].material;
  const Material& b = bodies[c.key.body_b].shapes[c.key.shape_b].material;
  p.rolling = combined_arm(a.rolling_friction, b.rolling_friction);
  p.torsional = combined_arm(a.torsional_friction, b.torsional_friction);
}

void set_mode(TurningPart& p, const Turning& now) {
  const double speed = now.rolling.norm();
  if (p.rolling > 0 && speed > tolerances::still_turning) p.axis = now.rolling / speed;
  if (p.torsional > 0 && std::fabs(now.spinning) > tolerances::still_turning)
    p.spin = now.spinning > 0 ? 1 : -1;
}

/// The present direction of rolling; beyond the moment at which rolling ends, where it is only
/// rounding noise, the direction at the start of the step.
Vec3 axis_now(const TurningPart& part, const Vec3& rolling) {
  const double speed = rolling.norm();
  const bool same = rolling.dot(part.axis) >
                    std::max(tolerances::same_slip_cosine * speed, tolerances::no_turning);
  return same ? Vec3(rolling / speed) : part.axis;
}

}  // namespace

Turning turning_of(const TurningPart& part, std::span<const EventContact> contacts,
                   std::span<const RigidBody> bodies) {
  const EventContact& c = contacts[part.contacts[0]];
  Turning out;
  out.normal = place_now(c, bodies).normal;
  const Vec3 all = bodies[c.key.body_b].omega - bodies[c.key.body_a].omega;
  out.spinning = out.normal.dot(all);
  out.rolling = all - out.spinning * out.normal;
  return out;
}

std::vector<TurningPart> turning_parts(std::span<const EventContact> contacts,
                                       std::span<const RigidBody> bodies) {
  std::vector<TurningPart> out;
  size_t of_shapes = 0;  // the first of the parts of the same two shapes
  for (size_t i = 0; i < contacts.size(); ++i) {
    const EventContact& c = contacts[i];
    if (i > 0 && !same_shapes(c.key, contacts[i - 1].key)) of_shapes = out.size();
    if (!c.closed) continue;
    const auto known = std::find_if(
        out.begin() + std::ptrdiff_t(of_shapes), out.end(),
        [&](const TurningPart& p) { return contacts[p.contacts[0]].key.part == c.key.part; });
    if (known != out.end()) {
      if (known->count < 2) known->contacts[known->count] = uint32_t(i);
      ++known->count;
      continue;
    }
    if (!answers(c, bodies)) continue;
    TurningPart p;
    set_arms(p, c, bodies);
    if (p.rolling == 0 && p.torsional == 0) continue;
    p.contacts[0] = uint32_t(i), p.count = 1;
    out.push_back(p);
  }
  std::erase_if(out, [](const TurningPart& p) { return p.count > 2; });
  for (TurningPart& p : out) set_mode(p, turning_of(p, contacts, bodies));
  return out;
}

void EventTurning::set(std::span<const EventContact> contacts, std::span<const RigidBody> bodies) {
  contacts_ = contacts, bodies_ = bodies;
  parts_ = turning_parts(contacts, bodies);
}

void EventTurning::act(std::span<EventContact* const> acting, std::span<const ForcePoint> points) {
  points_.clear();
  part_of_.clear();
  for (size_t i = 0; i < parts_.size(); ++i) {
    TurningPart& part = parts_[i];
    TurningPoint p;
    p.torque = std::exchange(part.torque, Vec3::Zero());
    p.count = 0;
    for (size_t k = 0; k < part.count; ++k) {
      const EventContact* const contact = &contacts_[part.contacts[k]];
      const auto at = std::ranges::lower_bound(acting, contact);
      if (at != acting.end() && *at == contact) p.points[p.count++] = uint32_t(at - acting.begin());
    }
    if (p.count == 0) continue;
    const ForcePoint& first = points[p.points[0]];
    p.a = first.a, p.b = first.b;
    p.normal = first.normal;
    p.rolling = part.rolling, p.torsional = part.torsional;
    p.spin = part.spin;
    if (part.rolls()) {
      const Vec3 rolling = turning_of(part, contacts_, bodies_).rolling;
      p.axis = axis_now(part, rolling);
      p.ahead = part.foresight > 0;
      if (p.ahead) p.bias = rolling / part.foresight;
    }
    points_.push_back(p);
    part_of_.push_back(i);
  }
}

void EventTurning::take() {
  for (size_t k = 0; k < points_.size(); ++k) parts_[part_of_[k]].torque = points_[k].torque;
}

void EventTurning::book(ContactEffects& out) const {
  for (const TurningPart& p : parts_) {
    const ContactKey& key = contacts_[p.contacts[0]].key;
    add_torque(bodies_[key.body_a], bodies_[key.body_b], p.torque, out);
  }
}

SlipForesight EventTurning::rolling_foresight(const TurningPart& part, double h) const {
  if (!part.rolls()) return {};
  const ContactKey& key = contacts_[part.contacts[0]].key;
  double compliance = 0, load = 0;
  for (const uint32_t slot : {key.body_a, key.body_b})
    if (turns_by_torques(bodies_[slot]))
      compliance += bodies_[slot].inverse_inertia_world().trace();
  for (size_t k = 0; k < part.count; ++k) load += load_of(contacts_[part.contacts[k]], bodies_);
  return slip_foresight(part.rolling * load * compliance,
                        turning_of(part, contacts_, bodies_).rolling.norm(), h);
}

bool EventTurning::stiff(double h) const {
  return std::ranges::any_of(
      parts_, [&](const TurningPart& p) { return rolling_foresight(p, h).time > 0; });
}

void EventTurning::foresee(double h, std::span<const DofBlock> accelerations) {
  for (size_t k = 0; k < points_.size(); ++k) {
    TurningPart& part = parts_[part_of_[k]];
    const SlipForesight ahead = rolling_foresight(part, h);
    const Row about = turning_row(points_[k], points_[k].axis);
    if (row_velocity(about, accelerations) > -tolerances::slowing_of_friction * ahead.braking)
      part.foresight = ahead.time;
  }
}

void EventTurning::forget_foresight() {
  for (TurningPart& p : parts_) p.foresight = 0;
}

bool EventTurning::foresees() const {
  return std::ranges::any_of(parts_, [](const TurningPart& p) { return p.foresight > 0; });
}

bool EventTurning::end_foresight(bool solved, std::span<const ForcePoint> points,
                                 std::span<const Vec3> found) {
  bool ended = false;
  for (TurningPoint& p : points_) {
    if (!p.ahead) continue;
    double normal = 0;
    for (const uint32_t k : std::span(p.points).first(p.count))
      normal += points[k].normal.dot(found[k]);
    const double torque = (p.torque - p.normal.dot(p.torque) * p.normal).norm();
    if (solved && !(torque < p.rolling * normal * (1 - tolerances::on_cone))) continue;
    p.ahead = false;
    p.bias.setZero();
    ended = true;
  }
  return ended;
}

}  // namespace tumble
