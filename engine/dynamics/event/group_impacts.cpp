// Impulses of an event group at one moment: collisions and jams; and which contacts are closed
// then.
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

/// Whether a body that leaves with this speed falls back before rounding of positions shows that it
/// left.
bool hops_unseen(const EventContact& c, const ElementGap& g, std::span<const RigidBody> bodies,
                 double speed) {
  return speed * speed < -2 * least_hop(g.x_world) * free_acceleration(c, g, bodies);
}

/// A contact that was closed may have drifted by errors of the step and of the forces.
bool touches(const EventContact& c, const ElementGap& g) {
  return c.room(g) <= (c.closed ? tolerances::closed_distance : tolerances::touch_distance);
}

}  // namespace

/// Books J (v- + v+)/2 at each point; these works add up to the change of energy.
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

void GroupImpacts::start_joints(EventStats& stats) {
  std::vector<DofBlock> moving;
  const std::vector<double> impulses = drives_.start_joints(moving);
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
  double fastest = 0;
  for (const size_t i : touching) {
    EventContact& c = state_.contacts[i];
    const ElementGap g = push_gap(c, state_.bodies);
    ImpactPoint& p = points.emplace_back(state_.impact_point(c, g));
    fastest = std::max(fastest, -g.rate);
    if (g.rate >= -tolerances::collision_speed) continue;
    const bool unseen = hops_unseen(c, g, state_.bodies, -c.restitution * g.rate);
    c.impacts += -g.rate >= tolerances::still_speed && !unseen;
    // No restitution at the end of a series of bounces (Zeno), or for bounces that cannot be
    // resolved.
    if (-g.rate < tolerances::still_speed || unseen ||
        (c.impacts > tolerances::many_impacts &&
         -g.rate < tolerances::zeno_of_gravity_tick * (state_.context.gravity * state_.part.tick)))
      p.restitution = 0;
  }
  fastest = std::max(fastest, drives_.add_points(limits, points));
  // Then the points to which the impact is transmitted do not rebound either.
  if (fastest < tolerances::still_speed)
    for (ImpactPoint& p : points) p.restitution = 0;
  std::vector<DofBlock> moving = state_.blocks();
  const Articulation& joints = state_.joints_now();
  ImpactReport report = state_.context.law(moving, points, joints);
  // If no solver answers because points depend on each other, they are resolved one after the
  // other.
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
  start_joints(stats);
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
  projection_.project();
  // A contact whose slip the projection of others has removed does not slide.
  for (EventContact& c : state_.contacts)
    if (c.sliding)
      c.sliding =
          slip_of(c, push_gap(c, state_.bodies), state_.bodies).norm() > tolerances::sticking_speed;
  return {};
}

}  // namespace tumble
