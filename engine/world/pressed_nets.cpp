#include "engine/world/pressed_nets.hpp"

#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/world/state.hpp"
#include "engine/world/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// What a body slot is to the springs: an end that moves; a block of a particle; part of a net that
/// also has particles without blocks.
constexpr uint8_t tied = 1, block = 2, elsewhere = 4;

/// Subtracts a share from the force sums.
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
  pulled_apart_.clear();
  tied_.clear();
  links_.clear();
  springs_.clear();
  forces_.clear();
}

/// Computes the slots, after those of bodies, that colliding particles will have.
void PressedNets::number_particles(const WorldState& s) {
  auto next = uint32_t(s.bodies.bodies.size());
  first_block_ = next;
  first_of_.assign(s.particles.size(), no_body);
  for (uint32_t k = 0; k < s.particles.size(); ++k) {
    const ParticleSystem& p = s.particles[k];
    const auto which = ParticleBlocks::Which::colliding;
    if (!s.particle_ids.alive(k) || !ParticleBlocks::has_blocks(which, p)) continue;
    first_of_[k] = next;
    next += uint32_t(p.size());
  }
  begin_sets(next);
}

void PressedNets::begin_sets(size_t slots) {
  sets_.reset(slots);
  of_.assign(slots, 0);
  pressed_.assign(slots, 0);
}

/// Slot of a particle; no_body if it does not exist or has no block.
uint32_t PressedNets::slot_of(const WorldState& s, ParticleSystemId system, uint64_t id) const {
  if (!s.particle_ids.contains(system) || first_of_[system.index] == no_body) return no_body;
  const ParticleSystem& p = s.particles[system.index];
  const size_t i = p.find(id);
  return i < p.size() ? first_of_[system.index] + uint32_t(i) : no_body;
}

bool PressedNets::moves(const WorldState& s, uint32_t slot) const {
  return slot != no_body && (slot >= first_block_ || s.bodies.bodies[slot].dynamic());
}

/// Adds an anchor as an end of a spring; returns whether the anchor exists.
bool PressedNets::add_end(const WorldState& s, const Anchor& anchor, double weight,
                          SolvedSpring& spring) {
  if (anchor.kind == Anchor::Kind::world) {
    spring.add(no_body, anchor.point, weight);
    return true;
  }
  if (anchor.kind == Anchor::Kind::body) {
    if (!s.bodies.ids.contains(anchor.body)) return false;
    const RigidBody& body = s.bodies.bodies[anchor.body.index];
    spring.add(anchor.body.index, anchor.point - body.centre_body, weight);
    return true;
  }
  if (!s.particle_ids.contains(anchor.particles)) return false;
  const ParticleSystem& p = s.particles[anchor.particles.index];
  if (p.find(anchor.particle) == p.size()) return false;
  const uint32_t slot = slot_of(s, anchor.particles, anchor.particle);
  astray_ = astray_ || slot == no_body;
  spring.add(slot, Vec3::Zero(), weight);
  return true;
}

/// Adds a complete spring, if one of its ends can move.
void PressedNets::take(const WorldState& s, const SolvedSpring& spring, uint32_t force) {
  uint32_t first = no_body;
  for (uint32_t i = 0; i < spring.count; ++i) {
    const uint32_t slot = spring.end[i].slot;
    if (!moves(s, slot)) continue;
    of_[slot] |= uint8_t(tied | (slot >= first_block_ ? block : 0) | (astray_ ? elsewhere : 0));
    if (first == no_body) first = slot;
    sets_.join(first, slot);
  }
  if (first != no_body) tied_.push_back({force, spring, false});
}

void PressedNets::take_spring(const WorldState& s, const SpringDef& def, uint32_t force) {
  SolvedSpring spring;
  astray_ = false;
  if (!add_end(s, def.a, -1, spring) || !add_end(s, def.b, 1, spring)) return;
  spring.stiffness = def.stiffness;
  spring.damping = def.damping;
  spring.rest_length = def.rest_length;
  take(s, spring, force);
}

void PressedNets::take_mesh(const WorldState& s, const SpringMesh& mesh, uint32_t force) {
  uint32_t first = no_body;
  const auto take_with = [&](std::span<const uint32_t> nodes, std::span<const double> weights,
                             double stiffness, double damping, double rest_length) {
    SolvedSpring spring;
    for (size_t i = 0; i < nodes.size(); ++i)
      if (!add_end(s, mesh.nodes[nodes[i]], weights[i], spring)) return;
    spring.stiffness = stiffness;
    spring.damping = damping;
    spring.rest_length = rest_length;
    take(s, spring, force);
    // All springs of one force belong to the same net.
    const uint32_t slot = any_end(spring);
    if (first == no_body) first = slot;
    if (slot != no_body) sets_.join(first, slot);
  };
  astray_ = false;
  constexpr std::array<double, 2> apart{-1, 1};
  for (const SpringMesh::Link& l : mesh.links)
    take_with(std::array{l.a, l.b}, apart, l.stiffness, l.damping, l.rest_length);
  for (const SpringMesh::Bend& b : mesh.bends)
    take_with(std::span(b.node).first(b.count), b.weight, b.stiffness, b.damping, 0);
}

/// Finds all springs that connect particles with blocks to each other and to bodies.
void PressedNets::find_nets(const WorldState& s) {
  for (uint32_t i = 0; i < s.forces.size(); ++i) {
    if (!s.forces[i]) continue;
    if (const auto* spring = std::get_if<SpringDef>(&*s.forces[i]))
      take_spring(s, *spring, i);
    else if (const auto* mesh = std::get_if<SpringMeshDef>(&*s.forces[i]))
      take_mesh(s, *mesh->mesh, i);
  }
  // The kinds of all ends of a net, first at its root, then at all of its slots.
  for (uint32_t slot = 0; slot < of_.size(); ++slot) of_[sets_.root(slot)] |= of_[slot];
  for (uint32_t slot = 0; slot < of_.size(); ++slot) of_[slot] = of_[sets_.root(slot)];
  std::erase_if(tied_, [this](const Tied& t) { return !in_net(any_end(t.spring)); });
}

namespace {

bool has_springs(const WorldState& s) {
  const auto ties = [](const auto& force) { return force && is_spring(*force); };
  return !s.particles.empty() && std::ranges::any_of(s.forces, ties);
}

}  // namespace

void PressedNets::find(const WorldState& s) {
  clear();
  if (!has_springs(s)) return;
  number_particles(s);
  find_nets(s);
  take_pressed_before(s);
  pulled_apart_.assign(s.forces.size(), 0);
  for (Tied& t : tied_) {
    t.pressed = pressed_[sets_.root(any_end(t.spring))] != 0;
    if (t.pressed) pulled_apart_[t.force] = 1;
  }
}

void PressedNets::find_among(const WorldState& s, std::span<const uint32_t> moving) {
  clear();
  if (s.blocks.empty() || !has_springs(s)) return;
  first_of_.assign(s.particles.size(), no_body);
  for (uint32_t k = 0; k < s.particles.size(); ++k)
    if (ParticleBlocks::has_blocks(ParticleBlocks::Which::colliding, s.particles[k]))
      first_of_[k] = s.blocks.first_slots()[k];
  first_block_ = std::ranges::min(first_of_);
  begin_sets(s.bodies.bodies.size());
  find_nets(s);
  pressed_.assign(pressed_.size(), 1);
  std::erase_if(
      tied_, [&](const Tied& t) { return !std::ranges::binary_search(moving, any_end(t.spring)); });
}

/// Marks the nets that a contact pressed in the last tick, which are solved in sub-steps in this
/// one too.
void PressedNets::take_pressed_before(const WorldState& s) {
  s.particle_contacts.for_each([&](const Contact& c) {
    if (!c.pressed()) return;
    for (const uint32_t key : {c.key.body_a, c.key.body_b}) {
      if ((key & particle_bit) == 0) continue;
      const ParticleName& name = s.touching_particles[key & ~particle_bit];
      const uint32_t slot = slot_of(s, name.system, name.particle);
      if (slot != no_body && in_net(slot)) pressed_[sets_.root(slot)] = 1;
    }
  });
}

void PressedNets::tie_blocks(std::vector<RigidBody>& bodies) {
  for (const Tied& t : tied_) {
    uint32_t last = no_body;
    for (uint32_t i = 0; i < t.spring.count; ++i) {
      const uint32_t slot = t.spring.end[i].slot;
      if (slot == no_body || !in_net(slot)) continue;
      bodies[slot].looks_far = slot >= first_block_;
      if (last != no_body && last != slot) links_.push_back({last, slot});
      last = slot;
    }
  }
}

bool PressedNets::in_net(uint32_t slot) const {
  return of_[slot] == (tied | block);
}

/// Slot of an end of a spring that can move.
uint32_t PressedNets::any_end(const SolvedSpring& spring) const {
  for (uint32_t i = 0; i < spring.count; ++i)
    if (spring.end[i].slot != no_body && (of_[spring.end[i].slot] & tied))
      return spring.end[i].slot;
  return no_body;
}

/// Whether a straight step of `part` seconds is too long for a spring: its ends pass each other by
/// a large part of its length, or it rotates so far that straight paths stretch it by much energy.
/// A rotation by the angle a stretches it by l a^2 / 2, which costs k h^2 / m a^2 / 4 of the energy
/// of its rotation.
bool PressedNets::is_outrun(const WorldState& s, const SolvedSpring& spring, double part) const {
  if (spring.rest_length == 0) return false;
  const auto [q, rate, mobility] = spring_motion(spring, s.bodies.bodies);
  const double length = std::max(q.norm(), spring.rest_length);
  const double passed = part * rate.norm() / length;
  if (passed > tolerances::passed_of_length) return true;
  const double angle = part * rate.cross(q).norm() / (length * length);
  return part * part * spring.stiffness * mobility * angle * angle / 4 >
         tolerances::stretched_by_turning;
}

std::span<SolvedSpring> PressedNets::press(WorldState& s, std::span<const Contact> contacts,
                                           double part, std::span<ForceShare> shares) {
  springs_.clear();
  forces_.clear();
  if (tied_.empty()) return {};
  const auto press_net = [this](uint32_t slot) {
    if (in_net(slot)) pressed_[sets_.root(slot)] = 1;
  };
  for (const Contact& c : contacts) {
    press_net(c.key.body_a);
    press_net(c.key.body_b);
  }
  for (const Tied& t : tied_) {
    const uint32_t slot = any_end(t.spring);
    if (!pressed_[sets_.root(slot)] && is_outrun(s, t.spring, part)) press_net(slot);
  }
  for (Tied& t : tied_) {
    if (!pressed_[sets_.root(any_end(t.spring))]) continue;
    if (!t.pressed) withdraw(shares[t.force], s.bodies.bodies);
    t.pressed = true;
    springs_.push_back(t.spring);
    forces_.push_back(t.force);
  }
  return springs_;
}

void PressedNets::share(const WorldState& s, double part, std::span<ForceShare> shares) {
  place_.resize(s.bodies.bodies.size(), 0);
  for (size_t first = 0; first < springs_.size();) {
    size_t last = first;
    while (last < springs_.size() && forces_[last] == forces_[first]) ++last;
    share_force(s, std::span(springs_).subspan(first, last - first), part, shares[forces_[first]]);
    first = last;
  }
}

/// Sums what the springs of one force do, with one entry per body.
void PressedNets::share_force(const WorldState& s, std::span<const SolvedSpring> springs,
                              double part, ForceShare& share) {
  share.clear();
  for (const SolvedSpring& spring : springs)
    for (uint32_t i = 0; i < spring.count; ++i) {
      const SolvedSpring::End& end = spring.end[i];
      if (end.slot == no_body) continue;
      if (place_[end.slot] == 0) {
        share.bodies.push_back({end.slot, Vec3::Zero(), Vec3::Zero()});
        place_[end.slot] = uint32_t(share.bodies.size());
      }
      ForceShare::OnBody& on = share.bodies[place_[end.slot] - 1];
      const Vec3 elastic = (-end.weight / part) * spring.elastic;
      on.force -= (end.weight / part) * spring.impulse;
      on.torque += end.moment / part;
      on.held += elastic;
      if (!end.point.isZero(0))
        on.held_torque += s.bodies.bodies[end.slot].pose.direction(end.point).cross(elastic);
    }
  for (const ForceShare::OnBody& on : share.bodies) place_[on.slot] = 0;
}

}  // namespace tumble
