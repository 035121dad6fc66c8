#include "engine/world/present_moment.hpp"

#include <algorithm>
#include <utility>

namespace tumble {

PresentMoment::PresentMoment(WorldState& s) : state_(s), bodies_(s.bodies.bodies) {
  for (const ParticleSystem& p : s.particles) forces_.push_back(p.force);
  status_ = s.blocks.append(ParticleBlocks::Which::not_fast, s.particle_ids, s.particles,
                            s.bodies.bodies);
}

PresentMoment::~PresentMoment() {
  WorldState& s = state_;
  s.blocks.remove(s.bodies.bodies);
  std::copy(bodies_.begin(), bodies_.end(), s.bodies.bodies.begin());
  for (size_t i = 0; i < forces_.size(); ++i) s.particles[i].force = std::move(forces_[i]);
}

}  // namespace tumble
