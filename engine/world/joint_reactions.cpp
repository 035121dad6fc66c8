#include "engine/core/disjoint_sets.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/event/event_system.hpp"
#include "engine/dynamics/joints/joint_wrench.hpp"
#include "engine/world/courses.hpp"
#include "engine/world/joint_drives.hpp"
#include "engine/world/present_moment.hpp"
#include "engine/world/tick_common.hpp"
#include "engine/world/tick_forces.hpp"
#include "engine/world/world.hpp"

#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Bodies connected by joints and contacts, with at least one joint.
struct JointedGroup {
  std::vector<uint32_t> slots, joints, couplings;
  std::vector<EventContact> contacts;
};

std::vector<JointedGroup> jointed_groups(std::span<const RigidBody> bodies,
                                         std::span<const BodyLink> links,
                                         const JointsAndCouplings& held,
                                         std::span<const EventContact> contacts) {
  DisjointSets sets(bodies.size());
  const auto moves = [&](uint32_t slot) {
    return slot != no_body && bodies[slot].type != BodyType::fixed;
  };
  const auto join = [&](uint32_t a, uint32_t b) {
    if (moves(a) && moves(b)) sets.join(a, b);
  };
  for (const BodyLink& l : links) join(l.a, l.b);
  for (const EventContact& c : contacts) join(c.key.body_a, c.key.body_b);
  std::vector<JointedGroup> out;
  std::vector<uint32_t> group_of(bodies.size(), no_block);  // by root
  for (const BodyLink& l : links) {
    if (l.joint == BodyLink::none || (!moves(l.a) && !moves(l.b))) continue;
    uint32_t& group = group_of[sets.root(moves(l.a) ? l.a : l.b)];
    if (group == no_block) {
      group = uint32_t(out.size());
      out.emplace_back();
    }
    out[group].joints.push_back(l.joint);
  }
  for (uint32_t k = 0; k < held.couplings.size(); ++k) {
    const uint32_t slot = first_body(held.couplings[k], held.joints, moves);
    if (slot != no_body) out[group_of[sets.root(slot)]].couplings.push_back(k);
  }
  for (uint32_t slot = 0; slot < bodies.size(); ++slot)
    if (moves(slot) && group_of[sets.root(slot)] != no_block)
      out[group_of[sets.root(slot)]].slots.push_back(slot);
  for (const EventContact& c : contacts) {
    const uint32_t slot = moves(c.key.body_a) ? c.key.body_a : c.key.body_b;
    if (moves(slot) && group_of[sets.root(slot)] != no_block)
      out[group_of[sets.root(slot)]].contacts.push_back(c);
  }
  return out;
}

/// Mean forces and torques over the last tick of the realtime stepper's contacts on the bodies, by
/// slot.
std::vector<JointWrench> realtime_pushes(const WorldState& s) {
  const std::span<const RigidBody> bodies = s.bodies.bodies;
  std::vector<JointWrench> out(bodies.size());
  const auto push = [&](uint32_t slot, const Vec3& x, const Vec3& force) {
    out[slot].force += force;
    out[slot].torque += (x - bodies[slot].pose.x).cross(force);
  };
  const auto add = [&](const Contact& c) {
    for (int i = 0; i < c.count; ++i) {
      const Vec3 x = contact_position(c, i, bodies);
      const Vec3 force = contact_impulse(c, i) / s.settings.tick.tick();
      push(c.key.body_a, x, -force);
      push(c.key.body_b, x, force);
    }
  };
  for (const Contact* c : s.contacts.all()) add(*c);
  const auto known = std::as_const(s.particle_contacts).contacts();
  std::vector<Contact> of_particles(known.begin(), known.end());
  s.blocks.restore_contacts(s.particles, s.touching_particles, of_particles);
  for (const Contact& c : of_particles) add(c);
  return out;
}

/// Force along a coordinate: under the event stepper that of the moment; under realtime the last
/// one that acted, since it has no other.
double drive_force(const WorldState& s, const Joint& joint, size_t k, const ActingDrive& now) {
  if (s.settings.stepper == "event") return now.force.total();
  const size_t row = row_count(joint.kind) + k;
  return joint.moving_force[row] + joint.relaxing_force[row];
}

/// Adds the forces that acted along coordinates of joints under realtime.
void add_drive_pushes(const WorldState& s, std::vector<JointWrench>& out) {
  for (uint32_t i = 0; i < s.joints.ids.capacity(); ++i) {
    if (!s.joints.ids.alive(i)) continue;
    const Joint& joint = s.joints.joints[i];
    for_drives(joint, s.bodies.bodies, 0, [&](size_t k, const ActingDrive& d) {
      const double force = drive_force(s, joint, k, d);
      for (const auto& [slot, side] :
           {std::pair{joint.a, &d.row.row.a}, std::pair{joint.b, &d.row.row.b}}) {
        if (slot == no_body) continue;
        out[slot].force += force * side->linear;
        out[slot].torque += force * side->angular;
      }
    });
  }
}

/// The same force as a wrench on B.
void add_drive_wrench(const WorldState& s, const Joint& joint, const JointSides& sides,
                      JointWrench& out) {
  for_drives(joint, s.bodies.bodies, 0, [&](size_t k, const ActingDrive& d) {
    const double force = drive_force(s, joint, k, d);
    const JointWrench more = joint_wrench({&d.row, 1}, {&force, 1}, sides.b.arm);
    out.force += more.force;
    out.torque += more.torque;
  });
}

/// Solves for the forces of a group's joints, and stores them by joint slot.
class ReactionSolver {
 public:
  ReactionSolver(WorldState& state, const SmoothForces& forces, const ContactForceMethod& method)
      : s_(state),
        forces_(forces),
        method_(method),
        courses_(course_changes(state)),
        block_of_(state.bodies.bodies.size(), no_block) {}

  Status add(JointedGroup& group, std::vector<JointWrench>& out) {
    std::vector<RigidBody>& bodies = s_.bodies.bodies;
    for (size_t i = 0; i < group.slots.size(); ++i) block_of_[group.slots[i]] = uint32_t(i);
    EventSystem system(bodies, group.slots, block_of_, forces_, method_);
    system.set_courses(courses_);
    const bool events = s_.settings.stepper == "event";
    system.set_joints(s_.joints.all(), {group.joints, group.couplings},
                      events ? Articulation::Drives::held : Articulation::Drives::none);
    system.set_drive_modes();
    system.set_contacts(group.contacts);
    const std::vector<double> y = system.read(0);
    std::vector<double> rates(y.size());
    if (!system.derivative(0, y, rates))
      return Error{ErrorCode::numeric, "no forces of contacts were found that joints go with",
                   body_label(s_, group.slots.front()), "choose another contact solver"};
    std::vector<double> forces(system.joint_forces().begin(), system.joint_forces().end());
    const Articulation& joints = system.joints();
    take_least_forces(joints, system.accelerations(), typical_arm(bodies, group.slots), forces);
    for (size_t j = 0; j < group.joints.size(); ++j) {
      const size_t first = joints.first_row(j), count = joints.first_row(j + 1) - first;
      const JointSides sides = joint_sides(s_.joints.joints[group.joints[j]], bodies);
      out[group.joints[j]] = joint_wrench(joints.rows().subspan(first, count),
                                          std::span(forces).subspan(first, count), sides.b.arm);
      add_drive_wrench(s_, s_.joints.joints[group.joints[j]], sides, out[group.joints[j]]);
    }
    system.drives().for_forces([&](const DrivePart& p, const JointRow&) {
      const DrivenCoordinate& c = system.drives().coordinate_of(p);
      add_coordinate_wrench(s_.joints.joints[c.joint], c.coordinate, p.force, bodies, out[c.joint]);
    });
    for (size_t k = 0; k < group.couplings.size(); ++k)
      add_coupling(s_.joints.couplings[group.couplings[k]],
                   forces[joints.first_row(group.joints.size()) + k], out);
    return {};
  }

 private:
  /// Adds the wrenches of a coupling's force on both of its joints.
  void add_coupling(const JointCoupling& c, double force, std::vector<JointWrench>& out) const {
    add_coordinate_wrench(s_.joints.joints[c.a], c.x, force, s_.bodies.bodies, out[c.a]);
    add_coordinate_wrench(s_.joints.joints[c.b], c.y, -c.ratio * force, s_.bodies.bodies, out[c.b]);
  }

  WorldState& s_;
  const SmoothForces& forces_;
  ContactForceMethod method_;
  std::vector<CourseMotion> courses_;
  std::vector<uint32_t> block_of_;
};

/// Wrenches by joint slot; the blocks of particles are appended to the bodies.
Result<std::vector<JointWrench>> solve_reactions(WorldState& s) {
  auto method =
      contact_force_method(s.settings.event.contact_solver, s.settings.event.friction_cone);
  if (!method) return method.error();
  method->least = true;
  std::vector<EventContact> contacts;
  std::vector<JointWrench> pushes(s.bodies.bodies.size());
  if (s.settings.stepper == "event") {
    contacts = s.event.contacts;
    s.blocks.restore_contacts(s.particles, s.event.particles, contacts);
  } else {
    pushes = realtime_pushes(s);
    add_drive_pushes(s, pushes);
  }
  const TickForces smooth(s, s.settings.stepper == "event");
  const SmoothForces forces = [&](double t, std::span<const uint32_t> slots) {
    smooth(t, slots);
    for (const uint32_t slot : slots) {
      s.bodies.bodies[slot].force += pushes[slot].force;
      s.bodies.bodies[slot].torque += pushes[slot].torque;
    }
  };
  std::vector<BodyLink> joints;
  s.joints.add_links(joints);
  std::vector<JointWrench> out(s.joints.joints.size());
  ReactionSolver solver(s, forces, *method);
  for (JointedGroup& group : jointed_groups(s.bodies.bodies, joints, s.joints.all(), contacts)) {
    const Status solved = solver.add(group, out);
    if (stop_requested()) return stopped_error();
    if (!solved) return solved.error();
  }
  return out;
}

}  // namespace

Result<std::vector<JointReaction>> World::joint_reactions() const {
  WorldState& s = *state_;
  const Stoppable scope(s.stop);
  std::vector<JointReaction> out;
  if (s.joints.ids.count() == 0) return out;
  std::vector<JointWrench> wrenches;
  {
    set_motor_targets(s);
    const PresentMoment moment(s);
    if (!moment.status()) return moment.status().error();
    auto solved = solve_reactions(s);
    if (!solved) return solved.error();
    wrenches = *std::move(solved);
  }
  for (uint32_t i = 0; i < s.joints.ids.capacity(); ++i) {
    if (!s.joints.ids.alive(i)) continue;
    const Vec3 anchor = joint_sides(s.joints.joints[i], s.bodies.bodies).b.anchor();
    out.push_back({s.joints.ids.at(i), anchor, wrenches[i].force, wrenches[i].torque});
  }
  return out;
}

}  // namespace tumble
