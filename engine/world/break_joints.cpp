#include "engine/world/break_joints.hpp"

#include "engine/dynamics/joints/joint_loops.hpp"
#include "engine/dynamics/joints/joint_wrench.hpp"
#include "engine/world/joint_drives.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace tumble {
namespace {

bool awake(const WorldState& s, uint32_t slot) {
  return slot != no_body && s.bodies.bodies[slot].awake();
}

bool dynamic(const WorldState& s, uint32_t slot) {
  return slot != no_body && s.bodies.bodies[slot].dynamic();
}

/// Whether time-stepping moved the joint in the last tick; its solver has then updated the joint.
bool time_stepped(const WorldState& s, const Joint& joint) {
  return std::ranges::any_of(std::array{joint.a, joint.b}, [&s](uint32_t slot) {
    return dynamic(s, slot) && s.event.time_stepped[slot].last > 0;
  });
}

/// Under the event stepper, which does not update them: the values of the coordinates, and the
/// impulses of smooth forces along them, by the mean of the forces at both ends of the tick.
void follow_events(WorldState& s, Joint& joint, double h) {
  if (time_stepped(s, joint)) return;
  const size_t kept = row_count(joint.kind);
  if (!dynamic(s, joint.a) && !dynamic(s, joint.b)) joint.moving_force.fill(0);
  std::array<SmoothDrive, most_coordinates> before;
  for (size_t k = 0; k < most_coordinates; ++k)
    if (joint.driven(k))
      before[k] = smooth_force((*joint.drives)[k], joint.value[k], joint.rate[k], 0);
  // Joints that no group has moved by events turn uniformly.
  const auto slot = size_t(&joint - s.joints.joints.data());
  const bool counted = slot < s.event.turned.size() && s.event.turned[slot];
  for (size_t k = 0; counted && k < most_coordinates; ++k)
    joint.value[k] += (*s.event.turned[slot])[k];
  follow_coordinates(joint, s.bodies.bodies, counted ? 0 : h);
  for (size_t k = 0; k < most_coordinates; ++k) {
    if (!joint.driven(k)) continue;
    const SmoothDrive now = smooth_force((*joint.drives)[k], joint.value[k], joint.rate[k], h);
    joint.moving_force[kept + k] += 0.5 * (before[k].total() + now.total());
    joint.motor_impulse[k] += 0.5 * h * (before[k].motor + now.motor);
  }
}

/// Divides what joints bear that their stepper solved one after the other.
void share_loads(WorldState& s, bool events) {
  for (JointLoops& loops : s.joints.loops(s.bodies.bodies)) {
    const bool moved = std::ranges::any_of(loops.bodies, [&s](uint32_t i) { return awake(s, i); });
    const bool in_turn = !events || std::ranges::any_of(loops.joints, [&s](uint32_t j) {
      return time_stepped(s, s.joints.joints[j]);
    });
    if (moved && in_turn) share_impulses(loops, s.bodies.bodies, s.joints.joints);
  }
}

/// Under the event stepper, which knows impulses by row: what joints did over the tick, along the
/// directions of their rows at the end.
void sum_rows(WorldState& s, double h) {
  const auto of_couplings = s.joints.coupling_forces();
  for (uint32_t slot = 0; slot < s.joints.ids.capacity(); ++slot) {
    Joint& joint = s.joints.joints[slot];
    if (!s.joints.ids.alive(slot) || time_stepped(s, joint)) continue;
    JointWrench load = wrench_of_rows(joint, joint_sides(joint, s.bodies.bodies));
    for (size_t k = 0; joint.coupled && k < most_coordinates; ++k)
      if (joint.is_coupled(k))
        add_coordinate_wrench(joint, k, of_couplings[slot][k], s.bodies.bodies, load);
    joint.impulse = {h * load.force, h * load.torque};
  }
}

Status break_joint(WorldState& s, JointId id, const JointWrench& load) {
  const JointDef& def = s.joints.defs[id.index];
  if (s.log_sink)
    s.log_sink(LogLevel::info,
               fmt::format("joint '{}' broke in tick {} under {:.4g} N and {:.4g} N m", def.name,
                           s.tick + 1, load.force.norm(), load.torque.norm()));
  const std::span<const Joint> joint(&s.joints.joints[id.index], 1);
  LedgerEntry lost;
  lost.balance = -energy_of_joints(joint, s.bodies.bodies).total();
  s.ledger.book(LedgerLine::joints, lost);
  ++s.stats.broken_joints;
  s.reserved.joints.release(id);
  return apply_command(s, DestroyJoint{id});
}

}  // namespace

void begin_joints(WorldState& s) {
  s.stats.broken_joints = 0;
  // The realtime solver begins these sums where it first solves a joint in a tick.
  if (s.settings.stepper != "event") return;
  for (const uint32_t slot : s.joints.watched) s.joints.joints[slot].motor_impulse.fill(0);
}

Status end_joints(WorldState& s) {
  const bool events = s.settings.stepper == "event";
  const double h = s.settings.tick.tick();
  for (const uint32_t i : s.joints.watched) {
    Joint& joint = s.joints.joints[i];
    if (events)
      follow_events(s, joint, h);
    else if (joint.followed() && !dynamic(s, joint.a) && !dynamic(s, joint.b))
      follow_coordinates(joint, s.bodies.bodies, h);
  }
  if (events) sum_rows(s, h);
  share_loads(s, events);
  std::vector<std::pair<JointId, JointWrench>> broken;
  for (const uint32_t i : s.joints.watched) {
    const Joint& joint = s.joints.joints[i];
    const JointDef& def = s.joints.defs[i];
    if (!def.breaks()) continue;
    const JointWrench load = mean_load(joint, h);
    if (!(load.force.norm() > def.break_force || load.torque.norm() > def.break_torque)) continue;
    broken.emplace_back(s.joints.ids.at(i), load);
  }
  for (const auto& [id, load] : broken)
    if (Status done = break_joint(s, id, load); !done) return done;
  return {};
}

}  // namespace tumble
