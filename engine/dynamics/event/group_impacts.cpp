// What an event group does at one moment: closes contacts, and resolves what collides or jams.
#include "engine/core/stop.hpp"
#include "engine/dynamics/event/event_group.hpp"
#include "engine/dynamics/event/impulses/jam.hpp"
#include "engine/dynamics/event/impulses/laws.hpp"
#include "engine/dynamics/event/tolerances.hpp"

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
void EventGroup::book_impulses(std::span<const ImpactPoint> points, std::span<const Vec3> impulses,
                               std::span<const double> joint_impulses,
                               std::span<const DofBlock> after) {
  static const RigidBody nobody = [] {
    RigidBody b;
    b.type = BodyType::fixed;
    return b;
  }();
  const auto mean = [&](uint32_t block) -> BodyVelocity {
    if (block == no_block) return {};
    const RigidBody& b = bodies_[group_.bodies[block]];
    return {0.5 * (b.v + after[block].v), 0.5 * (b.omega + after[block].omega)};
  };
  const auto body = [&](uint32_t block) -> const RigidBody& {
    return block == no_block ? nobody : bodies_[group_.bodies[block]];
  };
  for (size_t k = 0; k < points.size(); ++k) {
    const ImpactPoint& p = points[k];
    const RigidBody &a = body(p.a), &b = body(p.b);
    const Vec3 x = p.b == no_block ? Vec3(a.pose.x + p.arm_a) : Vec3(b.pose.x + p.arm_b);
    add_push(a, mean(p.a), b, mean(p.b), x, p.normal, impulses[k], p.surface_velocity,
             group_.books.contacts);
  }
  if (joint_impulses.empty()) return;
  std::vector<const RigidBody*> held;
  std::vector<BodyVelocity> means;
  for (uint32_t i = 0; i < after.size(); ++i) {
    held.push_back(&body(i));
    means.push_back(mean(i));
  }
  add_joint_pushes(system_.joints().rows(), joint_impulses, held, means, group_.books.contacts);
  std::vector<double>& sums = group_.books.joint_impulses;
  sums.resize(joint_impulses.size());
  for (size_t i = 0; i < sums.size(); ++i) sums[i] += joint_impulses[i];
}

void EventGroup::close_contacts() {
  for (EventContact& c : contacts_) {
    const ElementGap g = push_gap(c, bodies_);
    c.towards_b = g.normal;
    c.closed = touches(c, g) && (std::fabs(g.rate) <= tolerances::still_speed ||
                                 (g.rate > 0 && hops_unseen(c, g, bodies_, g.rate)));
    c.sliding = false;
    if (!c.closed) {
      c.force.setZero();
      continue;
    }
    find_slip(c, g);
  }
}

void EventGroup::find_slip(EventContact& c, const ElementGap& g) const {
  const Vec3 slip = slip_of(c, g, bodies_);
  const double speed = slip.norm();
  c.sliding = c.friction > 0 && speed > tolerances::sticking_speed;
  if (c.sliding) c.slip = slip / speed;
}

double EventGroup::resting_speed() const {
  double events = 0;
  for (const EventContact& c : contacts_) events += c.impacts;
  const double beyond =
      events - tolerances::many_events - tolerances::events_per_contact * double(contacts_.size());
  if (!(beyond > 0)) return tolerances::still_speed;
  const double most = std::max(tolerances::still_speed,
                               tolerances::zeno_of_gravity_tick * (context_.gravity * part_.tick));
  double speed = tolerances::still_speed;
  for (double n = 0; n < beyond && speed < most; ++n) speed *= 2;
  return std::min(speed, most);
}

bool EventGroup::mark_slow(double slow) {
  bool any = false;
  for (EventContact& c : contacts_) {
    const ElementGap g = push_gap(c, bodies_);
    if (!c.closed) {
      if (!touches(c, g) || !(std::fabs(g.rate) <= slow)) continue;
      c.closed = any = true;
      const Vec3 slip = slip_of(c, g, bodies_);
      c.sliding = c.friction > 0 && slip.norm() > slow;
      if (c.sliding) c.slip = slip.normalized();
    } else if (c.sliding && slip_of(c, g, bodies_).norm() <= slow) {
      c.sliding = false;
      any = true;
    }
  }
  return any;
}

bool EventGroup::unmark_loose(std::span<const EventContact> before) {
  double greatest = 0;
  for (const EventContact& c : contacts_) greatest = std::max(greatest, c.force.norm());
  bool any = false;
  for (size_t i = 0; i < contacts_.size(); ++i) {
    EventContact& c = contacts_[i];
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

bool EventGroup::rest_marked(std::span<const EventContact> before) {
  const std::vector<DofBlock> moving = blocks();
  system_.set_contacts(contacts_);
  const std::vector<double> y = system_.read(now_);
  std::vector<double> rates(system_.size());
  const bool found = system_.derivative(now_, y, rates);
  set_velocities(moving);
  if (!found || !unmark_loose(before)) return false;
  // What comes to rest along the normals, then across them.
  const std::vector<EventContact> rest = contacts_;
  for (size_t i = 0; i < rest.size(); ++i)
    if (before[i].closed) contacts_[i].sliding = before[i].sliding;
  project_velocities(ContactCause::normal);
  contacts_ = rest;
  project_velocities(ContactCause::friction);
  // What slid on may have been stopped with the rest, or have turned.
  for (EventContact& c : contacts_)
    if (c.closed && c.sliding) find_slip(c, push_gap(c, bodies_));
  return true;
}

void EventGroup::rest_slow() {
  const double slow = resting_speed();
  const std::vector<EventContact> before = contacts_;
  if (!(slow > tolerances::still_speed) || !mark_slow(slow)) return;
  if (!rest_marked(before)) contacts_ = before;
}

bool EventGroup::stop_slowest(EventStats& stats) {
  const std::vector<EventContact> before = contacts_;
  std::vector<std::pair<double, size_t>> sliding;
  for (size_t i = 0; i < before.size(); ++i)
    if (before[i].sliding)
      sliding.emplace_back(slip_of(before[i], push_gap(before[i], bodies_), bodies_).norm(), i);
  std::sort(sliding.begin(), sliding.end());
  for (size_t n = 1; n <= sliding.size() && !stop_requested(); ++n) {
    contacts_ = before;
    for (size_t k = 0; k < n; ++k) contacts_[sliding[k].second].sliding = false;
    if (!rest_marked(before)) continue;
    ++stats.jams;
    return true;
  }
  contacts_ = before;
  return false;
}

ImpactPoint EventGroup::impact_point(const EventContact& c, const ElementGap& g) const {
  ImpactPoint p;
  p.a = block_of_[c.key.body_a], p.b = block_of_[c.key.body_b];
  p.arm_a = g.x_world - bodies_[c.key.body_a].pose.x;
  p.arm_b = g.x_world - bodies_[c.key.body_b].pose.x;
  p.normal = g.normal;
  p.friction = c.friction;
  p.surface_velocity = c.surface_velocity;
  p.restitution = c.restitution;
  return p;
}

void EventGroup::take_impulses(std::span<const size_t> touching, const ImpactReport& report,
                               EventStats& stats) {
  for (size_t k = 0; k < touching.size(); ++k) contacts_[touching[k]].impulse += report.impulses[k];
  ++stats.impacts;
  stats.residual = std::max(stats.residual, report.residual);
  stats.impact_work += report.work;
}

Status EventGroup::collide_now(std::span<const size_t> touching, EventStats& stats) {
  std::vector<ImpactPoint> points;
  const double slow = resting_speed();
  double fastest = 0;
  for (const size_t i : touching) {
    EventContact& c = contacts_[i];
    const ElementGap g = push_gap(c, bodies_);
    ImpactPoint& p = points.emplace_back(impact_point(c, g));
    fastest = std::max(fastest, -g.rate);
    if (g.rate >= -tolerances::collision_speed) continue;
    const bool unseen = hops_unseen(c, g, bodies_, -c.restitution * g.rate);
    c.impacts += -g.rate >= tolerances::still_speed && !unseen;
    // A series of bounces that comes to its end within the tick (Zeno), or has come to it.
    if (-g.rate < slow || unseen ||
        (c.impacts > tolerances::many_impacts &&
         -g.rate < tolerances::zeno_of_gravity_tick * (context_.gravity * part_.tick)))
      p.restitution = 0;
  }
  // Nor do those bounce that they pass it on to.
  if (fastest < slow)
    for (ImpactPoint& p : points) p.restitution = 0;
  std::vector<DofBlock> moving = blocks();
  const Articulation& joints = joints_now();
  ImpactReport report = context_.law(moving, points, joints);
  // Where the points depend on each other so that no solver answers, one after the other does.
  if (report.status == ImpactStatus::unsolved) {
    ++stats.fallbacks;
    report = sequential_impacts(moving, points, joints);
  }
  if (report.status != ImpactStatus::solved)
    return lost(fmt::format("no impulses were found at {} points that satisfy all conditions",
                            points.size()),
                "choose another law of impulses or a smaller tick");
  book_impulses(points, report.impulses, report.joint_impulses, moving);
  set_velocities(moving);
  take_impulses(touching, report, stats);
  return {};
}

bool EventGroup::stop_jams(EventStats& stats) {
  std::vector<size_t> closed, sliding;
  std::vector<ImpactPoint> closed_points, points;
  const std::vector<Vec3> free = system_.free_accelerations();
  std::vector<Vec3> accelerations;
  for (size_t i = 0; i < contacts_.size(); ++i) {
    const EventContact& c = contacts_[i];
    if (!c.closed) continue;
    closed.push_back(i);
    accelerations.push_back(free[i]);
    closed_points.push_back(impact_point(c, push_gap(c, bodies_)));
    if (!c.sliding) continue;
    sliding.push_back(i);
    points.push_back(closed_points.back());
  }
  std::vector<DofBlock> moving = blocks();
  ImpactReport report;
  int jams = resolve_jams(moving, points, report, joints_now());
  if (jams == 0) {
    moving = blocks();
    report = {};
    jams = resolve_common_jam(moving, closed_points, accelerations, report, joints_now());
    points.swap(closed_points);
    sliding.swap(closed);
  }
  if (jams == 0) return false;
  book_impulses(points, report.impulses, report.joint_impulses, moving);
  set_velocities(moving);
  take_impulses(sliding, report, stats);
  stats.jams += uint64_t(jams);
  return true;
}

Status EventGroup::resolve(EventStats& stats) {
  if (stop_requested()) return stopped_error();
  std::vector<size_t> touching;
  bool hits = false;
  for (size_t i = 0; i < contacts_.size(); ++i) {
    const ElementGap g = push_gap(contacts_[i], bodies_);
    if (!touches(contacts_[i], g)) continue;
    touching.push_back(i);
    hits |= g.rate < -(contacts_[i].closed ? tolerances::still_speed : tolerances::collision_speed);
  }
  if (hits) {
    if (Status done = collide_now(touching, stats); !done) return done;
  }
  close_contacts();
  rest_slow();
  project();
  // Where others stick, so does what cannot slide without them.
  for (EventContact& c : contacts_)
    if (c.sliding)
      c.sliding = slip_of(c, push_gap(c, bodies_), bodies_).norm() > tolerances::sticking_speed;
  return {};
}

}  // namespace tumble
