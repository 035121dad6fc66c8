#include "engine/core/stop.hpp"
#include "engine/dynamics/event/certify.hpp"
#include "engine/world/courses.hpp"
#include "engine/world/present_moment.hpp"
#include "engine/world/state.hpp"
#include "engine/world/tick_common.hpp"
#include "engine/world/tick_forces.hpp"
#include "engine/world/tolerances.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <functional>
#include <type_traits>

namespace tumble {
namespace {

/// The realtime stepper solves for impulses over a tick: its certificates have forces as means over
/// the tick, and no accelerations.
ContactCertificate realtime_certificate(const Contact& contact, int i,
                                        std::span<const RigidBody> bodies, double h) {
  const ContactPoint& point = contact.points[size_t(i)];
  const RigidBody &a = bodies[contact.key.body_a], &b = bodies[contact.key.body_b];
  ContactCertificate c;
  c.key = contact.key;
  c.key.shape_a = contact.shapes.a;
  c.key.shape_b = contact.shapes.b;
  c.feature = point.feature;
  c.x_world = contact_position(contact, i, bodies);
  c.normal = contact.normal;
  c.gap = point.gap;
  c.friction = contact.friction;
  const Vec3 u = b.velocity_at(c.x_world) - a.velocity_at(c.x_world) - contact.surface_velocity;
  c.normal_velocity = c.normal.dot(u);
  c.slip_velocity = u - c.normal_velocity * c.normal;
  c.force = contact_impulse(contact, i) / h;
  c.solver = "realtime";
  const double pressing = c.normal.dot(c.force);
  if (!(pressing > 0)) return c;
  const double across = (c.force - pressing * c.normal).norm();
  if (c.friction > 0) c.place_in_cone = across / (c.friction * pressing);
  c.mode = c.place_in_cone >= 1 - tolerances::certified_sliding || !(c.friction > 0)
               ? ContactMode::sliding
               : ContactMode::sticking;
  return c;
}

ContactCertificates realtime_certificates(const WorldState& s) {
  ContactCertificates out;
  double force = 0, speed = 0;
  for (const Contact* contact : s.contacts.all())
    for (int i = 0; i < contact->count; ++i) {
      out.contacts.push_back(
          realtime_certificate(*contact, i, s.bodies.bodies, s.settings.tick.tick()));
      const ContactCertificate& c = out.contacts.back();
      force = std::max(force, c.force.norm());
      speed = std::max({speed, std::fabs(c.normal_velocity), c.slip_velocity.norm()});
    }
  if (!(force > 0) || !(speed > 0)) return out;
  for (ContactCertificate& c : out.contacts)
    c.complementarity =
        std::min(c.normal.dot(c.force) / force, std::fabs(c.normal_velocity) / speed);
  return out;
}

/// Replaces slots of particles, which are valid only during the query, by names.
void name_particles(const WorldState& s, ContactCertificates& certificates) {
  const auto rename = [&](uint32_t& slot) {
    if (!s.blocks.holds(slot)) return;
    certificates.particles.push_back(s.blocks.name(slot));
    slot = particle_bit | uint32_t(certificates.particles.size() - 1);
  };
  for (ContactCertificate& c : certificates.contacts) rename(c.key.body_a), rename(c.key.body_b);
  for (BodyBalance& b : certificates.bodies) rename(b.body);
}

/// Calls `ask` with the contacts and smooth forces at the present moment, to be solved as the event
/// stepper does. During the call particles have slots.
template <class Ask>
auto ask_moment(WorldState& s, std::string_view solver, const Ask& ask)
    -> std::invoke_result_t<Ask, std::span<const EventContact>, const SmoothForces&,
                            const ContactForceMethod&> {
  const auto method = contact_force_method(solver, s.settings.event.friction_cone);
  if (!method) return method.error();
  const PresentMoment moment(s);
  if (!moment.status()) return moment.status().error();
  std::vector<EventContact> contacts = s.event.contacts;
  s.blocks.restore_contacts(s.particles, s.event.particles, contacts);
  const TickForces forces(s);
  auto answer = ask(contacts, std::cref(forces), *method);
  if (stop_requested()) return stopped_error();
  return answer;
}

}  // namespace

Result<ContactCertificates> World::contact_certificates() const {
  WorldState& s = *state_;
  const Stoppable scope(s.stop);
  if (s.settings.stepper != "event") return realtime_certificates(s);
  const std::vector<CourseMotion> courses = course_changes(s);
  return ask_moment(s, s.settings.event.contact_solver,
                    [&](std::span<const EventContact> contacts, const SmoothForces& forces,
                        const ContactForceMethod& method) {
                      auto certified = certify(s.bodies.bodies, contacts, forces, method,
                                               s.joints.all(), block_links(s), courses);
                      if (certified) name_particles(s, *certified);
                      return certified;
                    });
}

Result<GroupForceProblem> World::contact_force_problem(BodyId body) const {
  WorldState& s = *state_;
  const Stoppable scope(s.stop);
  if (!s.bodies.find(body))
    return Error{ErrorCode::not_found, "this body is gone", "contact_force_problem", {}};
  if (s.settings.stepper != "event")
    return Error{ErrorCode::unsupported,
                 "the realtime stepper finds impulses by sweeps, and poses no problem of forces",
                 "settings.stepper", "choose \"event\""};
  const std::vector<CourseMotion> courses = course_changes(s);
  return ask_moment(s, "automatic",
                    [&](std::span<const EventContact> contacts, const SmoothForces& forces,
                        const ContactForceMethod& method) {
                      return pose_contact_forces(s.bodies.bodies, body.index, contacts, forces,
                                                 method, s.joints.all(), block_links(s), courses);
                    });
}

}  // namespace tumble
