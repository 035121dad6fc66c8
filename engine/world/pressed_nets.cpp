#include "engine/world/pressed_nets.hpp"

#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/world/state.hpp"
#include "engine/world/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Kinds of what springs tie.
constexpr uint8_t tied = 1, block = 2, elsewhere = 4;

Vec3 place_of(const WorldState& s, const SolvedSpring::End& end) {
  if (end.slot == no_body) return end.point;
  const Pose& pose = s.bodies.bodies[end.slot].pose;
  return pose.x + pose.direction(end.point);
}
Vec3 velocity_of(const WorldState& s, const SolvedSpring::End& end) {
  if (end.slot == no_body) return Vec3::Zero();
  const RigidBody& body = s.bodies.bodies[end.slot];
  return body.v + body.omega.cross(body.pose.direction(end.point));
}

/// Takes a share out of the force sums.
void withdraw(ForceShare& share, std::vector<RigidBody>& bodies) {
  for (const ForceShare::OnBody& on : share.bodies) {
    if (!bodies[on.slot].dynamic()) continue;
    bodies[on.slot].force -= on.force;
    bodies[on.slot].torque -= on.torque;
  }
  share.clear();
}

}  // namespace

void PressedNets::clear() {
  tied_.clear();
  links_.clear();
  springs_.clear();
  forces_.clear();
}

/// Adds an anchor as an end of a spring; whether it is there.
bool PressedNets::add_end(const WorldState& s, const ForceContext& context, const Anchor& anchor,
                          double weight, SolvedSpring& spring) {
  if (!locate(anchor, context)) return false;
  const RigidBody* body = pulled_body(anchor, context);
  if (!body) {
    astray_ = astray_ || anchor.kind != Anchor::Kind::world;
    spring.add(no_body, anchor.point, weight);
    return true;
  }
  const bool of_body = anchor.kind == Anchor::Kind::body;
  spring.add(uint32_t(body - s.bodies.bodies.data()),
             of_body ? Vec3(anchor.point - body->centre_body) : Vec3(Vec3::Zero()), weight);
  return true;
}

/// Takes a spring whose ends are known, if it can move anything.
void PressedNets::take(const WorldState& s, const SolvedSpring& spring, uint32_t force) {
  uint32_t first = no_body;
  for (uint32_t i = 0; i < spring.count; ++i) {
    const uint32_t slot = spring.end[i].slot;
    if (slot == no_body || !s.bodies.bodies[slot].dynamic()) continue;
    of_[slot] |= uint8_t(tied | (s.blocks.holds(slot) ? block : 0) | (astray_ ? elsewhere : 0));
    if (first == no_body) first = slot;
    sets_.join(first, slot);
  }
  if (first != no_body) tied_.push_back({force, spring, false});
}

void PressedNets::take_spring(const WorldState& s, const ForceContext& context,
                              const SpringDef& def, uint32_t force) {
  SolvedSpring spring;
  astray_ = false;
  if (!add_end(s, context, def.a, -1, spring) || !add_end(s, context, def.b, 1, spring)) return;
  spring.stiffness = def.stiffness;
  spring.damping = def.damping;
  spring.rest_length = def.rest_length;
  take(s, spring, force);
}

void PressedNets::take_mesh(const WorldState& s, const ForceContext& context,
                            const SpringMesh& mesh, uint32_t force) {
  const auto take_with = [&](std::span<const uint32_t> nodes, std::span<const double> weights,
                             double stiffness, double damping, double rest_length) {
    SolvedSpring spring;
    for (size_t i = 0; i < nodes.size(); ++i)
      if (!add_end(s, context, mesh.nodes[nodes[i]], weights[i], spring)) return;
    spring.stiffness = stiffness;
    spring.damping = damping;
    spring.rest_length = rest_length;
    take(s, spring, force);
  };
  astray_ = false;
  constexpr std::array<double, 2> apart{-1, 1};
  for (const SpringMesh::Link& l : mesh.links)
    take_with(std::array{l.a, l.b}, apart, l.stiffness, l.damping, l.rest_length);
  for (const SpringMesh::Bend& b : mesh.bends)
    take_with(std::span(b.node).first(b.count), b.weight, b.stiffness, b.damping, 0);
}

void PressedNets::find(WorldState& s) {
  clear();
  if (s.blocks.empty()) return;
  std::vector<RigidBody>& bodies = s.bodies.bodies;
  const ForceContext context = s.force_context();
  sets_.reset(bodies.size());
  of_.assign(bodies.size(), 0);
  for (uint32_t i = 0; i < s.forces.size(); ++i) {
    if (!s.forces[i]) continue;
    if (const auto* spring = std::get_if<SpringDef>(&*s.forces[i]))
      take_spring(s, context, *spring, i);
    else if (const auto* mesh = std::get_if<SpringMeshDef>(&*s.forces[i]))
      take_mesh(s, context, *mesh->mesh, i);
  }
  // What a net has of all kinds, at the slot that stands for it.
  for (uint32_t slot = 0; slot < of_.size(); ++slot) of_[sets_.root(slot)] |= of_[slot];
  for (uint32_t slot = 0; slot < of_.size(); ++slot) of_[slot] = of_[sets_.root(slot)];
  std::erase_if(tied_, [this](const Tied& t) { return !in_net(any_end(t.spring)); });
  pressed_.assign(bodies.size(), 0);
  for (const Tied& t : tied_) {
    uint32_t last = no_body;
    for (uint32_t i = 0; i < t.spring.count; ++i) {
      const uint32_t slot = t.spring.end[i].slot;
      if (slot == no_body || !in_net(slot)) continue;
      bodies[slot].looks_far = true;
      if (last != no_body && last != slot) links_.push_back({last, slot});
      last = slot;
    }
  }
}

bool PressedNets::in_net(uint32_t slot) const {
  return of_[slot] == (tied | block);
}

/// A body of a spring that it can move.
uint32_t PressedNets::any_end(const SolvedSpring& spring) const {
  for (uint32_t i = 0; i < spring.count; ++i)
    if (spring.end[i].slot != no_body && (of_[spring.end[i].slot] & tied))
      return spring.end[i].slot;
  return no_body;
}

/// Whether one straight step of `part` seconds is too long for a spring: its ends pass by a good
/// part of its length, or it turns so far that straight paths stretch it by much energy. An angle a
/// stretches it by l a^2 / 2, which is k h^2 / m a^2 / 4 of the energy of its turning.
bool PressedNets::is_outrun(const WorldState& s, const SolvedSpring& spring, double part) const {
  if (spring.rest_length == 0) return false;
  Vec3 q = Vec3::Zero(), rate = Vec3::Zero();
  double mobility = 0;
  for (uint32_t i = 0; i < spring.count; ++i) {
    const SolvedSpring::End& end = spring.end[i];
    q += end.weight * place_of(s, end);
    rate += end.weight * velocity_of(s, end);
    if (end.slot != no_body)
      mobility += end.weight * end.weight * s.bodies.bodies[end.slot].inverse_mass;
  }
  const double length = std::max(q.norm(), spring.rest_length);
  const double passed = part * rate.norm() / length;
  if (passed > tolerances::passed_of_length) return true;
  const double angle = part * rate.cross(q).norm() / (length * length);
  return part * part * spring.stiffness * mobility * angle * angle / 4 >
         tolerances::stretched_by_turning;
}

std::span<SolvedSpring> PressedNets::press(WorldState& s, double part) {
  springs_.clear();
  forces_.clear();
  if (tied_.empty()) return {};
  const auto press_net = [this](uint32_t slot) {
    if (in_net(slot)) pressed_[sets_.root(slot)] = 1;
  };
  for (const Contact& c : s.contacts.contacts()) {
    press_net(c.key.body_a);
    press_net(c.key.body_b);
  }
  for (const Tied& t : tied_) {
    const uint32_t slot = any_end(t.spring);
    if (!pressed_[sets_.root(slot)] && is_outrun(s, t.spring, part)) press_net(slot);
  }
  for (Tied& t : tied_) {
    if (!pressed_[sets_.root(any_end(t.spring))]) continue;
    if (!t.pressed) withdraw(s.workspace.books.shares[t.force], s.bodies.bodies);
    t.pressed = true;
    springs_.push_back(t.spring);
    forces_.push_back(t.force);
  }
  return springs_;
}

void PressedNets::share(WorldState& s, double part) const {
  for (const uint32_t force : forces_) s.workspace.books.shares[force].clear();
  for (size_t k = 0; k < springs_.size(); ++k) {
    const SolvedSpring& spring = springs_[k];
    for (uint32_t i = 0; i < spring.count; ++i) {
      const SolvedSpring::End& end = spring.end[i];
      if (end.slot == no_body) continue;
      const Vec3 elastic = (-end.weight / part) * spring.elastic;
      const Vec3 arm = s.bodies.bodies[end.slot].pose.direction(end.point);
      s.workspace.books.shares[forces_[k]].bodies.push_back(
          {end.slot, (-end.weight / part) * spring.impulse, end.moment / part, elastic,
           arm.cross(elastic)});
    }
  }
}

}  // namespace tumble
