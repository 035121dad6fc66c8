#include "engine/dynamics/event/group_state.hpp"

#include "engine/dynamics/bodies/point_mass.hpp"
#include "engine/dynamics/event/find_contacts.hpp"
#include "engine/dynamics/event/prices.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {

void EventStats::include(const EventStats& s) {
  events += s.events;
  work += s.work;
  time_stepped += s.time_stepped;
  impacts += s.impacts;
  steps += s.steps;
  fallbacks += s.fallbacks;
  groups += s.groups;
  windows += s.windows;
  pairs += s.pairs;
  substituted += s.substituted;
  jams += s.jams;
  residual = std::max(residual, s.residual);
  deepest = std::max(deepest, s.deepest);
  impact_work += s.impact_work;
}

std::string EventContext::name(uint32_t slot) const {
  return name_of ? name_of(slot) : fmt::format("body slot {}", slot);
}

uint64_t EventContext::allowed_work(std::span<const RigidBody> bodies,
                                    std::span<const uint32_t> slots, double tick) const {
  uint64_t shares = 0;
  for (const uint32_t slot : slots)
    shares += is_particle(bodies[slot]) ? 1 : prices::body_in_particles;
  const double one = budget_share * double(settings.budget) * double(prices::event);
  const double many = std::max(1.0, double(shares) / double(prices::body_in_particles));
  return uint64_t(one * many * std::sqrt(std::min(1.0, tick / prices::whole_tick)));
}

GroupState::GroupState(std::span<RigidBody> all_bodies, BodyGroup& of,
                       std::span<const uint32_t> places, const SmoothForces& forces,
                       const EventContext& given)
    : bodies(all_bodies),
      group(of),
      block_of(places),
      context(given),
      system(bodies, group.bodies, block_of, forces, context.forces),
      pairs(group.pairs),
      contacts(group.contacts) {
  system.set_courses(context.courses);
  if (group.laid_out) system.take_joints(std::move(*group.laid_out));
  system.set_joints({context.joints, context.couplings}, {group.joints, group.couplings});
  if (context.rates) system.book(*context.rates);
  group.books.joints.resize(group.joints.size());
  group.books.couplings.resize(group.couplings.size());
}

void GroupState::set_velocities(std::span<const DofBlock> blocks) {
  for (size_t i = 0; i < blocks.size(); ++i) {
    RigidBody& b = bodies[group.bodies[i]];
    if (!b.dynamic()) continue;
    b.v = blocks[i].v;
    b.omega = blocks[i].omega;
  }
}

const Articulation& GroupState::joints_now() {
  Articulation& joints = system.joints();
  if (!joints.empty()) joints.update(bodies, blocks(), system.now());
  return joints;
}

ImpactPoint GroupState::impact_point(const EventContact& c, const ElementGap& g) const {
  ImpactPoint p;
  p.a = block_of[c.key.body_a], p.b = block_of[c.key.body_b];
  p.arm_a = g.x_world - bodies[c.key.body_a].pose.x;
  p.arm_b = g.x_world - bodies[c.key.body_b].pose.x;
  p.normal = g.normal;
  p.friction = c.friction;
  p.surface_velocity = c.surface_velocity;
  p.restitution = c.restitution;
  return p;
}

void GroupState::find_contacts(bool accept_overlap) {
  // As far as the bodies may come in the part of the tick, but no more than half the smaller one's
  // radius.
  const double h = part.end - part.begin;
  for (EventPair& p : pairs) {
    const RigidBody &a = bodies[p.a.body], &b = bodies[p.b.body];
    const double reach = (speed_bound(a, h) + speed_bound(b, h)) * h + tolerances::contact_margin;
    p.margin = std::min(
        reach, tolerances::margin_of_size * std::min(a.bounding_radius, b.bounding_radius));
  }
  contacts = find_event_contacts(bodies, pairs, context.narrow_phase, context.hierarchy, contacts,
                                 accept_overlap);
}

double GroupState::deepest() const {
  double deepest = 0;
  for (const EventPair& p : pairs)
    for (const EventContact& c : contacts_of(p))
      deepest = std::max(deepest, -place_now(c, bodies).gap - std::max(c.offset, p.offset));
  return deepest;
}

Error GroupState::error(std::string what, std::string cure) const {
  std::string who = context.name(group.bodies.front());
  if (group.bodies.size() > 1)
    who += fmt::format(" and {} more that may touch it", group.bodies.size() - 1);
  return {ErrorCode::numeric, std::move(what), std::move(who), std::move(cure)};
}

}  // namespace tumble
