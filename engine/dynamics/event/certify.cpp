#include "engine/dynamics/event/certify.hpp"

#include "engine/core/disjoint_sets.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Bodies that are connected by contacts and joints, with these.
struct TouchingBodies {
  std::vector<uint32_t> slots;
  std::vector<uint32_t> joints, couplings;
  std::vector<EventContact> contacts;
};

std::vector<TouchingBodies> touching_bodies(std::span<const RigidBody> bodies,
                                            std::span<const EventContact> contacts,
                                            const JointsAndCouplings& all,
                                            std::span<const BodyLink> links) {
  DisjointSets sets(bodies.size());
  const auto moves = [&](uint32_t slot) {
    return slot != no_body && bodies[slot].type != BodyType::fixed;
  };
  const auto join = [&](uint32_t first, uint32_t second) {
    if (moves(first) && moves(second)) sets.join(first, second);
  };
  for (const EventContact& c : contacts) join(c.key.body_a, c.key.body_b);
  for (const BodyLink& l : links)
    if (l.joint != BodyLink::none) join(l.a, l.b);
  for (const JointCoupling& c : all.couplings) join_bodies(c, all.joints, moves, sets);
  std::vector<TouchingBodies> out;
  std::vector<uint32_t> place(bodies.size(), no_block);
  for (uint32_t slot = 0; slot < bodies.size(); ++slot) {
    if (!moves(slot)) continue;
    const uint32_t first = sets.root(slot);
    if (first == slot) {
      place[slot] = uint32_t(out.size());
      out.emplace_back();
    }
    out[place[first]].slots.push_back(slot);
  }
  for (const EventContact& c : contacts) {
    const uint32_t slot = moves(c.key.body_a) ? c.key.body_a : c.key.body_b;
    if (moves(slot)) out[place[sets.root(slot)]].contacts.push_back(c);
  }
  for (const BodyLink& l : links) {
    const uint32_t slot = moves(l.a) ? l.a : l.b;
    if (l.joint != BodyLink::none && moves(slot))
      out[place[sets.root(slot)]].joints.push_back(l.joint);
  }
  for (uint32_t k = 0; k < all.couplings.size(); ++k) {
    const uint32_t slot = first_body(all.couplings[k], all.joints, moves);
    if (slot != no_body) out[place[sets.root(slot)]].couplings.push_back(k);
  }
  return out;
}

double cone_place(const Vec3& force, const Vec3& normal, double friction) {
  const double across = normal.dot(force);
  if (!(friction > 0) || !(across > 0)) return 0;
  return (force - across * normal).norm() / (friction * across);
}

/// A sum that should be zero, and the sum of the magnitudes of its terms.
struct Rest {
  Vec3 left = Vec3::Zero();
  double size = 0;
  void add(const Vec3& term) {
    left += term;
    size += term.norm();
  }
  double relative() const { return size > 0 ? left.norm() / size : 0; }
};

class Certifier {
 public:
  Certifier(std::span<RigidBody> bodies, const SmoothForces& forces, ContactForceMethod method,
            const JointsAndCouplings& joints, std::span<const CourseMotion> courses)
      : bodies_(bodies),
        forces_(forces),
        method_(method),
        joints_(joints),
        courses_(courses),
        block_of_(bodies.size(), no_block) {}

  Status add(TouchingBodies& touching, ContactCertificates& out);

 private:
  ContactCertificate certificate(const EventContact& c, const EventSystem& system) const;
  void tell_complementarity(std::span<ContactCertificate> contacts) const;
  void balance(const TouchingBodies& touching, std::span<const double> rates,
               std::span<const ContactCertificate> contacts, EventSystem& system,
               std::vector<BodyBalance>& out) const;

  std::span<RigidBody> bodies_;
  const SmoothForces& forces_;
  ContactForceMethod method_;
  JointsAndCouplings joints_;
  std::span<const CourseMotion> courses_;
  std::vector<uint32_t> block_of_;
};

ContactCertificate Certifier::certificate(const EventContact& c, const EventSystem& system) const {
  const ElementGap g = push_gap(c, bodies_);
  ContactCertificate out;
  out.key = c.key;
  out.feature = c.feature;
  out.x_world = g.x_world;
  out.normal = g.normal;
  out.gap = g.gap;
  out.offset = c.offset;
  out.normal_velocity = g.rate;
  out.slip_velocity = slip_of(c, g, bodies_);
  const auto acceleration = [&](uint32_t slot) -> Vec3 {
    if (block_of_[slot] == no_block) return Vec3::Zero();
    const DofBlock& block = system.accelerations()[block_of_[slot]];
    return block.v + block.omega.cross(g.x_world - bodies_[slot].pose.x);
  };
  const Vec3 du = acceleration(c.key.body_b) - acceleration(c.key.body_a);
  out.normal_acceleration = g.normal.dot(du) + g.bias;
  out.slip_acceleration = du - g.normal.dot(du) * g.normal + g.tangential_bias;
  out.friction = c.friction;
  if (!c.closed) return out;
  out.force = c.force;
  out.mode = c.sliding ? ContactMode::sliding : ContactMode::sticking;
  out.place_in_cone = cone_place(c.force, g.normal, c.friction);
  out.residual = system.report().residual;
  out.solver = system.report().solver;
  return out;
}

void Certifier::tell_complementarity(std::span<ContactCertificate> contacts) const {
  double force = 0, acceleration = 0;
  for (const ContactCertificate& c : contacts) {
    force = std::max(force, c.force.norm());
    acceleration = std::max(acceleration, std::fabs(c.normal_acceleration));
  }
  for (const RigidBody& b : bodies_)
    if (b.dynamic()) acceleration = std::max(acceleration, b.inverse_mass * b.force.norm());
  if (!(force > 0) || !(acceleration > 0)) return;
  for (ContactCertificate& c : contacts)
    if (c.mode != ContactMode::open)
      c.complementarity = std::min(std::fabs(c.normal.dot(c.force)) / force,
                                   std::fabs(c.normal_acceleration) / acceleration);
}

void Certifier::balance(const TouchingBodies& touching, std::span<const double> rates,
                        std::span<const ContactCertificate> contacts, EventSystem& system,
                        std::vector<BodyBalance>& out) const {
  size_t at = 0;
  for (const uint32_t slot : touching.slots) {
    const RigidBody& b = bodies_[slot];
    if (!b.dynamic()) continue;
    BodyBalance& sum = out.emplace_back();
    Rest force, torque;
    sum.body = slot;
    sum.smooth_force = b.force;
    sum.smooth_torque = b.torque;
    for (const ContactCertificate& c : contacts) {
      if (c.key.body_a != slot && c.key.body_b != slot) continue;
      const Vec3 f = c.key.body_b == slot ? c.force : Vec3(-c.force);
      const Vec3 turn = is_particle(b) ? Vec3(Vec3::Zero()) : (c.x_world - b.pose.x).cross(f);
      sum.contact_force += f;
      sum.contact_torque += turn;
      force.add(f);
      torque.add(turn);
    }
    for (const TurningPart& p : system.turning()) {
      const ContactKey& key = touching.contacts[p.contacts[0]].key;
      if (key.body_a != slot && key.body_b != slot) continue;
      const Vec3 turn = key.body_b == slot ? p.torque : Vec3(-p.torque);
      sum.contact_torque += turn;
      torque.add(turn);
    }
    const auto add_side = [&](const RowSide& s, double along) {
      if (s.block != block_of_[slot]) return;
      const Vec3 f = along * s.linear, turn = along * s.angular;
      sum.joint_force += f;
      sum.joint_torque += turn;
      force.add(f);
      torque.add(turn);
    };
    for (size_t i = 0; i < system.joint_forces().size(); ++i)
      system.joints().for_sides(i,
                                [&](const RowSide& s) { add_side(s, system.joint_forces()[i]); });
    system.drives().for_forces([&](const DrivePart& p, const JointRow& row) {
      for (const RowSide* s : {&row.row.a, &row.row.b}) add_side(*s, p.force);
    });
    sum.momentum_rate = {rates[at + 7], rates[at + 8], rates[at + 9]};
    sum.angular_rate = {rates[at + 10], rates[at + 11], rates[at + 12]};
    at += 13;
    force.add(b.force);
    force.add(-sum.momentum_rate);
    torque.add(b.torque);
    torque.add(-sum.angular_rate);
    sum.residual = std::max(force.relative(), torque.relative());
  }
}

Status Certifier::add(TouchingBodies& touching, ContactCertificates& out) {
  for (size_t i = 0; i < touching.slots.size(); ++i) block_of_[touching.slots[i]] = uint32_t(i);
  EventSystem system(bodies_, touching.slots, block_of_, forces_, method_);
  system.set_courses(courses_);
  system.set_joints(joints_, {touching.joints, touching.couplings});
  system.set_drive_modes();
  system.set_contacts(touching.contacts);
  const std::vector<double> y = system.read(0);
  std::vector<double> rates(y.size());
  if (!system.derivative(0, y, rates))
    return Error{ErrorCode::numeric, "no contact forces were found that satisfy all conditions",
                 fmt::format("bodies around slot {}", touching.slots.front()),
                 "choose another contact solver"};
  std::vector<ContactCertificate> contacts;
  for (const EventContact& c : touching.contacts) contacts.push_back(certificate(c, system));
  tell_complementarity(contacts);
  balance(touching, rates, contacts, system, out.bodies);
  out.contacts.insert(out.contacts.end(), contacts.begin(), contacts.end());
  for (const uint32_t slot : touching.slots) block_of_[slot] = no_block;
  return {};
}

}  // namespace

Result<GroupForceProblem> pose_contact_forces(std::span<RigidBody> bodies, uint32_t slot,
                                              std::span<const EventContact> contacts,
                                              const SmoothForces& forces, ContactForceMethod method,
                                              const JointsAndCouplings& joints,
                                              std::span<const BodyLink> links,
                                              std::span<const CourseMotion> courses) {
  const std::vector<RigidBody> before(bodies.begin(), bodies.end());
  GroupForceProblem out;
  method.least = true;
  method.tell = &out.problem;
  Certifier certifier(bodies, forces, method, joints, courses);
  Status done;
  for (TouchingBodies& touching : touching_bodies(bodies, contacts, joints, links)) {
    if (!std::binary_search(touching.slots.begin(), touching.slots.end(), slot)) continue;
    if (touching.contacts.size() > tolerances::most_posed_contacts)
      return Error{ErrorCode::unsupported,
                   fmt::format("{} contacts hang together here, and {} can be looked at",
                               touching.contacts.size(), tolerances::most_posed_contacts),
                   {},
                   "choose a body that fewer bodies touch"};
    for (const EventContact& c : touching.contacts) {
      const ElementGap g = push_gap(c, bodies);
      if (c.closed && g.regular) out.places.push_back({c.key, g.x_world, g.normal, c.sliding});
    }
    out.bodies = touching.slots;
    ContactCertificates ignored;
    done = certifier.add(touching, ignored);
    break;
  }
  std::copy(before.begin(), before.end(), bodies.begin());
  // The problem was posed even if no forces were found.
  if (out.problem.points.size() != out.places.size()) {
    if (!done) return done.error();
    return Error{
        ErrorCode::unsupported, "these contacts are not solved for as one problem", {}, {}};
  }
  return out;
}

Result<ContactCertificates> certify(std::span<RigidBody> bodies,
                                    std::span<const EventContact> contacts,
                                    const SmoothForces& forces, ContactForceMethod method,
                                    const JointsAndCouplings& joints,
                                    std::span<const BodyLink> links,
                                    std::span<const CourseMotion> courses) {
  const std::vector<RigidBody> before(bodies.begin(), bodies.end());
  method.least = true;
  Certifier certifier(bodies, forces, method, joints, courses);
  ContactCertificates out;
  Status done;
  for (TouchingBodies& touching : touching_bodies(bodies, contacts, joints, links)) {
    done = certifier.add(touching, out);
    if (!done) break;
  }
  std::copy(before.begin(), before.end(), bodies.begin());
  if (!done) return done.error();
  std::sort(out.contacts.begin(), out.contacts.end(), [](const auto& p, const auto& q) {
    return std::tie(p.key, p.feature) < std::tie(q.key, q.feature);
  });
  std::sort(out.bodies.begin(), out.bodies.end(),
            [](const BodyBalance& p, const BodyBalance& q) { return p.body < q.body; });
  return out;
}

}  // namespace tumble
