#include "engine/dynamics/event/event_drives.hpp"

#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

bool DrivePart::saturated() const {
  return !limit() && std::fabs(force) >= most * (1 - tolerances::on_cone);
}

EventDrives::EventDrives(std::span<const Joint> joints, std::span<const uint32_t> which,
                         std::span<const uint32_t> block_of)
    : joints_(joints) {
  for (uint32_t place = 0; place < which.size(); ++place) {
    const uint32_t slot = which[place];
    const Joint& joint = joints[slot];
    if (!joint.drives) continue;
    for (uint32_t k = 0; k < most_coordinates; ++k) {
      if (!acts_by_steps((*joint.drives)[k])) continue;
      DrivenCoordinate& c = coordinates_.emplace_back();
      c.joint = slot, c.place = place, c.coordinate = k;
      c.known = {joint.value[k], joint.rate[k], 0};
      const auto block = [&](uint32_t body) { return body == no_body ? no_block : block_of[body]; };
      c.block_of = {block(joint.a), block(joint.b)};
      add_parts(uint32_t(coordinates_.size() - 1));
    }
  }
  now_.resize(coordinates_.size());
}

void EventDrives::add_parts(uint32_t of) {
  const CoordinateDrive& d = drive_of(coordinates_[of]);
  const auto add = [&](DrivePart::Kind kind, double most, double restitution) {
    DrivePart& p = parts_.emplace_back();
    p.kind = kind, p.of = of, p.most = most, p.restitution = restitution;
  };
  const CoordinateLimits& l = d.limits;
  if (l.hard() && l.lower > -no_bound) add(DrivePart::Kind::lower, no_bound, l.restitution);
  if (l.hard() && l.upper < no_bound) add(DrivePart::Kind::upper, no_bound, l.restitution);
  if (d.motor.kind == MotorKind::velocity && !d.motor.holds_rate_with_any_force() &&
      d.motor.max_force > 0)
    add(DrivePart::Kind::motor, d.motor.max_force, 0);
  if (d.friction > 0) add(DrivePart::Kind::friction, d.friction, 0);
}

size_t EventDrives::row_of(const DrivePart& part) const {
  const DrivenCoordinate& c = coordinates_[part.of];
  return row_count(joints_[c.joint].kind) + c.coordinate;
}

JointRow EventDrives::look(uint32_t of, std::span<const RigidBody> bodies, double t) const {
  const DrivenCoordinate& c = coordinates_[of];
  const Joint& joint = joints_[c.joint];
  FollowedCoordinate known = c.known;
  JointRow row =
      known.look(entry_of(joint.kind).coordinates[c.coordinate], joint_sides(joint, bodies), t);
  row.row.a.block = c.block_of[0];
  row.row.b.block = c.block_of[1];
  return row;
}

double EventDrives::rate(const JointRow& row, uint32_t of,
                         std::span<const RigidBody> bodies) const {
  return row_rate(row, joint_sides(joints_[coordinates_[of].joint], bodies));
}

void EventDrives::follow(std::span<const RigidBody> bodies, double t) {
  for (DrivenCoordinate& c : coordinates_) {
    const Joint& joint = joints_[c.joint];
    c.known.look(entry_of(joint.kind).coordinates[c.coordinate], joint_sides(joint, bodies), t);
  }
}

double EventDrives::room(const DrivePart& p, std::span<const RigidBody> bodies, double t) const {
  const CoordinateLimits& l = drive_of(coordinates_[p.of]).limits;
  const double value = look(p.of, bodies, t).error;
  return (p.kind == DrivePart::Kind::lower ? value - l.lower : l.upper - value) + p.offset;
}

double EventDrives::rate_off(const DrivePart& p, std::span<const RigidBody> bodies,
                             double t) const {
  const double now = rate(look(p.of, bodies, t), p.of, bodies);
  if (p.limit()) return p.inwards() * now;
  return p.kind == DrivePart::Kind::motor ? now - drive_of(coordinates_[p.of]).motor.target_at(t)
                                          : now;
}

double EventDrives::change_held(const DrivePart& p) const {
  return p.kind == DrivePart::Kind::motor ? drive_of(coordinates_[p.of]).motor.target_rate : 0;
}

void EventDrives::set_modes(std::span<const RigidBody> bodies, double t) {
  for (DrivePart& p : parts_) {
    const double off = rate_off(p, bodies, t);
    const bool held = p.holds;
    p.side = 0;
    if (p.limit()) {
      const double reached = held ? tolerances::closed_distance : tolerances::touch_distance;
      p.holds = std::fabs(off) <= tolerances::still_speed && room(p, bodies, t) <= reached;
    } else {
      p.holds = std::fabs(off) <= tolerances::sticking_speed;
      if (!p.holds) p.side = off > 0 ? 1 : -1;
    }
    // A part that begins to hold has no force yet as a first guess.
    if (!p.holds || !held) p.force = 0;
  }
}

void EventDrives::stop_motors(std::span<const RigidBody> bodies, double t,
                              Articulation& joints) const {
  for (size_t i = 0; i < joints.held().size(); ++i) {
    const HeldRow& held = joints.held()[i];
    if (held.use != RowUse::motor) continue;
    const auto of = std::ranges::find_if(coordinates_, [&](const DrivenCoordinate& c) {
      return c.place == held.owner && c.coordinate == joints.coordinate_of(i);
    });
    const double target = drive_of(*of).motor.target_at(t);
    joints.stand(i, std::ranges::any_of(parts_, [&](const DrivePart& p) {
                   return p.limit() && p.of == uint32_t(of - coordinates_.begin()) &&
                          p.inwards() * target < 0 &&
                          room(p, bodies, t) <= tolerances::touch_distance;
                 }));
  }
}

bool EventDrives::accept_depths(std::span<const RigidBody> bodies, double t, double worked_off) {
  bool any = false;
  for (DrivePart& p : parts_) {
    if (!p.limit()) continue;
    p.offset = 0;
    const double depth = -room(p, bodies, t);
    if (!(depth > tolerances::touch_distance)) continue;
    p.offset = std::max(0.0, depth - worked_off);
    any = true;
  }
  return any;
}

void EventDrives::act(std::span<const RigidBody> bodies, double t,
                      std::span<DofBlock> accelerations, std::vector<BoundedRow>& rows) {
  rows.clear();
  for (uint32_t i = 0; i < coordinates_.size(); ++i) now_[i] = look(i, bodies, t);
  for (DrivePart& p : parts_) {
    const JointRow& row = now_[p.of];
    if (p.holds) {
      const double least = p.kind == DrivePart::Kind::lower ? 0 : -p.most;
      const double most = p.kind == DrivePart::Kind::upper ? 0 : p.most;
      rows.push_back({row.row, row.bias - change_held(p), least, most, p.force});
    } else if (!p.limit()) {
      p.force = -p.side * p.most;
      apply_row(row.row, p.force, accelerations);
    }
  }
}

void EventDrives::take(std::span<const BoundedRow> rows) {
  size_t at = 0;
  for (DrivePart& p : parts_)
    if (p.holds) p.force = rows[at++].force;
}

}  // namespace tumble
