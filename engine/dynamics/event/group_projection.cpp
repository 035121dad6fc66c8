// What an event group puts right after a step: velocities and positions of closed contacts.
#include "engine/dynamics/event/event_group.hpp"
#include "engine/dynamics/event/projection.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// change_least() as far as the joints leave it, and what it does to them put right.
void change_held(std::span<const Row> rows, std::span<const double> wanted,
                 const Articulation& joints, std::vector<DofBlock>& moving) {
  change_least(rows, Eigen::Map<const Eigen::VectorXd>(wanted.data(), Eigen::Index(wanted.size())),
               moving, joints);
  std::vector<double> pushes(joints.size());
  joints.hold_velocities(moving, pushes);
}

}  // namespace

void EventGroup::book_projection(std::span<const DofBlock> after, ContactCause cause) {
  CauseEffect& booked = group_.books.contacts[size_t(cause)];
  for (size_t i = 0; i < after.size(); ++i) {
    const RigidBody& b = bodies_[group_.bodies[i]];
    if (!b.dynamic()) continue;
    const Mat3 inertia = b.inertia_world();
    const Vec3 dv = after[i].v - b.v, dw = after[i].omega - b.omega;
    const double work = 0.5 * b.mass * dv.dot(after[i].v + b.v) +
                        0.5 * dw.dot(inertia * (after[i].omega + b.omega));
    booked.add({work, work, b.mass * dv, b.mass * b.pose.x.cross(dv) + inertia * dw});
  }
}

const Articulation& EventGroup::joints_now() {
  Articulation& joints = system_.joints();
  if (!joints.empty()) joints.update(bodies_, blocks());
  return joints;
}

/// Kinetic energy of bodies with the blocks' velocities less those that they have.
double EventGroup::energy_between(std::span<const DofBlock> after) const {
  double twice = 0;
  for (size_t i = 0; i < after.size(); ++i) {
    const RigidBody& b = bodies_[group_.bodies[i]];
    if (!b.dynamic()) continue;
    const Vec3 dv = after[i].v - b.v, dw = after[i].omega - b.omega;
    twice += b.mass * dv.squaredNorm() + dw.dot(b.inertia_world() * dw);
  }
  return 0.5 * twice;
}

double EventGroup::inner_energy() const {
  double mass = 0;
  Vec3 momentum = Vec3::Zero();
  for (const uint32_t slot : group_.bodies) {
    const RigidBody& b = bodies_[slot];
    if (!b.dynamic()) continue;
    mass += b.mass;
    momentum += b.mass * b.v;
  }
  std::vector<DofBlock> common(group_.bodies.size());
  for (DofBlock& b : common) b.v = momentum / mass;
  return energy_between(common);
}

EventGroup::JointDrift EventGroup::hold_joints() {
  if (system_.joints().empty()) return {};
  const double open = joints_now().error();
  std::vector<double> pushes(system_.joints().size());
  double before = 2 * open, now = open;
  for (int n = 0;
       n < tolerances::most_projections && now > tolerances::closed_joint && now < before; ++n) {
    std::vector<DofBlock> moving = blocks();
    for (DofBlock& b : moving) b.v.setZero(), b.omega.setZero();
    system_.joints().hold([](const JointRow& r) { return -r.error; }, moving, pushes);
    move_bodies(moving);
    before = now;
    now = joints_now().error();
  }
  std::vector<DofBlock> moving = blocks();
  system_.joints().hold_velocities(moving, pushes);
  const double changed = energy_between(moving);
  book_projection(moving);
  set_velocities(moving);
  return {open, changed};
}

void EventGroup::project() {
  if (!system_.joints().empty()) {
    // A joint that is not quite closed is seen; a velocity that is off by as little is not.
    close_up();
    hold_joints();
    project_velocities();
    return;
  }
  project_velocities();
  close_up();
}

void EventGroup::close_up(ContactCause cause) {
  // One step is enough where nothing but the error of a step is put right; overlap that is worked
  // off goes farther.
  for (int n = 0;
       n < tolerances::most_close_ups && project_positions(cause) > tolerances::closed_distance;
       ++n) {
  }
}

void EventGroup::project_velocities(ContactCause cause) {
  std::vector<Row> rows;
  std::vector<double> wanted;
  for (const EventContact& c : contacts_) {
    if (!c.closed) continue;
    const ElementGap g = push_gap(c, bodies_);
    rows.push_back(row_at(c, g, g.normal));
    wanted.push_back(-g.rate);
    if (c.sliding || !(c.friction > 0)) continue;
    Vec3 t1, t2;
    tangent_frame(g.normal, t1, t2);
    const Vec3 slip = slip_of(c, g, bodies_);
    for (const Vec3& t : {t1, t2}) {
      rows.push_back(row_at(c, g, t));
      wanted.push_back(-t.dot(slip));
    }
  }
  // What rests has no more to put right than the last digits, and a search would go on in them.
  const auto wrong = [](double w) { return std::fabs(w) > tolerances::rounding_speed; };
  if (std::none_of(wanted.begin(), wanted.end(), wrong)) return;
  std::vector<DofBlock> moving = blocks();
  change_held(rows, wanted, joints_now(), moving);
  book_projection(moving, cause);
  set_velocities(moving);
}

double EventGroup::project_positions(ContactCause cause) {
  std::vector<Row> rows;
  std::vector<double> wanted;
  double most = 0;
  for (const EventContact& c : contacts_) {
    const ElementGap g = push_gap(c, bodies_);
    // What leaves again but was found when it was in would be a little deeper at every bounce.
    if (!c.closed && !(c.room(g) < -tolerances::touch_distance)) continue;
    rows.push_back(row_at(c, g, g.normal));
    wanted.push_back(-c.room(g));
    most = std::max(most, std::fabs(wanted.back()));
  }
  if (most <= tolerances::rounding_distance) return 0;
  std::vector<DofBlock> moving = blocks();
  for (DofBlock& b : moving) b.v.setZero(), b.omega.setZero();
  change_held(rows, wanted, joints_now(), moving);
  move_bodies(moving, cause);
  return most;
}

void EventGroup::move_bodies(std::span<const DofBlock> moving, ContactCause cause) {
  for (size_t i = 0; i < moving.size(); ++i) {
    RigidBody& b = bodies_[group_.bodies[i]];
    if (!b.dynamic()) continue;
    CauseEffect& booked = group_.books.contacts[size_t(cause)];
    booked.lost -= b.force.dot(moving[i].v);
    booked.angular_momentum += moving[i].v.cross(b.mass * b.v);
    b.pose.x += moving[i].v;
    b.pose.q = integrate_rotation(b.pose.q, moving[i].omega, 1);
  }
}

Row EventGroup::row_at(const EventContact& c, const ElementGap& g, const Vec3& axis) const {
  const RigidBody &a = bodies_[c.key.body_a], &b = bodies_[c.key.body_b];
  return point_row(block_of_[c.key.body_a], g.x_world - a.pose.x, block_of_[c.key.body_b],
                   g.x_world - b.pose.x, axis);
}

}  // namespace tumble
