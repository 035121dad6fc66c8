#include "engine/dynamics/event/event_system.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/slow_slip.hpp"
#include "engine/dynamics/event/tolerances.hpp"
#include "engine/dynamics/joints/joint_wrench.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

constexpr size_t entries_per_body = 13;

Vec3 triple(std::span<const double> y, size_t at) {
  return {y[at], y[at + 1], y[at + 2]};
}
void put_triple(std::span<double> y, size_t at, const Vec3& v) {
  y[at] = v.x(), y[at + 1] = v.y(), y[at + 2] = v.z();
}

/// Angular velocity of a body with angular momentum L. The product of the rotated tensor and its
/// rotated inverse is off by the error of orthogonality of the rotation matrix; the remainder is
/// corrected, since otherwise every tick would rotate the angular momentum in the same sense.
Vec3 turn_of(const Mat3& inertia, const Mat3& inverse, const Vec3& L) {
  const Vec3 turn = inverse * L;
  return turn + inverse * (L - inertia * turn);
}

/// R m R^T of a symmetric tensor m.
Mat3 turned(const Mat3& R, const Mat3& m) {
  const Mat3 half = R * m;
  Mat3 out;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k <= i; ++k)
      out(i, k) = out(k, i) = half(i, 0) * R(k, 0) + half(i, 1) * R(k, 1) + half(i, 2) * R(k, 2);
  return out;
}

}  // namespace

EventSystem::EventSystem(std::span<RigidBody> bodies, std::span<const uint32_t> moving,
                         std::span<const uint32_t> block_of, const SmoothForces& forces,
                         const ContactForceMethod& method)
    : bodies_(bodies),
      forces_(forces),
      method_(method),
      moving_(moving),
      block_of_(block_of),
      blocks_(moving.size()),
      inertias_(moving.size(), Mat3::Zero()),
      inverse_inertias_(moving.size(), Mat3::Zero()) {
  for (const uint32_t slot : moving_) {
    if (bodies[slot].dynamic()) {
      dynamic_.push_back(slot);
    } else {
      const RigidBody& b = bodies[slot];
      Carried& k = kinematic_.emplace_back();
      k.slot = slot, k.pose = b.pose, k.velocity = {b.v, b.omega};
    }
  }
  using enum ode::EntryKind;
  for (size_t i = 0; i < dynamic_.size(); ++i) {
    kinds_.insert(kinds_.end(), 7, position);
    kinds_.insert(kinds_.end(), 6, momentum);
  }
}

void EventSystem::add_quadratures(size_t count) {
  quadratures_ += count;
  kinds_.insert(kinds_.end(), count, ode::EntryKind::quadrature);
}

void EventSystem::set_joints(const JointsAndCouplings& all, const JointChoice& which,
                             Articulation::Drives drives) {
  if (which.joints.empty()) {
    joints_ = {};
    return;
  }
  if (!joints_.renew(all, which, block_of_, bodies_, blocks_.size(), drives))
    joints_ = Articulation(all, which, block_of_, bodies_, blocks_.size(), drives);
  joint_forces_.resize(joints_.size());
  if (drives == Articulation::Drives::held)
    drives_ = EventDrives(all.joints, which.joints, block_of_);
  quadratures_ = 0;
  add_quadratures(size() - first_joint_impulse());
}

void EventSystem::set_drive_modes() {
  drives_.stop_motors(bodies_, now_, joints_);
  drives_.set_modes(bodies_, now_);
}

void EventSystem::book(const ForceRates& rates) {
  rates_ = &rates;
  causes_ = rates.causes(moving_);
  effects_.resize(causes_.size());
  add_quadratures(CauseEffect::numbers * (causes_.size() + integrated_causes));
}

void EventSystem::add_books(std::span<const double> y, GroupBooks& books) const {
  const auto of_joints = y.subspan(first_joint_impulse(), joint_forces_.size());
  std::vector<double> impulses(of_joints.begin(), of_joints.end());
  if (joints_.dependent_rows() > 0)
    take_least_forces(joints_, blocks_, typical_arm(bodies_, dynamic_), impulses);
  books.add_impulses(joints_, impulses);
  books.add_impulses(drives_, y.subspan(first_drive_impulse(), drives_.parts().size()));
  if (!rates_) return;
  books.causes = causes_;
  books.forces.resize(causes_.size());
  for (size_t i = 0; i < causes_.size() + integrated_causes; ++i) {
    const auto entry = y.subspan(first_quadrature() + CauseEffect::numbers * i);
    const CauseEffect e = CauseEffect::read(entry);
    (i < causes_.size() ? books.forces[i] : books.contacts[i - causes_.size()]).add(e);
  }
}

void EventSystem::write_force_rates(double t, std::span<double> out) {
  std::fill(effects_.begin(), effects_.end(), CauseEffect{});
  rates_->rates(t, moving_, causes_, effects_);
  for (size_t i = 0; i < effects_.size(); ++i)
    effects_[i].write(out.subspan(CauseEffect::numbers * i));
}

void EventSystem::write_contact_rates(std::span<double> out) {
  ContactEffects sum;
  for (size_t k = 0; k < acting_.size(); ++k) {
    const EventContact& c = *acting_[k];
    const RigidBody &a = bodies_[c.key.body_a], &b = bodies_[c.key.body_b];
    add_push(a, {a.v, a.omega}, b, {b.v, b.omega}, b.pose.x + points_[k].arm_b, points_[k].normal,
             c.force, c.surface_velocity, sum);
  }
  turning_.book(sum);
  if (!joints_.empty()) {
    const MovingBlocks& blocks = moving_blocks();
    add_joint_pushes(joints_, joint_forces_, blocks, sum);
    drives_.for_forces([&](const DrivePart& p, const JointRow& row) {
      add_row_push(row.row, p.force, cause_of(p), blocks, sum);
    });
  }
  for (size_t i = 0; i < integrated_causes; ++i)
    sum[i].write(out.subspan(CauseEffect::numbers * i));
}

const MovingBlocks& EventSystem::moving_blocks() {
  moved_.bodies.clear();
  moved_.velocities.clear();
  for (const uint32_t slot : moving_) {
    moved_.bodies.push_back(&bodies_[slot]);
    moved_.velocities.push_back({bodies_[slot].v, bodies_[slot].omega});
  }
  return moved_;
}

/// Writes the forces of joints and drive parts, whose integrals are impulses, and the power of the
/// latter.
void EventSystem::write_joint_rates(std::span<double> dydt) const {
  std::copy(joint_forces_.begin(), joint_forces_.end(), &dydt[first_joint_impulse()]);
  if (drives_.empty()) return;
  double power = 0;
  for (size_t i = 0; i < joint_forces_.size(); ++i)
    if (joints_.held()[i].use == RowUse::motor) power += joint_forces_[i] * joints_.held()[i].rate;
  size_t at = first_drive_impulse();
  for (const DrivePart& p : drives_.parts()) dydt[at++] = p.force;
  drives_.for_forces([&](const DrivePart& p, const JointRow& row) {
    power += p.force * drives_.rate(row, p.of, bodies_);
  });
  dydt[at] = power;
}

double EventSystem::drive_work(std::span<const double> y) const {
  return drives_.empty() ? 0 : y[first_drive_impulse() + drives_.parts().size()];
}

void EventSystem::place_kinematic(double t) {
  for (const Carried& k : kinematic_) {
    RigidBody& b = bodies_[k.slot];
    const double passed = t - k.since;
    b.v = k.velocity.v + passed * k.change.v;
    b.omega = k.velocity.omega + passed * k.change.omega;
    b.pose.x = k.pose.x + passed * (k.velocity.v + 0.5 * passed * k.change.v);
    b.pose.q =
        integrate_rotation(k.pose.q, k.velocity.omega + 0.5 * passed * k.change.omega, passed);
  }
}

void EventSystem::set_courses(std::span<const CourseMotion> courses) {
  for (Carried& k : kinematic_) {
    const CourseMotion* const at = course_of(courses, k.slot);
    if (!at) continue;
    k.given = k.velocity;
    k.at_start = at->at_start;
    k.change = at->change;
  }
}

double EventSystem::course_change(uint32_t slot) const {
  const auto at = std::ranges::lower_bound(kinematic_, slot, {}, &Carried::slot);
  return at == kinematic_.end() || at->slot != slot ? 0 : at->change.v.norm();
}

void EventSystem::rest_courses() {
  for (const Carried& k : kinematic_)
    if (k.given) bodies_[k.slot].v = k.given->v, bodies_[k.slot].omega = k.given->omega;
}

std::vector<double> EventSystem::read(double t) {
  now_ = t;
  for (Carried& k : kinematic_) {
    RigidBody& b = bodies_[k.slot];
    if (k.at_start) {
      b.v = k.at_start->v + t * k.change.v;
      b.omega = k.at_start->omega + t * k.change.omega;
    }
    k.pose = b.pose;
    k.velocity = {b.v, b.omega};
    k.since = t;
  }
  std::vector<double> y(size());
  for (size_t i = 0; i < dynamic_.size(); ++i) {
    const RigidBody& b = bodies_[dynamic_[i]];
    const size_t at = entries_per_body * i;
    put_triple(y, at, b.pose.x);
    y[at + 3] = b.pose.q.w(), y[at + 4] = b.pose.q.x();
    y[at + 5] = b.pose.q.y(), y[at + 6] = b.pose.q.z();
    put_triple(y, at + 7, b.mass * b.v);
    put_triple(y, at + 10, b.inertia_world() * b.omega);
  }
  return y;
}

void EventSystem::write(double t, std::span<const double> y) {
  now_ = t;
  place_kinematic(t);
  for (size_t i = 0; i < dynamic_.size(); ++i) {
    RigidBody& b = bodies_[dynamic_[i]];
    const size_t at = entries_per_body * i;
    b.pose.x = triple(y, at);
    b.pose.q = Quat(y[at + 3], y[at + 4], y[at + 5], y[at + 6]);
    // Quaternions at stages of a step are not quite of unit length; normalising gives the rotation.
    b.pose.q.coeffs() /= b.pose.q.norm();
    b.v = b.inverse_mass * triple(y, at + 7);
    const uint32_t block = block_of_[dynamic_[i]];
    const Mat3 R = b.pose.q.toRotationMatrix();
    const Mat3& inertia = inertias_[block] = turned(R, b.inertia_body);
    const Mat3& inverse = inverse_inertias_[block] = turned(R, b.inverse_inertia_body);
    b.omega = turn_of(inertia, inverse, triple(y, at + 10));
  }
}

void EventSystem::foresee_slip(double t, double h, std::span<const double> from) {
  std::fill(foresight_.begin(), foresight_.end(), 0.0);
  turning_.forget_foresight();
  const auto slides = [](const EventContact& c) { return c.closed && c.sliding; };
  if (std::none_of(contacts_.begin(), contacts_.end(), slides) && turning_.parts().empty()) return;
  write(t, from);
  const auto stiff = [&](const EventContact& c) { return slip_foresight(c, bodies_, h).time > 0; };
  if (std::none_of(contacts_.begin(), contacts_.end(), stiff) && !turning_.stiff(h)) return;
  std::vector<double> rates(size());
  if (!derivative(t, from, rates)) return;
  for (size_t k = 0; k < points_.size(); ++k) {
    const EventContact& c = *acting_[k];
    if (!slides(c)) continue;
    const SlipForesight ahead = slip_foresight(c, bodies_, h);
    const ForcePoint& p = points_[k];
    const Row along = point_row(p.a, p.arm_a, p.b, p.arm_b, p.slip);
    const double faster = row_velocity(along, blocks_) + p.slip.dot(p.tangential_bias);
    if (faster > -tolerances::slowing_of_friction * ahead.braking)
      foresight_[size_t(&c - contacts_.data())] = ahead.time;
  }
  turning_.foresee(h, blocks_);
}

/// Treats a slip explicitly again where the implicit friction would stop it within the foreseen
/// time. Returns whether there was any.
bool EventSystem::end_foresight() {
  bool ended = turning_.end_foresight(report_.solved, points_, point_forces_);
  for (size_t k = 0; k < points_.size(); ++k) {
    ForcePoint& p = points_[k];
    if (!acting_[k]->sliding || p.sliding) continue;
    const double normal = p.normal.dot(point_forces_[k]);
    const double lateral = (point_forces_[k] - normal * p.normal).norm();
    if (report_.solved && !(lateral < p.friction * normal * (1 - tolerances::on_cone))) continue;
    p.sliding = ended = true;
  }
  return ended;
}

bool EventSystem::foresees() const {
  return std::any_of(foresight_.begin(), foresight_.end(), [](double t) { return t > 0; }) ||
         turning_.foresees();
}

std::vector<Vec3> EventSystem::free_accelerations() const {
  std::vector<Vec3> out(contacts_.size(), Vec3::Zero());
  for (size_t k = 0; k < points_.size(); ++k) {
    const ForcePoint& p = points_[k];
    Vec3& a = out[size_t(acting_[k] - contacts_.data())];
    a = p.bias * p.normal + p.tangential_bias;
    for (int i = 0; i < 3; ++i)
      a[i] += row_velocity(point_row(p.a, p.arm_a, p.b, p.arm_b, Vec3::Unit(i)), blocks_);
  }
  return out;
}

void EventSystem::solve_forces() {
  const bool ahead = foresees();
  if (ahead) free_ = blocks_;
  const auto solve = [&] {
    report_ = solve_contact_forces(blocks_, points_, method_, point_forces_, joints_, rows_,
                                   turning_.points());
  };
  solve();
  while (ahead && end_foresight()) {
    blocks_ = free_;
    solve();
  }
  if (!report_.solved) return;
  drives_.take(rows_);
  turning_.take();
}

bool EventSystem::only_jointed() const {
  const auto acts = [](const EventContact& c) { return c.closed; };
  const auto holds = [](const DrivePart& p) { return p.holds; };
  return !joints_.empty() && kinematic_.empty() &&
         std::none_of(contacts_.begin(), contacts_.end(), acts) &&
         std::ranges::none_of(drives_.parts(), holds);
}

double EventSystem::power(double t) {
  kept_forces_.clear();
  for (const uint32_t slot : dynamic_)
    kept_forces_.emplace_back(bodies_[slot].force, bodies_[slot].torque);
  forces_(t, moving_);
  double sum = 0;
  for (size_t i = 0; i < dynamic_.size(); ++i) {
    RigidBody& b = bodies_[dynamic_[i]];
    sum += b.force.dot(b.v) + b.torque.dot(b.omega);
    b.force = kept_forces_[i].first, b.torque = kept_forces_[i].second;
  }
  return sum;
}

double EventSystem::kinetic_energy() const {
  double sum = 0;
  for (const uint32_t slot : dynamic_) {
    const RigidBody& b = bodies_[slot];
    sum += 0.5 * b.mass * b.v.squaredNorm() + turning_energy(b, b.omega);
  }
  return sum + joints_.rotor_energy(bodies_);
}

double EventSystem::kinetic_energy(std::span<const double> y) const {
  double twice = 0;
  for (size_t i = 0; i < dynamic_.size(); ++i) {
    const RigidBody& b = bodies_[dynamic_[i]];
    const size_t at = entries_per_body * i;
    twice += b.v.dot(triple(y, at + 7)) + b.omega.dot(triple(y, at + 10));
  }
  return 0.5 * twice + joints_.rotor_energy(bodies_);
}

bool EventSystem::derivative(double t, std::span<const double> y, std::span<double> dydt) {
  if (stop_requested()) return false;
  charge_work(prices::body, moving_.size());
  write(t, y);
  if (rates_) write_force_rates(t, dydt.subspan(first_quadrature()));
  forces_(t, moving_);
  for (const uint32_t slot : moving_) {
    const RigidBody& b = bodies_[slot];
    DofBlock& block = blocks_[block_of_[slot]];
    block = DofBlock{};
    if (!b.dynamic()) continue;
    block.inverse_mass = b.inverse_mass;
    const Mat3& inverse = block.inverse_inertia = inverse_inertias_[block_of_[slot]];
    block.v = b.inverse_mass * b.force;
    block.omega = inverse * (b.torque - b.omega.cross(inertias_[block_of_[slot]] * b.omega));
  }
  for (const Carried& k : kinematic_) {
    blocks_[block_of_[k.slot]].v = k.change.v;
    blocks_[block_of_[k.slot]].omega = k.change.omega;
  }
  drives_.act(bodies_, t, blocks_, rows_);
  if (!joints_.empty()) {
    joints_.look(bodies_, t);
    joints_.factor(blocks_, inertias_);
    std::fill(joint_forces_.begin(), joint_forces_.end(), 0.0);
    joints_.hold_accelerations(blocks_, joint_forces_);
  }
  points_.clear();
  point_forces_.clear();
  acting_.clear();
  for (EventContact& c : contacts_) {
    if (!c.closed) continue;
    charge_work(2 * prices::gap);
    const ElementGap g = push_gap(c, bodies_);
    if (!g.regular) {
      c.force.setZero();
      continue;
    }
    acting_.push_back(&c);
    const RigidBody &a = bodies_[c.key.body_a], &b = bodies_[c.key.body_b];
    ForcePoint p;
    p.a = block_of_[c.key.body_a], p.b = block_of_[c.key.body_b];
    p.arm_a = g.x_world - a.pose.x, p.arm_b = g.x_world - b.pose.x;
    p.normal = g.normal;
    p.bias = g.bias, p.tangential_bias = g.tangential_bias;
    p.friction = c.friction;
    p.sliding = c.sliding;
    if (c.sliding) {
      Vec3 slip = b.velocity_at(g.x_world) - a.velocity_at(g.x_world) - c.surface_velocity;
      slip -= g.normal.dot(slip) * g.normal;
      // Beyond the end of slip its direction is only rounding noise; the last direction keeps the
      // equations smooth there.
      const double speed = slip.norm();
      p.slip = slip.dot(c.slip) >
                       std::max(tolerances::same_slip_cosine * speed, tolerances::no_slip_speed)
                   ? Vec3(slip / speed)
                   : c.slip;
      const double ahead = foresight_[size_t(&c - contacts_.data())];
      if (ahead > 0) {
        // The friction of the future slip lies in the cone, as for a contact that sticks.
        p.sliding = false;
        p.tangential_bias += slip / ahead;
      }
    }
    points_.push_back(p);
    point_forces_.push_back(c.force);
  }
  turning_.act(acting_, points_);
  solve_forces();
  if (!report_.solved) return false;
  if (!joints_.empty()) {
    if (!points_.empty() || !rows_.empty()) joints_.hold_accelerations(blocks_, joint_forces_);
    write_joint_rates(dydt);
  }
  for (size_t k = 0; k < acting_.size(); ++k) acting_[k]->force = point_forces_[k];
  if (rates_)
    write_contact_rates(dydt.subspan(first_quadrature() + CauseEffect::numbers * causes_.size()));
  for (size_t i = 0; i < dynamic_.size(); ++i) {
    RigidBody& b = bodies_[dynamic_[i]];
    const DofBlock& block = blocks_[block_of_[dynamic_[i]]];
    const size_t at = entries_per_body * i;
    put_triple(dydt, at, b.v);
    // q' = 1/2 (0, omega) q
    const Quat& q = b.pose.q;
    const Vec3& w = b.omega;
    dydt[at + 3] = -0.5 * (w.x() * q.x() + w.y() * q.y() + w.z() * q.z());
    dydt[at + 4] = 0.5 * (w.x() * q.w() + w.y() * q.z() - w.z() * q.y());
    dydt[at + 5] = 0.5 * (w.y() * q.w() + w.z() * q.x() - w.x() * q.z());
    dydt[at + 6] = 0.5 * (w.z() * q.w() + w.x() * q.y() - w.y() * q.x());
    put_triple(dydt, at + 7, b.mass * block.v);
    // dL/dt = I alpha + omega x L
    const Mat3& I = inertias_[block_of_[dynamic_[i]]];
    put_triple(dydt, at + 10, I * block.omega + b.omega.cross(I * b.omega));
  }
  return true;
}

void EventSystem::normalise(std::span<double> y) const {
  for (size_t i = 0; i < dynamic_.size(); ++i) {
    double* q = &y[entries_per_body * i + 3];
    ode::normalise_quaternion(std::span<double, 4>(q, 4));
  }
}

void EventSystem::allowed_errors(const ode::Tolerance& tolerance, std::span<const double> y,
                                 std::span<double> allowed) const {
  for (size_t i = 0; i < dynamic_.size(); ++i) {
    const RigidBody& b = bodies_[dynamic_[i]];
    const size_t at = entries_per_body * i;
    const Vec3 P = triple(y, at + 7), L = triple(y, at + 10);
    for (size_t k = 0; k < 3; ++k) {
      allowed[at + k] = tolerance.position;
      allowed[at + 7 + k] = b.mass * tolerance.position + tolerance.relative * P.norm();
      allowed[at + 10 + k] = is_particle(b)
                                 ? std::numeric_limits<double>::infinity()
                                 : b.inertia_body.diagonal().maxCoeff() * tolerance.orientation +
                                       tolerance.relative * L.norm();
    }
    for (size_t k = 3; k < 7; ++k) allowed[at + k] = 0.5 * tolerance.orientation;
  }
  for (size_t i = first_quadrature(); i < size(); ++i)
    allowed[i] = std::numeric_limits<double>::infinity();
}

std::string EventSystem::entry_name(size_t entry) const {
  if (entry >= first_quadrature())
    return "quadrature " + std::to_string(entry - first_quadrature());
  static constexpr const char* names[entries_per_body] = {
      "x.x", "x.y", "x.z", "q.w", "q.x", "q.y", "q.z", "P.x", "P.y", "P.z", "L.x", "L.y", "L.z"};
  return "body slot " + std::to_string(dynamic_[entry / entries_per_body]) + ", " +
         names[entry % entries_per_body];
}

}  // namespace tumble
