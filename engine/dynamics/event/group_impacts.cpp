// What an event group does at one moment: closes contacts, and resolves what collides or jams.
#include "engine/dynamics/event/group_impacts.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/impulses/jam.hpp"
#include "engine/dynamics/event/impulses/laws.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/joints/joint_wrench.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Whether what leaves at a speed comes back before digits of places tell that it was away.
bool hops_unseen(const EventContact& c, const ElementGap& g, std::span<const RigidBody> bodies,
                 double speed) {
  return speed * speed < -2 * least_hop(g.x_world) * free_acceleration(c, g, bodies);
}

/// A contact that was closed may have drifted by what the step and the forces erred.
bool touches(const EventContact& c, const ElementGap& g) {
  return c.room(g) <= (c.closed ? tolerances::closed_distance : tolerances::touch_distance);
}

}  // namespace

/// J (v- + v+)/2 at each point, which adds up to what the impulses did.
void GroupImpacts::book_impulses(std::span<const ImpactPoint> points,
                                 std::span<const Vec3> impulses,
                                 std::span<const double> joint_impulses,
                                 std::span<const DofBlock> after) {
  static const RigidBody nobody = [] {
    RigidBody b;
    b.type = BodyType::fixed;
    return b;
  }();
  const auto mean = [&](uint32_t block) -> BodyVelocity {
    if (block == no_block) return {};
    const RigidBody& b = state_.bodies[state_.group.bodies[block]];
    return {0.5 * (b.v + after[block].v), 0.5 * (b.omega + after[block].omega)};
  };
  const auto body = [&](uint32_t block) -> const RigidBody& {
    return block == no_block ? nobody : state_.bodies[state_.group.bodies[block]];
  };
  MovingBlocks blocks;
  for (uint32_t i = 0; i < after.size(); ++i) {
    blocks.bodies.push_back(&body(i));
    blocks.velocities.push_back(mean(i));
  }
  for (size_t k = 0; k < points.size(); ++k) {
    const ImpactPoint& p = points[k];
    if (p.along) {
      add_row_push(*p.along, impulses[k].x(), ContactCause::normal, blocks,
                   state_.group.books.contacts);
      continue;
    }
    const RigidBody &a = body(p.a), &b = body(p.b);
    const Vec3 x = p.b == no_block ? Vec3(a.pose.x + p.arm_a) : Vec3(b.pose.x + p.arm_b);
    add_push(a, mean(p.a), b, mean(p.b), x, p.normal, impulses[k], p.surface_velocity,
             state_.group.books.contacts);
  }
  if (joint_impulses.empty()) return;
  add_joint_pushes(state_.system.joints(), joint_impulses, blocks, state_.group.books.contacts);
  std::vector<double> shared(joint_impulses.begin(), joint_impulses.end());
  if (state_.system.joints().dependent_rows() > 0)
    take_least_forces(state_.system.joints(), after,
                      typical_arm(state_.bodies, state_.group.bodies), shared);
  state_.group.books.add_impulses(state_.system.joints(), shared);
}

void GroupImpacts::start_motors(EventStats& stats) {
  std::vector<DofBlock> moving;
  const std::vector<double> impulses = drives_.start_motors(moving);
  if (impulses.empty()) return;
  book_impulses({}, {}, impulses, moving);
  state_.set_velocities(moving);
  ++stats.impacts;
}

void GroupImpacts::close_contacts() {
  for (EventContact& c : state_.contacts) {
    const ElementGap g = push_gap(c, state_.bodies);
    c.towards_b = g.normal;
    c.closed = touches(c, g) && (std::fabs(g.rate) <= tolerances::still_speed ||
                                 (g.rate > 0 && hops_unseen(c, g, state_.bodies, g.rate)));
    c.sliding = false;
    if (!c.closed) {
      c.force.setZero();
      continue;
    }
    find_slip(c, g);
  }
}

void GroupImpacts::find_slip(EventContact& c, const ElementGap& g) const {
  const Vec3 slip = slip_of(c, g, state_.bodies);
  const double speed = slip.norm();
  c.sliding = c.friction > 0 && speed > tolerances::sticking_speed;
  if (c.sliding) c.slip = slip / speed;
}

double GroupImpacts::resting_speed() const {
  double events = 0;
  for (const EventContact& c : state_.contacts) events += c.impacts;
  const double beyond = events - tolerances::many_events -
                        tolerances::events_per_contact * double(state_.contacts.size());
  if (!(beyond > 0)) return tolerances::still_speed;
  const double most =
      std::max(tolerances::still_speed,
               tolerances::zeno_of_gravity_tick * (state_.context.gravity * state_.part.tick));
  double speed = tolerances::still_speed;
  for (double n = 0; n < beyond && speed < most; ++n) speed *= 2;
  return std::min(speed, most);
}

bool GroupImpacts::mark_slow(double slow) {
  bool any = false;
  for (EventContact& c : state_.contacts) {
    const ElementGap g = push_gap(c, state_.bodies);
    if (!c.closed) {
      if (!touches(c, g) || !(std::fabs(g.rate) <= slow)) continue;
      c.closed = any = true;
      const Vec3 slip = slip_of(c, g, state_.bodies);
      c.sliding = c.friction > 0 && slip.norm() > slow;
      if (c.sliding) c.slip = slip.normalized();
    } else if (c.sliding && slip_of(c, g, state_.bodies).norm() <= slow) {
      c.sliding = false;
      any = true;
    }
  }
  return any;
}

bool GroupImpacts::unmark_loose(std::span<const EventContact> before) {
  double greatest = 0;
  for (const EventContact& c : state_.contacts) greatest = std::max(greatest, c.force.norm());
  bool any = false;
  for (size_t i = 0; i < state_.contacts.size(); ++i) {
    EventContact& c = state_.contacts[i];
    if (c.closed == before[i].closed && c.sliding == before[i].sliding) continue;
    const double normal = c.towards_b.dot(c.force);
    const double lateral = (c.force - normal * c.towards_b).norm();
    const bool pressed = normal > tolerances::carries_none * greatest;
    const bool held = pressed && lateral < c.friction * normal * (1 - tolerances::on_cone);
    if (!before[i].closed ? !pressed : !held)
      c.closed = before[i].closed, c.sliding = before[i].sliding, c.slip = before[i].slip;
    any |= c.closed != before[i].closed || c.sliding != before[i].sliding;
  }
  return any;
}

bool GroupImpacts::rest_marked(std::span<const EventContact> before) {
  const std::vector<DofBlock> moving = state_.blocks();
  state_.system.set_contacts(state_.contacts);
  const std::vector<double> y = state_.system.read(state_.now);
  std::vector<double> rates(state_.system.size());
  const bool found = state_.system.derivative(state_.now, y, rates);
  state_.set_velocities(moving);
  if (!found || !unmark_loose(before)) return false;
  // What comes to rest along the normals, then across them.
  const std::vector<EventContact> rest = state_.contacts;
  for (size_t i = 0; i < rest.size(); ++i)
    if (before[i].closed) state_.contacts[i].sliding = before[i].sliding;
  projection_.project_velocities(ContactCause::normal);
  state_.contacts = rest;
  projection_.project_velocities(ContactCause::friction);
  // What slid on may have been stopped with the rest, or have turned.
  for (EventContact& c : state_.contacts)
    if (c.closed && c.sliding) find_slip(c, push_gap(c, state_.bodies));
  return true;
}

void GroupImpacts::rest_slow() {
  const double slow = resting_speed();
  const std::vector<EventContact> before = state_.contacts;
  if (!(slow > tolerances::still_speed) || !mark_slow(slow)) return;
  if (!rest_marked(before)) state_.contacts = before;
}

bool GroupImpacts::stop_slowest(EventStats& stats) {
  const std::vector<EventContact> before = state_.contacts;
  std::vector<std::pair<double, size_t>> sliding;
  for (size_t i = 0; i < before.size(); ++i)
    if (before[i].sliding)
      sliding.emplace_back(
          slip_of(before[i], push_gap(before[i], state_.bodies), state_.bodies).norm(), i);
  std::sort(sliding.begin(), sliding.end());
  for (size_t n = 1; n <= sliding.size() && !stop_requested(); ++n) {
    state_.contacts = before;
    for (size_t k = 0; k < n; ++k) state_.contacts[sliding[k].second].sliding = false;
    if (!rest_marked(before)) continue;
    ++stats.jams;
    return true;
  }
  state_.contacts = before;
  return false;
}

void GroupImpacts::take_impulses(std::span<const size_t> touching, const ImpactReport& report,
                                 EventStats& stats) {
  for (size_t k = 0; k < touching.size(); ++k)
    state_.contacts[touching[k]].impulse += report.impulses[k];
  ++stats.impacts;
  stats.residual = std::max(stats.residual, report.residual);
  stats.impact_work += report.work;
}

Status GroupImpacts::collide(std::span<const size_t> touching, std::span<const size_t> limits,
                             EventStats& stats) {
  std::vector<ImpactPoint> points;
  const double slow = resting_speed();
  double fastest = 0;
  for (const size_t i : touching) {
    EventContact& c = state_.contacts[i];
    const ElementGap g = push_gap(c, state_.bodies);
    ImpactPoint& p = points.emplace_back(state_.impact_point(c, g));
    fastest = std::max(fastest, -g.rate);
    if (g.rate >= -tolerances::collision_speed) continue;
    const bool unseen = hops_unseen(c, g, state_.bodies, -c.restitution * g.rate);
    c.impacts += -g.rate >= tolerances::still_speed && !unseen;
    // A series of bounces that comes to its end within the tick (Zeno), or has come to it.
    if (-g.rate < slow || unseen ||
        (c.impacts > tolerances::many_impacts &&
         -g.rate < tolerances::zeno_of_gravity_tick * (state_.context.gravity * state_.part.tick)))
      p.restitution = 0;
  }
  fastest = std::max(fastest, drives_.add_points(limits, slow, points));
  // Nor do those bounce that they pass it on to.
  if (fastest < slow)
    for (ImpactPoint& p : points) p.restitution = 0;
  std::vector<DofBlock> moving = state_.blocks();
  const Articulation& joints = state_.joints_now();
  ImpactReport report = state_.context.law(moving, points, joints);
  // Where the points depend on each other so that no solver answers, one after the other does.
  if (report.status == ImpactStatus::unsolved) {
    ++stats.fallbacks;
    report = sequential_impacts(moving, points, joints);
  }
  if (report.status != ImpactStatus::solved)
    return state_.lost(
        fmt::format("no impulses were found at {} points that satisfy all conditions",
                    points.size()),
        "choose another law of impulses or a smaller tick");
  book_impulses(points, report.impulses, report.joint_impulses, moving);
  state_.set_velocities(moving);
  take_impulses(touching, report, stats);
  return {};
}

bool GroupImpacts::stop_jams(EventStats& stats) {
  std::vector<size_t> closed, sliding;
  std::vector<ImpactPoint> closed_points, points;
  const std::vector<Vec3> free = state_.system.free_accelerations();
  std::vector<Vec3> accelerations;
  for (size_t i = 0; i < state_.contacts.size(); ++i) {
    const EventContact& c = state_.contacts[i];
    if (!c.closed) continue;
    closed.push_back(i);
    accelerations.push_back(free[i]);
    closed_points.push_back(state_.impact_point(c, push_gap(c, state_.bodies)));
    if (!c.sliding) continue;
    sliding.push_back(i);
    points.push_back(closed_points.back());
  }
  std::vector<DofBlock> moving = state_.blocks();
  ImpactReport report;
  int jams = resolve_jams(moving, points, report, state_.joints_now());
  if (jams == 0) {
    moving = state_.blocks();
    report = {};
    jams = resolve_common_jam(moving, closed_points, accelerations, report, state_.joints_now());
    points.swap(closed_points);
    sliding.swap(closed);
  }
  if (jams == 0) return false;
  book_impulses(points, report.impulses, report.joint_impulses, moving);
  state_.set_velocities(moving);
  take_impulses(sliding, report, stats);
  stats.jams += uint64_t(jams);
  return true;
}

Status GroupImpacts::resolve(EventStats& stats) {
  if (stop_requested()) return stopped_error();
  charge_work(2 * prices::gap, state_.contacts.size());
  start_motors(stats);
  std::vector<size_t> touching;
  const std::vector<size_t> limits = drives_.touching();
  bool hits = drives_.hit(limits);
  for (size_t i = 0; i < state_.contacts.size(); ++i) {
    const ElementGap g = push_gap(state_.contacts[i], state_.bodies);
    if (!touches(state_.contacts[i], g)) continue;
    touching.push_back(i);
    hits |= g.rate <
            -(state_.contacts[i].closed ? tolerances::still_speed : tolerances::collision_speed);
  }
  if (hits) {
    if (Status done = collide(touching, limits, stats); !done) return done;
  }
  close_contacts();
  drives_.set_modes();
  rest_slow();
  projection_.project();
  // Where others stick, so does what cannot slide without them.
  for (EventContact& c : state_.contacts)
    if (c.sliding)
      c.sliding =
          slip_of(c, push_gap(c, state_.bodies), state_.bodies).norm() > tolerances::sticking_speed;
  return {};
}

}  // namespace tumble
