// Corrections of an event group after a step: velocities and positions of closed contacts and
// joints.
#include "engine/dynamics/event/group_projection.hpp"

#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/projection.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// change_least() for vectors, compatible with the joints.
void change_with(std::span<const Row> rows, std::span<const double> wanted,
                 const Articulation& joints, std::vector<DofBlock>& moving) {
  change_least(rows, Eigen::Map<const Eigen::VectorXd>(wanted.data(), Eigen::Index(wanted.size())),
               moving, joints);
}

}  // namespace

double GroupProjection::book(std::span<const DofBlock> after) {
  CauseEffect& booked = state_.group.books.contacts[size_t(ContactCause::projection)];
  double twice = 0;
  for (size_t i = 0; i < after.size(); ++i) {
    const RigidBody& b = state_.bodies[state_.group.bodies[i]];
    if (!b.dynamic()) continue;
    const Mat3 inertia = b.inertia_world();
    const Vec3 dv = after[i].v - b.v, dw = after[i].omega - b.omega, turned = inertia * dw;
    const double work = 0.5 * b.mass * dv.dot(after[i].v + b.v) +
                        0.5 * dw.dot(inertia * (after[i].omega + b.omega));
    booked.add({work, work, b.mass * dv, b.mass * b.pose.x.cross(dv) + turned});
    twice += b.mass * dv.squaredNorm() + dw.dot(turned);
  }
  return 0.5 * twice;
}

double GroupProjection::inner_energy() const {
  double mass = 0;
  Vec3 momentum = Vec3::Zero();
  for (const uint32_t slot : state_.group.bodies) {
    const RigidBody& b = state_.bodies[slot];
    if (!b.dynamic()) continue;
    mass += b.mass;
    momentum += b.mass * b.v;
  }
  const Vec3 common = momentum / mass;
  double sum = 0;
  for (const uint32_t slot : state_.group.bodies) {
    const RigidBody& b = state_.bodies[slot];
    if (b.dynamic())
      sum += 0.5 * b.mass * (b.v - common).squaredNorm() + turning_energy(b, b.omega);
  }
  return sum;
}

JointDrift GroupProjection::hold_joints(ContactCause cause) {
  if (state_.system.joints().empty()) return {};
  Articulation& joints = state_.system.joints();
  const std::vector<uint32_t>& slots = state_.group.bodies;
  const auto error = [&] {
    joints.look_where_moved(state_.bodies, state_.system.now());
    return joints.error();
  };
  const auto factor = [&] {
    put_masses(state_.bodies, slots, moving_);
    joints.factor(moving_);
  };
  const double open = error();
  moving_.resize(slots.size());
  put_velocities(state_.bodies, slots, moving_);
  if (open <= tolerances::closed_joint && joints.rates_held(moving_)) return {open, 0};
  bool known = false;  // whether the factorised rows are still near the present ones
  double before = 2 * open, now = open;
  for (int n = 0;
       n < tolerances::most_projections && now > tolerances::closed_joint && now < before; ++n) {
    for (DofBlock& b : moving_) b.v.setZero(), b.omega.setZero();
    pushes_.assign(joints.size(), 0);
    if (!known || now > tolerances::same_rows) factor();
    joints.close(moving_, pushes_);
    move_bodies(moving_, cause);
    before = now;
    now = error();
    known = now <= std::max(tolerances::closed_joint, tolerances::chord_contraction * before);
  }
  put_velocities(state_.bodies, slots, moving_);
  pushes_.assign(joints.size(), 0);
  if (!known || open > tolerances::same_rows) factor();
  joints.hold_velocities(moving_, pushes_);
  const double changed = book(moving_);
  state_.set_velocities(moving_);
  return {open, changed};
}

void GroupProjection::project() {
  charge_work(4 * prices::gap, state_.contacts.size());
  if (!state_.system.joints().empty()) {
    // Positions first: the openings of joints are watched more strictly than such small velocities.
    close_up();
    hold_joints();
    project_velocities();
    return;
  }
  project_velocities();
  close_up();
}

void GroupProjection::close_up(ContactCause cause) {
  // One iteration suffices for the error of a step; overlap that is worked off is larger.
  for (int n = 0;
       n < tolerances::most_close_ups && project_positions(cause) > tolerances::closed_distance;
       ++n) {
  }
}

void GroupProjection::project_velocities() {
  std::vector<Row> rows;
  std::vector<double> wanted;
  for (const EventContact& c : state_.contacts) {
    if (!c.closed) continue;
    const ElementGap g = push_gap(c, state_.bodies);
    rows.push_back(row_at(c, g, g.normal));
    wanted.push_back(-g.rate);
    if (c.sliding || !(c.friction > 0)) continue;
    Vec3 t1, t2;
    tangent_frame(g.normal, t1, t2);
    const Vec3 slip = slip_of(c, g, state_.bodies);
    for (const Vec3& t : {t1, t2}) {
      rows.push_back(row_at(c, g, t));
      wanted.push_back(-t.dot(slip));
    }
  }
  add_turning(rows, wanted);
  drives_.add_velocities(rows, wanted);
  // Nothing to correct but rounding error, in which the iteration would not converge.
  const auto wrong = [](double w) { return std::fabs(w) > tolerances::rounding_speed; };
  if (std::none_of(wanted.begin(), wanted.end(), wrong)) return;
  std::vector<DofBlock> moving = state_.blocks();
  const Articulation& joints = state_.joints_now();
  change_with(rows, wanted, joints, moving);
  std::vector<double> pushes(joints.size());
  joints.hold_velocities(moving, pushes);
  book(moving);
  state_.set_velocities(moving);
}

void GroupProjection::add_turning(std::vector<Row>& rows, std::vector<double>& wanted) const {
  for (const TurningPart& p : turning_parts(state_.contacts, state_.bodies)) {
    const ContactKey& key = state_.contacts[p.contacts[0]].key;
    const Turning now = turning_of(p, state_.contacts, state_.bodies);
    const auto add = [&](const Vec3& axis, double turning) {
      rows.push_back({{state_.block_of[key.body_a], Vec3::Zero(), -axis},
                      {state_.block_of[key.body_b], Vec3::Zero(), axis}});
      wanted.push_back(-turning);
    };
    if (p.rolling > 0 && !p.rolls()) {
      Vec3 t1, t2;
      tangent_frame(now.normal, t1, t2);
      for (const Vec3& t : {t1, t2}) add(t, t.dot(now.rolling));
    }
    if (p.torsional > 0 && p.spin == 0) add(now.normal, now.spinning);
  }
}

double GroupProjection::project_positions(ContactCause cause) {
  std::vector<Row> rows;
  std::vector<double> wanted;
  double most = 0;
  for (const EventContact& c : state_.contacts) {
    const ElementGap g = push_gap(c, state_.bodies);
    // An open contact that overlaps is corrected too, or a bouncing body would sink at every
    // bounce.
    if (!c.closed && !(c.room(g) < -tolerances::touch_distance)) continue;
    rows.push_back(row_at(c, g, g.normal));
    wanted.push_back(-c.room(g));
  }
  drives_.add_positions(rows, wanted);
  for (const double w : wanted) most = std::max(most, std::fabs(w));
  if (most <= tolerances::rounding_distance) return 0;
  std::vector<DofBlock> moving = state_.blocks();
  for (DofBlock& b : moving) b.v.setZero(), b.omega.setZero();
  const Articulation& joints = state_.joints_now();
  change_with(rows, wanted, joints, moving);
  std::vector<double> pushes(joints.size());
  joints.hold_displacements(moving, pushes);
  move_bodies(moving, cause);
  return most;
}

void GroupProjection::move_bodies(std::span<const DofBlock> moving, ContactCause cause) {
  for (size_t i = 0; i < moving.size(); ++i) {
    RigidBody& b = state_.bodies[state_.group.bodies[i]];
    if (!b.dynamic()) continue;
    CauseEffect& booked = state_.group.books.contacts[size_t(cause)];
    booked.lost -= b.force.dot(moving[i].v);
    booked.angular_momentum += moving[i].v.cross(b.mass * b.v);
    b.pose.x += moving[i].v;
    b.pose.q = integrate_rotation(b.pose.q, moving[i].omega, 1);
  }
}

Row GroupProjection::row_at(const EventContact& c, const ElementGap& g, const Vec3& axis) const {
  const RigidBody &a = state_.bodies[c.key.body_a], &b = state_.bodies[c.key.body_b];
  return point_row(state_.block_of[c.key.body_a], g.x_world - a.pose.x,
                   state_.block_of[c.key.body_b], g.x_world - b.pose.x, axis);
}

void GroupProjection::work_off_overlap() {
  const double worked_off = state_.part.tick * state_.context.settings.recovery_speed;
  bool any = false;
  for (EventContact& c : state_.contacts) {
    if (c.offset == 0) continue;
    any = true;
    const double depth = std::max(0.0, -place_now(c, state_.bodies).gap);
    c.offset = std::max(0.0, std::min(c.offset, depth) - worked_off);
  }
  any |= drives_.accept_depths(worked_off);
  if (any) close_up(ContactCause::offset);
}

void GroupProjection::work_off_openings() {
  const double worked_off =
      (state_.part.end - state_.part.begin) * state_.context.settings.recovery_speed;
  // An opening of no more than a step may cause is an error of integration, not one that was there
  // before.
  if (state_.system.joints().accept_errors(state_.bodies, state_.system.now(),
                                           std::max(tolerances::open_per_step, worked_off)))
    hold_joints(ContactCause::offset);
}

}  // namespace tumble
