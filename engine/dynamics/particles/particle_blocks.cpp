#include "engine/dynamics/particles/particle_blocks.hpp"

namespace tumble {
namespace {

RigidBody block_of_particle(const ParticleSystem& p, size_t i) {
  RigidBody b;
  b.pose.x = p.x[i];
  b.v = p.v[i];
  b.force = p.force[i];
  b.gravity_scale = p.gravity_scale;
  b.mass = p.mass[i];
  b.inverse_mass = 1 / p.mass[i];
  b.bounding_radius = b.inner_radius = p.radius[i];
  b.can_sleep = false;
  return b;
}

}  // namespace

Result<std::shared_ptr<const Shape>> ParticleBlocks::ball(double radius) {
  if (const auto known = balls_.find(radius); known != balls_.end()) return known->second;
  auto made = make_shape(ball_def(radius));
  if (made) balls_.emplace(radius, *made);
  return made;
}

bool ParticleBlocks::has_blocks(Which which, const ParticleSystem& p) {
  if (p.fast || p.fluid) return false;
  return which != Which::colliding || (p.collide && !p.grains);
}

Status ParticleBlocks::append(Which which, const HandlePool<ParticleSystemTag>& ids,
                              std::span<const ParticleSystem> systems,
                              std::vector<RigidBody>& bodies) {
  owners_.clear();
  first_ = uint32_t(bodies.size());
  first_of_.assign(systems.size(), no_slot);
  std::shared_ptr<const Shape> shape;
  for (uint32_t s = 0; s < systems.size(); ++s) {
    const ParticleSystem& p = systems[s];
    if (!ids.alive(s) || !has_blocks(which, p)) continue;
    first_of_[s] = uint32_t(bodies.size());
    Material material;
    material.friction = p.friction;
    material.restitution = p.restitution;
    for (size_t i = 0; i < p.size(); ++i) {
      owners_.push_back({ids.at(s), p.id[i]});
      RigidBody& b = bodies.emplace_back(block_of_particle(p, i));
      if (!p.collide) continue;
      if (!shape || shape->def().radius != p.radius[i]) {
        const auto made = ball(p.radius[i]);
        if (!made) return made.error();
        shape = *made;
      }
      b.shapes.push_back({shape, {}, material});
    }
  }
  // Drops unused balls: particles come and go, with different radii.
  if (balls_.size() > 2 * owners_.size() + 16)
    std::erase_if(balls_, [](const auto& known) { return known.second.use_count() == 1; });
  return {};
}

void ParticleBlocks::give_back(std::span<const RigidBody> bodies, double h,
                               std::span<ParticleSystem> systems) const {
  for (size_t s = 0; s < first_of_.size(); ++s) {
    if (first_of_[s] == no_slot) continue;
    ParticleSystem& p = systems[s];
    for (size_t i = 0; i < p.size(); ++i) {
      const RigidBody& b = bodies[first_of_[s] + i];
      p.x[i] = b.pose.x;
      p.v[i] = b.v;
      p.age[i] += h;
      p.force[i].setZero();
    }
  }
}

void ParticleBlocks::remove(std::vector<RigidBody>& bodies) {
  bodies.resize(bodies.size() - owners_.size());
  owners_.clear();
  first_of_.clear();
}

uint32_t ParticleBlocks::slot_of(const ParticleName& name,
                                 std::span<const ParticleSystem> systems) const {
  const uint32_t s = name.system.index;
  if (s >= first_of_.size() || first_of_[s] == no_slot) return no_slot;
  const size_t i = systems[s].find(name.particle);
  if (i == systems[s].size()) return no_slot;
  const uint32_t slot = first_of_[s] + uint32_t(i);
  return owners_[slot - first_].system == name.system ? slot : no_slot;
}

}  // namespace tumble
